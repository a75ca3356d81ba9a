"""`Contact`: the object between the fingers, from one frame.

Sensor frame of the receiver: millimetres, x to the right, y towards the tip; angles in degrees,
counter-clockwise from +x.
"""

from dataclasses import dataclass

from lumitip.grid import Floats
from lumitip.values import one_line

Point = tuple[float, float]
SHAPES = ("none", "edge", "corner", "cable", "covered")


@dataclass(frozen=True, slots=True)
class Line:
    """The straight line closest to all markers, by total least squares."""

    point_mm: Point
    """Mean of the markers, which lies on the line (mm)."""
    angle_deg: float
    """Direction of the line, in (−90, 90]."""
    rms_mm: float
    """Root mean square distance of the markers to the line (mm)."""


@dataclass(frozen=True, slots=True)
class Corner:
    """Two straight rays that meet, each fitted to its own part of the markers."""

    vertex_mm: Point
    """Point where the rays meet (mm)."""
    directions_deg: tuple[float, float]
    """Directions of the rays away from the vertex, in (−180, 180]; the first, turned
    counter-clockwise by `opening_deg`, is the second."""
    opening_deg: float
    """Angle between the rays, in (0, 180)."""
    rms_mm: float
    """Root mean square distance of the markers to the line of their own ray (mm)."""


@dataclass(frozen=True, slots=True)
class Cable:
    """Two parallel borders with dark cells between them, and the axis in their middle."""

    axis_point_mm: Point
    """Point of the axis nearest to the mean of the markers (mm)."""
    angle_deg: float
    """Direction of the axis, in (−90, 90]."""
    width_mm: float
    """Distance of the two borders (mm)."""
    rms_mm: float
    """Root mean square distance of the markers to their own border (mm)."""


@dataclass(frozen=True, slots=True, eq=False)
class Contact:
    """Results of one frame; without contrast every field but `shape` is `None`."""

    shape: str
    """One of `SHAPES`; for the rule see `lumitip.processing.processor`."""
    threshold: float | None = None
    """λ: cells with a value below it are dark (255 is full light)."""
    contrast: float | None = None
    """Difference between the means of the light and the dark cluster (counts of 255)."""
    centre_mm: Point | None = None
    """Dark centre: mean of the dark cells, each weighted with 255 − value (mm)."""
    markers_mm: Floats | None = None
    """Points between neighbours where the value crosses λ, shape `(k, 2)`, read-only (mm)."""
    line: Line | None = None
    """`None` with fewer than two markers, with markers that have no main direction, or if all cells
    lie on one line."""
    corner: Corner | None = None
    """`None` unless two rays that meet fit the markers."""
    cable: Cable | None = None
    """`None` unless there is light on both sides of the dark cells."""

    def __repr__(self) -> str:
        return one_line(self)
