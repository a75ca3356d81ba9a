"""What is seen of a board from one side: areas with their colours, from below to above."""

from dataclasses import dataclass

import shapely
from shapely import LineString, Point, Polygon, affinity
from shapely.geometry.base import BaseGeometry

from lumitip_fab.boards.edges import outline_area
from lumitip_fab.boards.geometry import PlacedPad, placed_pads
from lumitip_fab.boards.model import BoardModel, Side, Stroke
from lumitip_fab.boards.openings import MASK_MM, opening_mm
from lumitip_fab.boards.silk import silkscreen

LAMINATE, MASK, COVERED, PLATED, SILK, SHADE = (
    "#b9a878", "#0c4a34", "#17654a", "#d8b465", "#f3f2ea", "#8f7434",
)  # fmt: skip
_ARC = 8  # chords of a quarter circle
_RIM_MM = 0.06  # darker edge of plated holes


@dataclass(frozen=True)
class Painted:
    """An area in one colour."""

    name: str
    area: BaseGeometry
    colour: str


def painted(model: BoardModel, side: Side) -> tuple[Painted, ...]:
    """The areas seen from a side, in the sensor frame; from the back they are mirrored in x."""
    board = model.placement
    pads = [pad for part in board.components for pad in placed_pads(part) if side in pad.sides]
    drills = _drills(model, pads)
    body = outline_area(board) - drills
    copper = _copper(model, side, pads) & body
    open_ = _openings(model, pads)
    printed = shapely.union_all([_line(s) for where, s in silkscreen(board) if where == side])
    seen = (
        Painted("laminate", body, LAMINATE),
        Painted("mask", body - open_, MASK),
        Painted("covered copper", copper - open_, COVERED),
        Painted("plated copper", copper & open_, PLATED),
        Painted("rims", (drills.buffer(_RIM_MM) - drills) & copper & open_, SHADE),
        Painted("silkscreen", (printed & body) - open_, SILK),
    )
    return seen if side == "front" else tuple(map(_mirrored, seen))


def _copper(model: BoardModel, side: Side, pads: list[PlacedPad]) -> BaseGeometry:
    tracks = [
        LineString((t.start, t.end)).buffer(t.width_mm / 2, quad_segs=_ARC)
        for t in model.routing.tracks
        if t.side == side
    ]
    vias = [_disc(v.x_mm, v.y_mm, v.diameter_mm) for v in model.routing.vias]
    fills = [fill.area for fill in model.fills if fill.side == side]
    return shapely.union_all([*tracks, *vias, *fills, *(pad.area for pad in pads)])


def _openings(model: BoardModel, pads: list[PlacedPad]) -> BaseGeometry:
    grown = [pad.area.buffer(opening_mm(pad.component), join_style="mitre") for pad in pads]
    board = model.placement
    holes = [_disc(x, y, board.hole_mm + 2 * MASK_MM) for x, y in board.holes]
    return shapely.union_all([*grown, *holes])


def _drills(model: BoardModel, pads: list[PlacedPad]) -> BaseGeometry:
    """Holes that one sees through: vias are covered."""
    board = model.placement
    holes = [_disc(x, y, board.hole_mm) for x, y in board.holes]
    plated = [_disc(p.x_mm, p.y_mm, p.pad.drill_mm) for p in pads if p.pad.drill_mm]
    return shapely.union_all([*holes, *plated])


def _line(stroke: Stroke) -> Polygon:
    points = stroke.points
    line = LineString(points) if len(points) > 1 else Point(points[0])
    return line.buffer(stroke.width_mm / 2, quad_segs=_ARC)


def _disc(x_mm: float, y_mm: float, diameter_mm: float) -> Polygon:
    return Point(x_mm, y_mm).buffer(diameter_mm / 2, quad_segs=2 * _ARC)


def _mirrored(seen: Painted) -> Painted:
    return Painted(seen.name, affinity.scale(seen.area, -1, 1, origin=(0, 0)), seen.colour)
