"""Named bodies of packages, leaded ones, chips, arrays and modules; colours of their materials."""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from typing import Any

from build123d import Color, Compound, Face, Plane, Shape, Solid, Vector, Wire

from lumitip_fab.design import Box, Footprint, Pad, Point
from lumitip_fab.parts.shapes import box_solid, cylinder

Colour = tuple[float, float, float]

METAL: Colour = (0.78, 0.78, 0.76)
GOLD: Colour = (0.86, 0.72, 0.32)
PLASTIC: Colour = (0.10, 0.10, 0.11)
LAMINATE: Colour = (0.10, 0.38, 0.24)
MARK: Colour = (0.85, 0.85, 0.85)
PIN_MM = 0.64
"""Side of a square pin."""
TAIL_MM = 3.0
"""Pin below the board's face."""


@dataclass(frozen=True, eq=False)
class Named:
    """A body of a package."""

    name: str
    solids: Sequence[Any]
    colour: Colour

    def shape(self) -> Shape:
        """The body as a labelled and coloured shape."""
        found = copy(self.solids[0]) if len(self.solids) == 1 else Compound(list(self.solids))
        found.label, found.color = self.name, Color(*self.colour)
        return found


def upright(at: Point, side_mm: float, low_mm: float, high_mm: float) -> Solid:
    """A square pin."""
    half = side_mm / 2
    return box_solid(Box(at[0] - half, at[0] + half, at[1] - half, at[1] + half), low_mm, high_mm)


def bent(profile: Sequence[Point], x_mm: float, width_mm: float) -> Solid:
    """A bent lead: a profile of (y, z) drawn out along x, its middle at a place."""
    start = x_mm - width_mm / 2
    face = Face(Wire.make_polygon([(start, y, z) for y, z in profile], close=True))
    return Solid.extrude(face, Vector(width_mm, 0, 0))


def round_pin(at: Point, diameter_mm: float, low_mm: float, high_mm: float) -> Solid:
    """A round pin."""
    plane = Plane((at[0], at[1], low_mm))
    return Solid.make_cylinder(diameter_mm / 2, high_mm - low_mm, plane)


_STAND_OFF_MM = 0.1
_LEAD_MM = 0.15  # thickness
_FOOT_MM = 0.5  # on the board
_WIDTH_SHARE = 0.65  # of a pad: the lead on it
_DOT_MM = 0.5
_DEEP_MM = 0.05
_IN_MM = 0.3  # from the corner of the body to the dot, beyond its radius


def leaded(shape: Footprint) -> tuple[Named, ...]:
    """Body, leads, and a dot at lead 1."""
    body, height = shape.body, shape.height_mm
    dot_mm = min(_DOT_MM, body.length_mm / 4)
    aside = dot_mm / 2 + _IN_MM
    at = body.x_min_mm + aside, body.y_min_mm + aside
    dot = cylinder(at, dot_mm, height - _DEEP_MM, height)
    leads = [_lead(shape, pad) for pad in shape.pads]
    return (
        Named("body", [box_solid(body, _STAND_OFF_MM, height) - dot], PLASTIC),
        Named("dot", [dot], MARK),
        Named("leads", leads, METAL),
    )


def _lead(shape: Footprint, pad: Pad) -> Solid:
    """From the side of the body down to the board."""
    side = 1.0 if pad.y_mm > 0 else -1.0
    wall, thick = shape.body.y_max_mm, _LEAD_MM
    tip, middle = max(shape.lead_tips_mm / 2, wall + thick), shape.height_mm / 2
    bend = max(tip - _FOOT_MM, (wall + tip) / 2)  # outer face of the upright piece
    profile: tuple[Point, ...] = (
        (wall, middle - thick / 2),
        (wall, middle + thick / 2),
        (bend, middle + thick / 2),
        (bend, thick),
        (tip, thick),
        (tip, 0.0),
        (bend - thick, 0.0),
        (bend - thick, middle - thick / 2),
    )
    if bend - thick <= wall:  # so short that it goes straight down along the body
        profile = (
            (wall, 0.0),
            (wall, middle),
            (bend, middle),
            (bend, thick),
            (tip, thick),
            (tip, 0.0),
        )
    return bent([(side * y, z) for y, z in profile], pad.x_mm, _WIDTH_SHARE * pad.width_mm)


_END_SHARE = 0.2  # of the length, each end
_COLOURS: dict[str, Colour] = {
    "resistor": (0.13, 0.13, 0.14),
    "capacitor": (0.62, 0.47, 0.32),
    "fuse": (0.88, 0.88, 0.82),
    "inductor": (0.27, 0.27, 0.28),
    "crystal": (0.72, 0.70, 0.62),
    "tvs diode": (0.16, 0.16, 0.17),
    "esd diode": (0.16, 0.16, 0.17),
    "schottky diode": (0.16, 0.16, 0.17),
    "led": (0.95, 0.90, 0.70),
    "indicator": (0.80, 0.95, 0.82),
    "photodetector": (0.30, 0.26, 0.34),
}
_OTHER: Colour = (0.5, 0.5, 0.5)
_LENS = ("led", "photodetector", "indicator")
_FOOT_SHARE = 0.4  # of the height of a part with a lens: its ends, and the board under the lens
_LENS_SHARE = 0.7  # of the length
_MODULE_MM = 0.8  # thickness of a module's own board
_CAN_MM = 0.5  # from the sides of the module to its can
_MARK_MM = 0.4


def chip(kind: str, shape: Footprint) -> tuple[Named, ...]:
    """A chip along x; LEDs and detectors have a lens, and a mark at terminal 1."""
    body, height = shape.body, shape.height_mm
    colour = _COLOURS.get(kind, _OTHER)
    end = _END_SHARE * body.width_mm
    inner = Box(body.x_min_mm + end, body.x_max_mm - end, body.y_min_mm, body.y_max_mm)
    ends = (
        Box(body.x_min_mm, inner.x_min_mm, body.y_min_mm, body.y_max_mm),
        Box(inner.x_max_mm, body.x_max_mm, body.y_min_mm, body.y_max_mm),
    )
    if kind not in _LENS:
        metal = [box_solid(box, 0.0, height) for box in ends]
        return Named("body", [box_solid(inner, 0.0, height)], colour), Named("ends", metal, METAL)
    foot, lens = _FOOT_SHARE * height, _LENS_SHARE * body.width_mm / 2
    above = Box(-lens, lens, body.y_min_mm, body.y_max_mm)
    mark = Box(inner.x_min_mm, inner.x_min_mm + end / 2, body.y_min_mm, body.y_max_mm)
    rest = Box(mark.x_max_mm, inner.x_max_mm, body.y_min_mm, body.y_max_mm)
    return (
        Named("lens", [box_solid(above, foot, height)], colour),
        Named("base", [box_solid(rest, 0.0, foot)], MARK),
        Named("mark", [box_solid(mark, 0.0, foot)], LAMINATE),
        Named("ends", [box_solid(box, 0.0, foot) for box in ends], GOLD),
    )


def array(shape: Footprint) -> tuple[Named, ...]:
    """A chip with a metal end at each pad along both sides."""
    body, height, first = shape.body, shape.height_mm, shape.pads[0]
    end, half = _END_SHARE * body.length_mm, first.width_mm / 2
    inner = Box(body.x_min_mm, body.x_max_mm, body.y_min_mm + end, body.y_max_mm - end)
    ends = [
        Box(
            pad.x_mm - half,
            pad.x_mm + half,
            body.y_min_mm if pad.y_mm < 0 else inner.y_max_mm,
            inner.y_min_mm if pad.y_mm < 0 else body.y_max_mm,
        )
        for pad in shape.pads
    ]
    return (
        Named("body", [box_solid(inner, 0.0, height)], _COLOURS["resistor"]),
        Named("ends", [box_solid(box, 0.0, height) for box in ends], METAL),
    )


def module(shape: Footprint) -> tuple[Named, ...]:
    """A module's board with a can, which leaves the end beyond the pads to the antenna; pad 1 has
    a mark."""
    body, first = shape.body, shape.pads[0]
    top = max(pad.y_mm + pad.height_mm / 2 for pad in shape.pads)
    can = Box(
        body.x_min_mm + _CAN_MM, body.x_max_mm - _CAN_MM, body.y_min_mm + _CAN_MM, top - _CAN_MM
    )
    at = can.x_min_mm + 2 * _MARK_MM, min(first.y_mm, can.y_max_mm) - 2 * _MARK_MM
    height, sunk = shape.height_mm, _MARK_MM / 8
    mark = cylinder(at, 2 * _MARK_MM, height - sunk, height)
    return (
        Named("board", [box_solid(body, 0.0, _MODULE_MM)], LAMINATE),
        Named("can", [box_solid(can, _MODULE_MM, height) - mark], METAL),
        Named("mark", [mark], LAMINATE),
    )
