"""How blocks are laid out on a schematic's sheet."""

from functools import partial

import pytest

from lumitip_fab.boards.kicad.schematic.frames import GAP_MM, packed
from lumitip_fab.boards.kicad.schematic.sheet import MARGIN_MM, Block, Sheet, columns, grid, jointed
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


def test_a_low_frame_stands_below_another_where_it_has_room() -> None:
    high = 50.0 + GAP_MM
    sizes = [(40.0, high), (30.0, 20.0), (20.0, 25.0), (50.0, 10.0)]
    frames, tall = packed(sizes, 75.0 + GAP_MM)
    assert frames[:2] == [((0, 0), (40, high)), ((40 + GAP_MM, 0), (30, 20))]
    assert frames[2] == ((40 + GAP_MM, 20 + GAP_MM), (30, 30))  # as wide and low as its column
    assert frames[3] == ((0, high + GAP_MM), (50, 10))
    assert tall == high + GAP_MM + 10


def test_wires_are_cut_where_others_end_and_have_a_dot_there() -> None:
    wires, dots = jointed([((0, 0), (10, 0)), ((5, 0), (5, 5)), ((2, -1), (2, 1))], [(10, 0)])
    assert sorted(wires) == sorted(
        [((0, 0), (5, 0)), ((5, 0), (10, 0)), ((5, 0), (5, 5)), ((2, -1), (2, 1))]
    )
    assert dots == [(5, 0)]  # the wire that crosses is not joined
