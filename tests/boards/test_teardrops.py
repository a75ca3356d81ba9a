"""Teardrops find room beside a neighbouring track."""

from typing import Any

import pytest
import shapely

from lumitip_fab.boards import teardrops
from lumitip_fab.boards.model import Track

ALONG = Track("A", "front", (0.0, 0.0), (0.8, 0.0), 0.2)


class Beside:
    """Copper of another net that fills all below a height."""

    def __init__(self, y_mm: float) -> None:
        self.area = shapely.box(-5, y_mm - 5, 5, y_mm)

    def free(self, track: Track) -> bool:
        line = shapely.LineString([track.start, track.end])
        return bool(line.buffer(track.width_mm / 2).distance(self.area) >= 0.2)


@pytest.mark.parametrize(
    ("y_mm", "aside_mm", "width_mm"),
    [(-0.5, 0.0, 0.44), (-0.38, 0.0, 0.334), (-0.3, 0.08, 0.334), (-0.25, None, None)],
)
def test_a_drop_is_straight_where_there_is_room_and_else_to_one_side(
    y_mm: float, aside_mm: float | None, width_mm: float | None
) -> None:
    line = shapely.LineString([ALONG.start, ALONG.end])
    obstacle: Any = Beside(y_mm)
    for other_way in (line, line.reverse()):
        piece = teardrops._piece(ALONG, other_way, 2.2, 1.0, obstacle)
        if aside_mm is None:
            assert not piece
        else:
            (track,) = piece
            assert track.width_mm == pytest.approx(width_mm)
            assert {track.start[1], track.end[1]} == {aside_mm}
            assert line.distance(shapely.LineString([track.start, track.end])) < ALONG.width_mm / 2
