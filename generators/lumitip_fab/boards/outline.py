"""A board's outline as lines and arcs, and areas with holes as single closed lines."""

import math
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import LinearRing, Polygon, box
from shapely.geometry.polygon import orient

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
        ((left + r, low), (right - r, low)),
        ((right, low + r), (right, high - r)),
        ((right - r, high), (left + r, high)),
        ((left, high - r), (left, low + r)),
    )


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
    whole = box(*outline.bounds_mm)
    return whole.buffer(-r, join_style="mitre").buffer(r, quad_segs=_QUARTER_STEPS) if r else whole


Corners = NDArray[np.float64]
_NM = 6  # decimals: everything is rounded to 1 nm before it is cut, so that cuts coincide


def fractured(area: Polygon) -> tuple[Point, ...]:
    """The corners of one closed line round an area, clockwise, the first not repeated.

    Each hole is joined by a cut of no width, along x, from its leftmost corner to what lies left
    of it. In KiCad 6, a fill that winds the other way connects nothing.
    """
    area = orient(area, -1.0)
    line = _corners(area.exterior)
    holes = [_from_leftmost(_corners(ring)) for ring in area.interiors]
    for hole in sorted(holes, key=lambda corners: tuple(corners[0])):
        line = _joined(line, hole)
    return tuple((float(x), float(y)) for x, y in line)


def _corners(ring: LinearRing) -> Corners:
    """Rounded corners of shape `(n, 2)`, coinciding ones once."""
    rounded = np.round(shapely.get_coordinates(ring)[:-1], _NM) + 0.0
    return np.asarray(rounded[(rounded != np.roll(rounded, 1, axis=0)).any(axis=1)])


def _from_leftmost(corners: Corners) -> Corners:
    return np.roll(corners, -int(np.lexsort((corners[:, 1], corners[:, 0]))[0]), axis=0)


def _joined(line: Corners, hole: Corners) -> Corners:
    """The line with a way to the hole, round it, and back."""
    x, y = hole[0]
    a, b = line, np.roll(line, -1, axis=0)
    level = a[:, 1] == b[:, 1]
    share = (y - a[:, 1]) / np.where(level, 1.0, b[:, 1] - a[:, 1])
    at = np.round(a[:, 0] + (b[:, 0] - a[:, 0]) * share, _NM)
    met = ~level & (share >= 0) & (share <= 1) & (at <= x)
    before = int(np.where(met, at, -np.inf).argmax())
    foot = np.array([(at[before], y)])
    way_in = foot if (foot[0] != a[before]).any() else foot[:0]
    way_out = foot if (foot[0] != b[before]).any() else foot[:0]
    return np.concatenate([line[: before + 1], way_in, hole, hole[:1], way_out, line[before + 1 :]])
