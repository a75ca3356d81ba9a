"""How blocks are laid out on a schematic's sheet."""

from functools import partial

import pytest

from lumitip_fab.boards.kicad.schematic.sheet import MARGIN_MM, Block, Sheet, columns, grid
from lumitip_fab.design import Point


def _titled(words: str, sheet: Sheet, at: Point) -> None:
    sheet.texts.append((words, at, 1.0))


def blocks(count: int, width_mm: float, height_mm: float) -> list[Block]:
    """Blocks that draw their number alone."""
    return [Block(width_mm, height_mm, partial(_titled, str(i))) for i in range(count)]


def places(sheet: Sheet) -> dict[str, Point]:
    """Place of each block, from the first."""
    return {
        words: (round(x - MARGIN_MM, 6), round(y - MARGIN_MM, 6))
        for words, (x, y), _ in sheet.texts
    }


def test_blocks_stand_below_each_other() -> None:
    paper, sheet = columns(blocks(4, 50.0, 60.0))
    assert paper == "A3"
    assert list(places(sheet).values()) == [(0, 60 * i) for i in range(4)]


@pytest.mark.parametrize(
    ("count", "paper", "last"), [(2, "A4", (150, 0)), (4, "A4", (150, 70)), (6, "A3", (250, 70))]
)
def test_a_grid_takes_the_smallest_paper(count: int, paper: str, last: Point) -> None:
    first = Block(50.0, 60.0, partial(_titled, "first"))
    found, sheet = grid(first, blocks(count, 100.0, 70.0))
    assert found == paper
    assert places(sheet)["first"] == (0, 0)
    assert places(sheet)[str(count - 1)] == last
