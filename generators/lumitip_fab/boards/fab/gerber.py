"""The Gerber layers of a board, and its Excellon drill files: plated and unplated holes apart."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from gerbonara.apertures import Aperture, CircleAperture, ExcellonTool, RectangleAperture
from gerbonara.cam import FileSettings
from gerbonara.excellon import ExcellonFile
from gerbonara.graphic_objects import Arc, Flash, GraphicObject, Line, Region
from gerbonara.rs274x import GerberFile
from gerbonara.utils import MM
from shapely import Polygon

from lumitip_fab.boards.model import MASK_MM, SIDES, BoardModel, Placement, Stroke, opening_mm
from lumitip_fab.boards.outline import EDGE_MM, corners, fractured, straight_edges
from lumitip_fab.boards.placed import PlacedPad, placed_pads
from lumitip_fab.boards.silk.strokes import silkscreen
from lumitip_fab.design import Box, Point, Side


@dataclass
class Attributes(GraphicObject):  # type: ignore[misc]
    """Gerber X2 attributes of the objects that follow; none takes all away."""

    values: dict[str, tuple[str, ...]] = field(default_factory=dict)

    def to_statements(self, _: Any) -> Iterator[str]:
        """The commands that set them."""
        yield "%TD*%"
        for name, fields in self.values.items():
            yield f"%TO.{','.join((name, *fields))}*%"

    def to_primitives(self, _: Any = None) -> Iterator[Any]:
        """Nothing is drawn."""
        return iter(())


def net(name: str) -> Attributes:
    """The attribute of copper of a net."""
    return Attributes({"N": (name,)})


def pad_of(pad: PlacedPad) -> Attributes:
    """The attributes of a pad: its part, its number, its net (`N/C` where it has none)."""
    return Attributes({"P": (pad.component.ref, pad.pad.number), "N": (pad.net or "N/C",)})


def flashed(placed: PlacedPad, grown_mm: float = 0.0) -> GraphicObject:
    """A pad's copper or, grown, the opening in the mask over it."""
    shape, turn = placed.pad, placed.component.angle_deg % 180.0
    width, height = (v + 2 * grown_mm for v in (shape.width_mm, shape.height_mm))
    if shape.round:
        return flash((placed.x_mm, placed.y_mm), CircleAperture(width, unit=MM))
    if math.isclose(turn, 0.0) or math.isclose(turn, 90.0):
        size = (width, height) if math.isclose(turn, 0.0) else (height, width)
        return flash((placed.x_mm, placed.y_mm), RectangleAperture(*size, unit=MM))
    return region(placed.area.buffer(grown_mm, join_style="mitre"))


def dot(at: Point, diameter_mm: float) -> GraphicObject:
    """A round spot."""
    return flash(at, CircleAperture(diameter_mm, unit=MM))


def flash(at: Point, aperture: Aperture) -> GraphicObject:
    """An aperture in one place."""
    return Flash(*_settled(at), aperture, unit=MM, polarity_dark=True)


def line(start: Point, end: Point, width_mm: float) -> GraphicObject:
    """A straight line with round ends."""
    round_ = CircleAperture(width_mm, unit=MM)
    return Line(*_settled(start), *_settled(end), round_, unit=MM, polarity_dark=True)


def lines(stroke: Stroke) -> Iterator[GraphicObject]:
    """A polyline; one point is a dot."""
    if len(stroke.points) == 1:
        yield dot(stroke.points[0], stroke.width_mm)
    for start, end in zip(stroke.points, stroke.points[1:], strict=False):
        yield line(start, end, stroke.width_mm)


def region(area: Polygon) -> GraphicObject:
    """A filled area; holes are joined to its edge by cuts along x."""
    outline = list(fractured(area))
    return Region([*outline, outline[0]], unit=MM, polarity_dark=True)


def _settled(at: Point) -> Point:
    """Rounded to 1 nm, and without a minus before a zero."""
    return round(at[0], 6) + 0.0, round(at[1], 6) + 0.0


_LAYER_FORMAT = (4, 6)  # digits before and after the point: to 1 nm


@dataclass(frozen=True)
class Layer:
    """A layer by its key in the table of fabs, such as `front copper`, and its file."""

    key: str
    data: bytes


def gerber_layers(model: BoardModel) -> Iterator[Layer]:
    """Copper, mask, paste and silkscreen of both sides, the outline, and that of a stiffener."""
    board = model.placement
    pads = [pad for part in board.components for pad in placed_pads(part)]
    for side in SIDES:
        number, place = ("L1", "Top") if side == "front" else ("L2", "Bot")
        here = [pad for pad in pads if side in pad.sides]
        yield _layer(f"{side} copper", _copper(model, side, here), "Copper", number, place)
        yield _layer(f"{side} mask", _mask(board, here), "Soldermask", place, polarity="Negative")
        yield _layer(f"{side} paste", _paste(here), "Paste", place)
        yield _layer(f"{side} silk", _silk(board, side), "Legend", place)
    yield _layer("outline", _outline(board), "Profile", "NP")
    if board.flexible:
        yield _layer("stiffener", _frame(board.flexible.stiffener), "Other", "Stiffener")


def _copper(model: BoardModel, side: Side, pads: list[PlacedPad]) -> Iterator[GraphicObject]:
    for fill in model.fills:
        if fill.side == side:
            yield net(fill.net)
            yield region(fill.area)
    for track in model.routing.tracks:
        if track.side == side:
            yield net(track.net)
            yield line(track.start, track.end, track.width_mm)
    for via in model.routing.vias:
        yield net(via.net)
        yield dot((via.x_mm, via.y_mm), via.diameter_mm)
    for pad in pads:
        yield pad_of(pad)
        yield flashed(pad)


def _mask(board: Placement, pads: list[PlacedPad]) -> Iterator[GraphicObject]:
    """Openings of the solder mask: the layer is negative."""
    yield from (flashed(pad, opening_mm(pad.component)) for pad in pads)
    yield from (dot(at, diameter_mm + 2 * MASK_MM) for at, diameter_mm in board.unplated)


def _paste(pads: list[PlacedPad]) -> Iterator[GraphicObject]:
    yield from (flashed(p) for p in pads if p.pad.paste and not p.pad.drill_mm)


def _silk(board: Placement, side: Side) -> Iterator[GraphicObject]:
    for where, stroke in silkscreen(board):
        if where == side:
            yield from lines(stroke)


def _outline(board: Placement) -> Iterator[GraphicObject]:
    for start, end in straight_edges(board):
        yield line(start, end, EDGE_MM)
    for bow in corners(board):
        centre = bow.centre[0] - bow.start[0], bow.centre[1] - bow.start[1]
        yield Arc(
            *bow.start,
            *bow.end,
            *centre,
            clockwise=False,
            aperture=CircleAperture(EDGE_MM, unit=MM),
            unit=MM,
            polarity_dark=True,
        )


def _frame(box: Box) -> Iterator[GraphicObject]:
    """The edges of a rectangle, on the middle of their lines."""
    x, y = (box.x_min_mm, box.x_max_mm), (box.y_min_mm, box.y_max_mm)
    around = [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1]), (x[0], y[0])]
    yield from (line(*ends, EDGE_MM) for ends in pairwise(around))


def _layer(
    key: str, drawn: Iterable[GraphicObject], *function: str, polarity: str = "Positive"
) -> Layer:
    attributes = {
        ".GenerationSoftware": ("Lumitip", "lumitip-fab"),
        ".SameCoordinates": ("Sensor",),
        ".FileFunction": function,
        ".FilePolarity": (polarity,),
    }
    if key == "outline":
        del attributes[".FilePolarity"]  # the profile has none
    gerber = GerberFile(objects=list(drawn), file_attrs=attributes)
    settings = FileSettings(unit=MM, notation="absolute", number_format=_LAYER_FORMAT)
    return Layer(key, _mended(gerber.write_to_bytes(settings)))


def _mended(data: bytes) -> bytes:
    """Gerbonara 1.5 leaves out one end of a command and writes another twice."""
    return data.replace(b"\nG75\n", b"\nG75*\n").replace(b"G01**", b"G01*") + b"\n"


_DRILL_FORMAT = (3, 4)  # digits before and after the point, which is written
Hole = tuple[Point, float]
"""Middle and finished diameter (mm)."""


def plated_drills(model: BoardModel) -> bytes:
    """Vias and the connector's holes."""
    vias = [((via.x_mm, via.y_mm), via.drill_mm) for via in model.routing.vias]
    pads = [
        ((pad.x_mm, pad.y_mm), pad.pad.drill_mm)
        for part in model.placement.components
        for pad in placed_pads(part)
        if pad.pad.drill_mm
    ]
    return _excellon([*vias, *pads], "Plated,1,2,PTH", plated=True)


def unplated_drills(model: BoardModel) -> bytes:
    """The holes for locating pins or screws, and for threads round the cables."""
    return _excellon(model.placement.unplated, "NonPlated,1,2,NPTH", plated=False)


def _excellon(holes: Iterable[Hole], function: str, plated: bool) -> bytes:
    """The holes by size, then from left to right."""
    drilled = [
        Flash(*at, ExcellonTool(size, plated, unit=MM), unit=MM, polarity_dark=True)
        for at, size in sorted(holes, key=lambda hole: (hole[1], hole[0]))
    ]
    settings = FileSettings(unit=MM, notation="absolute", number_format=_DRILL_FORMAT)
    data: bytes = ExcellonFile(objects=drilled).write_to_bytes(settings)
    return data.replace(b"M48\n", f"M48\n; #@! TF.FileFunction,{function}\n".encode(), 1) + b"\n"
