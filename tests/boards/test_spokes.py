"""Spokes of the pour are counted from the copper in the file."""

import math
from collections.abc import Sequence

import pytest
import shapely

from lumitip_fab.checks.board_copper import measure_spokes
from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.readers.kicad_board import Copper, KicadBoard, Part, Terminal
from lumitip_fab.checks.readers.kicad_silk import Silk

FRONT = frozenset({"F.Cu"})
PAD = shapely.box(-0.5, -0.5, 0.5, 0.5)
AROUND = shapely.box(-4, -4, 4, 4) - shapely.box(-0.75, -0.75, 0.75, 0.75)
SPOKES = {
    "right": shapely.box(0.4, -0.15, 0.9, 0.15),
    "left": shapely.box(-0.9, -0.15, -0.4, 0.15),
    "up": shapely.box(-0.15, 0.4, 0.15, 0.9),
    "corner": shapely.box(0.4, -0.6, 0.9, -0.3),  # where the ring round the pad begins
}
VIA = Copper("via", "GND", FRONT, shapely.Point(3, 3).buffer(0.3), 0.0, 0.3)


def _starved(fill: shapely.Geometry, loose: Sequence[Copper] = (VIA,)) -> float:
    pad = Copper("pad", "GND", FRONT, PAD)
    part = Part(
        "U1",
        "",
        "",
        (),
        (0.0, 0.0),
        0.0,
        True,
        frozenset(),
        (Terminal("8", "GND", (0.0, 0.0), pad, 0.0),),
    )
    pour = Copper("fill", "GND", FRONT, fill)
    board = KicadBoard(
        parts=(part,),
        loose=(pour, *loose),
        layers=("F.Cu", "B.Cu"),
        edges=(),
        silk=Silk((), (), {}),
        keep_outs=(),
        plies=(),
        regions={},
        thickness_mm=math.nan,
        openings=(),
        title_block={},
    )
    read = ReadBoard("board", "board", board, None, None)  # type: ignore[arg-type]
    (measured,) = measure_spokes(read)
    return measured.measured


@pytest.mark.parametrize(
    ("spokes", "starved"),
    [
        (("right", "left"), 0),
        (("right",), 1),
        (("corner",), 1),
        (("corner", "up"), 0),
        (("right", "left", "up"), 0),
        ((), 0),  # the pad is joined by a track, or open: another check
    ],
)
def test_a_pad_has_two_spokes_or_none(spokes: tuple[str, ...], starved: int) -> None:
    assert _starved(shapely.union_all([AROUND, *(SPOKES[s] for s in spokes)])) == starved


def test_a_pad_that_is_joined_all_round_needs_no_spokes() -> None:
    assert _starved(shapely.box(-0.6, -0.5, 4, 4)) == 0


def test_spokes_to_a_piece_that_leads_nowhere_do_not_count() -> None:
    fill = shapely.union_all([AROUND, SPOKES["right"], SPOKES["left"]])
    assert _starved(fill, loose=()) == 1
