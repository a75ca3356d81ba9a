"""Pieces of a Gerber layer, in the sensor frame, which is y up as Gerber is."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from gerbonara.apertures import Aperture, CircleAperture, RectangleAperture
from gerbonara.graphic_objects import Flash, GraphicObject, Line, Region
from gerbonara.utils import MM
from shapely import Polygon

from lumitip_fab.boards.model import Stroke
from lumitip_fab.boards.outline import fractured
from lumitip_fab.boards.placed import PlacedPad
from lumitip_fab.design import Point


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


def pad(placed: PlacedPad, grown_mm: float = 0.0) -> GraphicObject:
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
