"""Named and coloured bodies of a package, and the colours of their materials."""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from typing import Any

from build123d import Color, Compound, Face, Plane, Shape, Solid, Vector, Wire

from lumitip_fab.design import Box, Point
from lumitip_fab.parts.shapes import box_solid

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
