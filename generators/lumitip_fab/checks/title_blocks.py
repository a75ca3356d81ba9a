"""Title blocks of boards, panels and schematics, by which someone finds the design of a page."""

from collections.abc import Iterator

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Design


def measure_title_block(read: ReadBoard) -> Iterator[Measurement]:
    """Title, date, revision, design and which board it is."""
    block, side = read.board.title_block, "board, seen from its front with the tip up"
    wrong = list(other_texts(block, read.design, read.design.title.on_boards().name))
    if block.get("2") != f"{read.name} {side}":
        wrong.append(f"2: {block.get('2', 'missing')}")
    yield read.count("title_block", wrong, "texts of the title block")


def other_texts(block: dict[str, str], design: Design, title: str) -> Iterator[str]:
    """Texts that differ from the design."""
    wanted = {
        "title": title,
        "date": design.title.date,
        "rev": design.title.revision,
        "1": f"Design {design.reading.design_hash}",
    }
    for name, text in wanted.items():
        if block.get(name, "") != text:
            yield f"{name}: {block.get(name, 'missing')}"
