"""A board's outline as lines and arcs, counter-clockwise from the lower left, and as an area."""

import math
from dataclasses import dataclass

from shapely import Polygon, box

from lumitip_fab.boards.model import Placement
from lumitip_fab.design import Point

EDGE_MM = 0.1
"""Width of the line that is drawn; its middle is the edge."""
_QUARTER_STEPS = 32


@dataclass(frozen=True)
class Corner:
    """A round corner."""

    start: Point
    middle: Point
    end: Point
    centre: Point


def straight_edges(board: Placement) -> tuple[tuple[Point, Point], ...]:
    """The four sides, without their corners."""
    outline, r = board.outline, board.corner_mm
    left, right = outline.x_min_mm, outline.x_max_mm
    low, high = outline.y_min_mm, outline.y_max_mm
    return (
        ((left + r, low), (right - r, low)), ((right, low + r), (right, high - r)),
        ((right - r, high), (left + r, high)), ((left, high - r), (left, low + r)),
    )  # fmt: skip


def corners(board: Placement) -> tuple[Corner, ...]:
    """The arc after each side; none where corners are square."""
    if not board.corner_mm:
        return ()
    sides = straight_edges(board)
    found = []
    for i, (_, start) in enumerate(sides):
        end = sides[(i + 1) % 4][0]
        along_x = i % 2 == 0  # this side runs along x, so the centre is straight above its end
        centre = (start[0], end[1]) if along_x else (end[0], start[1])
        out = [(a + b) / 2 - c for a, b, c in zip(start, end, centre, strict=True)]
        scale = board.corner_mm / math.hypot(*out)
        middle = (centre[0] + out[0] * scale, centre[1] + out[1] * scale)
        found.append(Corner(start, middle, end, centre))
    return tuple(found)


def outline_area(board: Placement) -> Polygon:
    """The board without its holes."""
    outline, r = board.outline, board.corner_mm
    whole = box(outline.x_min_mm, outline.y_min_mm, outline.x_max_mm, outline.y_max_mm)
    return whole.buffer(-r, join_style="mitre").buffer(r, quad_segs=_QUARTER_STEPS) if r else whole
