"""Pictures of both sides of a finished board, as SVG and PNG."""

import io
from dataclasses import dataclass
from typing import Any
from xml.sax.saxutils import escape, quoteattr

import shapely
from shapely import LineString, Point, Polygon
from shapely.geometry.base import BaseGeometry

from lumitip_fab.boards.fab.svg_path import disc, mirrored, path_of, polygons, rings
from lumitip_fab.boards.model import MASK_MM, SIDES, BoardModel, Stroke, opening_mm
from lumitip_fab.boards.outline import outline_area
from lumitip_fab.boards.placed import PlacedPad, placed_pads
from lumitip_fab.boards.silk.strokes import silkscreen
from lumitip_fab.design import Side

LAMINATE, PLATED, SILK, SHADE = "#b9a878", "#d8b465", "#f3f2ea", "#8f7434"
MASKS = {"matte black": ("#191b1d", "#303336")}
"""Solder mask on laminate and on copper, by its colour."""
GREEN = "#0c4a34", "#17654a"
"""Where any colour does."""
_ARC = 8  # chords of a quarter circle
_RIM_MM = 0.06  # darker edge of plated holes


@dataclass(frozen=True)
class Painted:
    """An area in one colour."""

    name: str
    area: BaseGeometry
    colour: str


def painted(model: BoardModel, side: Side, mask: str = "") -> tuple[Painted, ...]:
    """The areas seen from a side, in the sensor frame; from the back they are mirrored in x.

    Args:
        model: the board.
        side: from which it is seen.
        mask: colour of its solder mask, as it is ordered.
    """
    board, (on_laminate, on_copper) = model.placement, MASKS.get(mask, GREEN)
    pads = [pad for part in board.components for pad in placed_pads(part) if side in pad.sides]
    drills = _drills(model, pads)
    body = outline_area(board) - drills
    copper = _copper(model, side, pads) & body
    open_ = _openings(model, pads)
    printed = shapely.union_all([_line(s) for where, s in silkscreen(board) if where == side])
    seen = (
        Painted("laminate", body, LAMINATE),
        Painted("mask", body - open_, on_laminate),
        Painted("covered copper", copper - open_, on_copper),
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
    vias = [disc(v.x_mm, v.y_mm, v.diameter_mm) for v in model.routing.vias]
    fills = [fill.area for fill in model.fills if fill.side == side]
    return shapely.union_all([*tracks, *vias, *fills, *(pad.area for pad in pads)])


def _openings(model: BoardModel, pads: list[PlacedPad]) -> BaseGeometry:
    grown = [pad.area.buffer(opening_mm(pad.component), join_style="mitre") for pad in pads]
    board = model.placement
    holes = [disc(*at, diameter_mm + 2 * MASK_MM) for at, diameter_mm in board.unplated]
    return shapely.union_all([*grown, *holes])


def _drills(model: BoardModel, pads: list[PlacedPad]) -> BaseGeometry:
    """Holes that one sees through: vias are covered."""
    board = model.placement
    holes = [disc(*at, diameter_mm) for at, diameter_mm in board.unplated]
    plated = [disc(p.x_mm, p.y_mm, p.pad.drill_mm) for p in pads if p.pad.drill_mm]
    return shapely.union_all([*holes, *plated])


def _line(stroke: Stroke) -> Polygon:
    points = stroke.points
    line = LineString(points) if len(points) > 1 else Point(points[0])
    return line.buffer(stroke.width_mm / 2, quad_segs=_ARC)


def _mirrored(seen: Painted) -> Painted:
    return Painted(seen.name, mirrored(seen.area), seen.colour)


MARGIN_MM = 1.0
_DECIMALS = 3
_DOTS_PER_MM = 32


def svg_picture(seen: tuple[Painted, ...], title: str) -> bytes:
    """The picture as SVG in mm, on no ground.

    Args:
        seen: what is seen, from below to above.
        title: what it shows.
    """
    left, low, right, high = _bounds(seen)
    box = f"{left:g} {-high:g} {right - left:g} {high - low:g}"
    size = f'width="{right - left:g}mm" height="{high - low:g}mm"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" {size}>'
    drawn = "\n".join(
        f'<path id={quoteattr(p.name)} fill="{p.colour}" fill-rule="evenodd" '
        f'd="{path_of(p.area, _DECIMALS)}"/>'
        for p in seen
    )
    return f"{head}\n<title>{escape(title)}</title>\n{drawn}\n</svg>\n".encode()


def png_picture(seen: tuple[Painted, ...]) -> bytes:
    """The picture as PNG on no ground, 32 dots per mm."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import PathPatch

    left, low, right, high = _bounds(seen)
    inches = (right - left) / 25.4, (high - low) / 25.4
    figure = Figure(figsize=inches, dpi=_DOTS_PER_MM * 25.4)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set(xlim=(left, right), ylim=(low, high))
    for each in seen:
        for polygon in polygons(each.area):
            # Unlike add_patch this fits no limits to each of a thousand pieces.
            axes.add_artist(PathPatch(_outline(polygon), facecolor=each.colour, linewidth=0))
    file = io.BytesIO()
    figure.savefig(file, format="png", transparent=True, metadata={"Software": None})
    return file.getvalue()


def _bounds(seen: tuple[Painted, ...]) -> tuple[float, float, float, float]:
    left, low, right, high = seen[0].area.bounds
    return left - MARGIN_MM, low - MARGIN_MM, right + MARGIN_MM, high + MARGIN_MM


def _outline(polygon: Polygon) -> Any:
    """A polygon as matplotlib fills it: holes run the other way round."""
    from matplotlib.path import Path

    closed = [Path(ring, closed=True) for ring in rings(shapely.orient_polygons(polygon))]
    return Path.make_compound_path(*closed)


def picture_files(model: BoardModel, mask: str) -> dict[str, bytes]:
    """PNG and SVG of front and back, by their name.

    Args:
        model: the board.
        mask: colour of its solder mask, as it is ordered.
    """
    board = model.placement
    files = {}
    for side in SIDES:
        seen = painted(model, side, mask)
        title = f"{board.title} {board.revision}, {board.name} board, {side}"
        files[f"{board.name}_{side}.svg"] = svg_picture(seen, title)
        files[f"{board.name}_{side}.png"] = png_picture(seen)
    return files
