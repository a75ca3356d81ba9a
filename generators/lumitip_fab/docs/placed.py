"""The manual's last pages: where each part of each board goes."""

from collections.abc import Iterable, Iterator
from itertools import chain

from lumitip_fab.design import Design
from lumitip_fab.pipeline.artefact import Files
from lumitip_fab.text import as_written, passage, runs


def where_parts_go(design: Design, files: Files) -> Iterator[str]:
    """A section for each board: drawings of its sides, and the list of its parts."""
    intro = _text("placed_first") + "\n\n"
    names = [finger.name for finger in design.fingers]
    for name in (*names, *(board.name for board in design.auxiliary_boards)):
        facts = files.facts(f"boards/{name}/{name}.kicad_pcb")
        drawn = {side: f"boards/{name}/{name}_assembly_{side}.svg" for side in ("front", "back")}
        yield _text(
            "placed",
            name=name,
            intro=intro,
            drawings="\n\n".join(
                f"![Parts of the {name} board, {side}]({path})"
                for side, path in drawn.items()
                if files.like(path)
            ),
            rows="\n".join(_lines(facts["parts"], facts["by_hand"])),
        )
        intro = ""


def _lines(placed: Iterable[dict[str, str]], by_hand: Iterable[dict[str, str]]) -> Iterator[str]:
    """Rows of the table: parts that a PCB fab places, then those that are soldered by hand."""
    rows = chain(((row, "") for row in placed), ((row, " (by hand)") for row in by_hand))
    for row, how in rows:
        product = " ".join(filter(None, (row["manufacturer"], row["part"])))
        yield f"| {runs(row['refs'].split(','))} | {as_written(row['value'] + how)} | " + (
            f"{as_written(product)} |"
        )


def _text(name: str, /, **values: object) -> str:
    """A passage of the manual with its values."""
    return passage("docs/chapters.md", name).format(**values)
