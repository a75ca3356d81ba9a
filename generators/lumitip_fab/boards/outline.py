"""Outline and routed openings of a board as lines and arcs; areas with holes as one closed line."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import LinearRing, Polygon, box
from shapely.geometry.polygon import orient

from lumitip_fab.boards.model import Placement, Slot
from lumitip_fab.design import Point

EDGE_MM = 0.1
"""Width of the line that is drawn; its middle is the edge."""
_QUARTER_STEPS = 32
_SHORTEST_MM = 1e-5


@dataclass(frozen=True)
class Corner:
    """A round corner."""

    start: Point
    middle: Point
    end: Point
    centre: Point


def straight_edges(board: Placement) -> tuple[tuple[Point, Point], ...]:
    """The four sides and those of routed openings, without their corners."""
    return (*_sides(board), *(side for slot in board.slots for side in _straight(slot)))


def _sides(board: Placement) -> tuple[tuple[Point, Point], ...]:
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
    """The arc after each side, then those of routed openings; none where corners are square."""
    bends = tuple(bow for slot in board.slots for bow, _ in _bends(slot) if bow)
    if not board.corner_mm:
        return bends
    sides = _sides(board)
    found = []
    for i, (_, start) in enumerate(sides):
        end = sides[(i + 1) % 4][0]
        along_x = i % 2 == 0  # this side runs along x, so the centre is straight above its end
        centre = (start[0], end[1]) if along_x else (end[0], start[1])
        found.append(_corner(start, end, centre))
    return (*found, *bends)


def _corner(start: Point, end: Point, centre: Point) -> Corner:
    out = [(a + b) / 2 - c for a, b, c in zip(start, end, centre, strict=True)]
    scale = math.dist(start, centre) / math.hypot(*out)
    return Corner(start, (centre[0] + out[0] * scale, centre[1] + out[1] * scale), end, centre)


def _bends(slot: Slot) -> Iterator[tuple[Corner | None, tuple[Point, Point]]]:
    """The arc in each corner of an opening, always counter-clockwise, and the ends of that corner
    in the order of the opening."""
    places = np.array([at for at, _ in slot])
    ahead = np.roll(places, -1, axis=0) - places
    ahead /= np.hypot(*ahead.T)[:, None]
    for (at, radius), way_in, way_out in zip(slot, np.roll(ahead, 1, axis=0), ahead, strict=True):
        start, end = _point(at - way_in * radius), _point(at + way_out * radius)
        centre = _point(at + (way_out - way_in) * radius)
        left = way_in[0] * way_out[1] - way_in[1] * way_out[0] > 0
        ends = (start, end) if left else (end, start)
        yield _corner(*ends, centre) if radius else None, (start, end)


def _point(at: NDArray[np.float64]) -> Point:
    x, y = np.round(at, _NM) + 0.0
    return float(x), float(y)


def _straight(slot: Slot) -> Iterator[tuple[Point, Point]]:
    """The sides of an opening between its corners, without those that corners take whole."""
    ends = [pair for _, pair in _bends(slot)]
    for (_, start), (end, _) in zip(ends, ends[1:] + ends[:1], strict=True):
        if math.dist(start, end) > _SHORTEST_MM:
            yield start, end


def slot_area(slot: Slot) -> Polygon:
    """The area of a routed opening."""
    line: list[Point] = []
    for bow, (start, end) in _bends(slot):
        line += [start, *_between(bow, start), end] if bow else [start]
    return Polygon(line)


def _between(bow: Corner, start: Point) -> Iterator[Point]:
    """Points of an arc from one of its ends to the other, without both."""
    x, y = bow.centre
    first, last = (math.atan2(p[1] - y, p[0] - x) for p in (bow.start, bow.end))
    radius, sweep = math.dist(bow.start, bow.centre), (last - first) % math.tau
    for step in range(1, _QUARTER_STEPS):
        share = step / _QUARTER_STEPS
        angle = first + sweep * (share if start == bow.start else 1 - share)
        yield x + radius * math.cos(angle), y + radius * math.sin(angle)


def outline_area(board: Placement) -> Polygon:
    """The board without its holes and routed openings."""
    outline, r = board.outline, board.corner_mm
    whole = box(*outline.bounds_mm)
    whole = whole.buffer(-r, join_style="mitre").buffer(r, quad_segs=_QUARTER_STEPS) if r else whole
    if not board.slots:
        return whole
    return shapely.difference(whole, shapely.union_all([slot_area(slot) for slot in board.slots]))


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
