"""The manual's last pages: where each part of each board goes."""

from collections.abc import Iterable, Iterator
from itertools import chain
from typing import Any

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
            groups=_grouped(facts["groups"]),
        )
        intro = ""


def _lines(placed: Iterable[dict[str, str]], by_hand: Iterable[dict[str, str]]) -> Iterator[str]:
    """Rows of the table: parts that a PCB fab places, then those that are soldered by hand."""
    rows = chain(((row, "") for row in placed), ((row, " (by hand)") for row in by_hand))
    for row, how in rows:
        product = " ".join(filter(None, (row["manufacturer"], row["part"])))
        value = ", ".join(filter(None, (row["value"], row["rating"]))) + how
        refs = runs(row["refs"].split(","))
        yield f"| {refs} | {as_written(value)} | {as_written(product)} |"


def _grouped(groups: list[dict[str, Any]]) -> str:
    """The table of what belongs together; empty without any."""
    rows = "\n".join(f"| {group['name']} | {runs(group['refs'])} |" for group in groups)
    return "\n\n" + _text("placed_groups", rows=rows).strip() if rows else ""


def _text(name: str, /, **values: object) -> str:
    """A passage of the manual with its values."""
    return passage("docs/chapters.md", name).format(**values)
