"""Objects between the fingers, by their signed distance, in the receiver's sensor frame.

Every object has a height in the gap (0 at the receiver, 1 at the emitter), a clear transmittance
(light that passes straight) and a diffuse one (light that the object scatters). A scene is one
object or a sequence of them; the empty sequence is the empty grasp.

For all lines `angle_deg` is the direction, and `offset_mm` the signed distance from the origin
along the left normal (−sin, cos).
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip import arguments
from lumitip.twin.lines import Numbers, beside_arc, from_arc, from_foot
from lumitip.twin.optics import TwinError
from lumitip.values import shown

Singles = NDArray[np.float32]
PIXEL_MM = 0.5
"""Pixel of the rasters (mm)."""
MOST_DIAMETER_MM = 200.0
"""Largest diameter of a cable, far more than covers a fingertip (mm)."""


def covered(outside_mm: Numbers, pixel_mm: float = PIXEL_MM) -> Numbers:
    """Covered share of each pixel, from the signed distance of its centre (mm)."""
    share: Numbers = outside_mm * (-1.0 / pixel_mm)
    share += 0.5
    np.maximum(share, 0.0, out=share)
    np.minimum(share, 1.0, out=share)
    return share


@dataclass(frozen=True, kw_only=True)
class Thing(ABC):
    """An object between the fingers."""

    clear: float = 0.0
    """Share of light that passes straight."""
    diffuse: float = 0.0
    """Share of light that passes scattered."""
    height: float = 0.5
    """Height in the gap: 0 on the receiver, 1 on the emitter."""

    def __post_init__(self) -> None:
        arguments.finite_fields(self, TwinError)
        if not (self.clear >= 0.0 and self.diffuse >= 0.0 and self.clear + self.diffuse <= 1.0):
            raise TwinError(
                f"clear is {self.clear} and diffuse is {self.diffuse}; neither may be below 0, and "
                "their sum is 1 at most"
            )
        if not 0.0 <= self.height <= 1.0:
            raise TwinError(f"height is {self.height}; 0 (receiver) to 1 (emitter) is needed")

    def layers(self, x_mm: Numbers, y_mm: Numbers, pixel_mm: float = PIXEL_MM) -> Sequence[Numbers]:
        """Coverage by each layer of the material at places (mm)."""
        return (self.coverage(x_mm, y_mm, pixel_mm),)

    @abstractmethod
    def coverage(self, x_mm: Numbers, y_mm: Numbers, pixel_mm: float = PIXEL_MM) -> Numbers:
        """Covered share of a pixel around each place, 0 to 1."""


@dataclass(frozen=True, kw_only=True)
class Shape(Thing):
    """An object that is defined by the distance from its border."""

    hem_mm: float = 0.0
    """Width of a hem along the border, where the material is double (mm)."""

    def __post_init__(self) -> None:
        super().__post_init__()
        arguments.number(self.hem_mm, "hem_mm", 0.0, error=TwinError)

    @abstractmethod
    def signed_distance_mm(self, x_mm: Numbers, y_mm: Numbers) -> Numbers:
        """Distance of places from the border, negative inside the object (mm)."""

    def coverage(self, x_mm: Numbers, y_mm: Numbers, pixel_mm: float = PIXEL_MM) -> Numbers:
        return covered(self.signed_distance_mm(x_mm, y_mm), pixel_mm)

    def layers(self, x_mm: Numbers, y_mm: Numbers, pixel_mm: float = PIXEL_MM) -> Sequence[Numbers]:
        """The material, and the hem on it."""
        outside_mm = self.signed_distance_mm(x_mm, y_mm)
        whole = covered(outside_mm, pixel_mm)
        if not self.hem_mm:
            return (whole,)
        return whole, whole - covered(outside_mm + self.hem_mm, pixel_mm)


@dataclass(frozen=True)
class Line(Shape):
    """An object along a line, or along an arc that touches it at its point nearest the origin."""

    offset_mm: float = 0.0
    angle_deg: float = 0.0
    curvature_per_mm: float = 0.0
    """One over the radius, positive for a bend to the left (1/mm)."""

    def left_of(self, x_mm: Numbers, y_mm: Numbers) -> tuple[Numbers, Numbers]:
        """Signed distance of places from the line along its left normal (mm), and the direction
        of the line beside each place (degrees)."""
        left, x, y = from_foot(x_mm, y_mm, self.offset_mm, *self._way)
        bend = self.curvature_per_mm
        if not bend:
            return left, np.full(np.shape(left), float(self.angle_deg))
        return from_arc(left, x, y, bend), beside_arc(x, y, bend, *self._way)

    def left_mm(self, x_mm: Numbers, y_mm: Numbers) -> Numbers:
        """The distance of `left_of` alone (mm)."""
        left, x, y = from_foot(x_mm, y_mm, self.offset_mm, *self._way)
        return from_arc(left, x, y, self.curvature_per_mm) if self.curvature_per_mm else left

    @property
    def _way(self) -> tuple[float, float]:
        angle = math.radians(self.angle_deg)
        return math.cos(angle), math.sin(angle)


@dataclass(frozen=True)
class HalfPlane(Line):
    """A sheet whose edge is the line: it covers everything right of it."""

    def signed_distance_mm(self, x_mm: Numbers, y_mm: Numbers) -> Numbers:
        return self.left_mm(x_mm, y_mm)


@dataclass(frozen=True)
class Cable(Line):
    """A round cable whose axis is the line. It takes rays that pass within its radius, so its
    shadow is wider in slanting light."""

    diameter_mm: float = 3.0

    def __post_init__(self) -> None:
        super().__post_init__()
        arguments.number(
            self.diameter_mm, "diameter_mm", most=MOST_DIAMETER_MM, above=0.0, error=TwinError
        )

    def signed_distance_mm(self, x_mm: Numbers, y_mm: Numbers) -> Numbers:
        """Distance from the cable seen from above; slanting rays need `shade`."""
        away: Numbers = np.abs(self.left_mm(x_mm, y_mm)) - self.diameter_mm / 2.0
        return away

    def shade(
        self, x_mm: Numbers, y_mm: Numbers, across: Numbers, along: Numbers, pixel_mm: float
    ) -> Numbers:
        """Share of rays that the cable takes.

        Args:
            x_mm: where the rays cross the plane of the axis (mm).
            y_mm: the same along y (mm).
            across: their slopes dx/dz.
            along: their slopes dy/dz.
            pixel_mm: width of the soft border (mm).
        """
        left_mm, beside_deg = self.left_of(x_mm, y_mm)
        beside = np.radians(beside_deg)
        slant = along * np.cos(beside) - across * np.sin(beside)
        return covered(np.abs(left_mm) - self.diameter_mm / 2.0 * np.sqrt(1.0 + slant**2), pixel_mm)


@dataclass(frozen=True)
class Corner(Shape):
    """A corner of a sheet: vertex, direction from there into the sheet, opening."""

    x_mm: float = 0.0
    y_mm: float = 0.0
    angle_deg: float = -90.0
    opening_deg: float = 90.0

    def __post_init__(self) -> None:
        super().__post_init__()
        arguments.number(self.opening_deg, "opening_deg", most=360.0, above=0.0, error=TwinError)

    def signed_distance_mm(self, x_mm: Numbers, y_mm: Numbers) -> Numbers:
        """See `Shape`; beyond the vertex the distance from the line of the nearer edge."""
        angle, half = math.radians(self.angle_deg), math.radians(self.opening_deg) / 2.0
        x, y = x_mm - self.x_mm, y_mm - self.y_mm
        cos, sin = math.cos(angle), math.sin(angle)
        inward, side = x * cos + y * sin, y * cos - x * sin
        away: Numbers = np.abs(side) * math.cos(half) - inward * math.sin(half)
        return away


@dataclass(frozen=True)
class Disc(Shape):
    """A flat disc: middle and diameter (mm)."""

    x_mm: float = 0.0
    y_mm: float = 0.0
    diameter_mm: float = 10.0

    def __post_init__(self) -> None:
        super().__post_init__()
        arguments.number(self.diameter_mm, "diameter_mm", above=0.0, error=TwinError)

    def signed_distance_mm(self, x_mm: Numbers, y_mm: Numbers) -> Numbers:
        away: Numbers = np.hypot(x_mm - self.x_mm, y_mm - self.y_mm) - self.diameter_mm / 2.0
        return away


@dataclass(frozen=True)
class Sheet(Shape):
    """A sheet that covers everything."""

    def signed_distance_mm(self, x_mm: Numbers, y_mm: Numbers) -> Numbers:
        """See `Shape`; the border is far away."""
        return np.full(np.broadcast_shapes(np.shape(x_mm), np.shape(y_mm)), -1e6)


Scene = Thing | Sequence[Thing]


def things(scene: Scene) -> tuple[Thing, ...]:
    """The objects of a scene.

    Raises:
        TwinError: if it is no scene.
    """
    if isinstance(scene, Thing):
        return (scene,)
    found = tuple(scene) if isinstance(scene, Iterable) else (scene,)
    for thing in found:
        if not isinstance(thing, Thing):
            raise TwinError(
                f"scene is {shown(scene)}; an object such as Cable(angle_deg=30.0), or a list of "
                "objects, is needed. The empty grasp is ()."
            )
    return found
