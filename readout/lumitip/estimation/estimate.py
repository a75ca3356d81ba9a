"""`Estimate`: the pose of the object between the fingers, with how sure it is.

Sensor frame of the receiver: millimetres, x to the right, y towards the tip; angles in degrees,
counter-clockwise from +x. A line has a direction `angle_deg` and its signed distance
`offset_mm` from the origin along its left normal (−sin, cos).
"""

from dataclasses import dataclass

import numpy as np

from lumitip.grid import Floats

KINDS = ("edge", "cable", "corner")
Point = tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Estimate:
    """The pose in one frame; without contact the numbers are NaN."""

    kind: str
    """`"edge"`, `"cable"`, `"corner"`; without contrast `"none"` or `"covered"`."""
    offset_mm: float
    """Signed distance of the line from the origin along its left normal (mm): the border of an
    edge, the axis of a cable, of a corner the border whose direction is closer to the x axis."""
    angle_deg: float
    """Direction of that line, in (−90, 90]."""
    width_mm: float
    """Diameter of a cable (mm), NaN for other kinds."""
    transmittance: float
    """Share of light that passes the object, 0 to 1."""
    gain: float
    """Light beside the object as a share of the empty grasp."""
    covariance: Floats
    """Of `parameters`, shape `(p, p)`: what the misfit of the frame leaves uncertain."""
    quality: float
    """Share of the variance of the frame that the fit explains, at most 1."""
    curvature_per_mm: float = 0.0
    """One over the radius of a cable that a tracker found to bend, positive to the left of
    `angle_deg` (1/mm). It is sought with `kind="cable"`, where a straight one was followed before;
    else, and where a straight line explains the frame, 0."""
    rms_counts: float = np.nan
    """Root mean square misfit (counts of 255)."""
    flags: tuple[str, ...] = ()
    """Faults of the fit, empty if there are none: `"misfit"` if the shape does not explain
    the frame, `"weak"` if the frame hardly shows the line, `"astray"` if the fit left the
    fingertip, `"unfinished"` if it did not settle, `"ambiguous"` if another line explains the frame
    nearly as well."""
    dark_side: str = ""
    """Side of the line that an edge's or corner's sheet lies on, `"left"` or `"right"`."""
    vertex_mm: Point | None = None
    """Vertex of a corner (mm)."""
    opening_deg: float = np.nan
    """Opening of a corner."""
    direction_deg: float = np.nan
    """Direction from a corner's vertex into the sheet, in [−180, 180]."""
    parameters: tuple[str, ...] = ()
    """Names of what `covariance` is of."""

    @property
    def trusted(self) -> bool:
        """Whether there is a line and nothing is wrong with it."""
        return self.kind in KINDS and not self.flags

    @property
    def offset_sd_mm(self) -> float:
        """Standard deviation of `offset_mm` (mm)."""
        return self._deviation("offset_mm")

    @property
    def angle_sd_deg(self) -> float:
        """Standard deviation of `angle_deg` (degrees)."""
        return self._deviation("angle_deg")

    def _deviation(self, name: str) -> float:
        if name not in self.parameters:
            return float("nan")
        at = self.parameters.index(name)
        return float(np.sqrt(max(self.covariance[at, at], 0.0)))


def without_contact(kind: str) -> Estimate:
    """The estimate of a frame without contrast."""
    nan = float("nan")
    return Estimate(kind, nan, nan, nan, nan, nan, np.empty((0, 0)), nan)


def half_turn(offset_mm: float, angle_deg: float) -> tuple[float, float, bool]:
    """The same line with its direction in (−90, 90], and whether it was turned round."""
    angle = (angle_deg + 180.0) % 360.0 - 180.0
    if -90.0 < angle <= 90.0:
        return offset_mm, angle, False
    return -offset_mm, angle - 180.0 if angle > 0.0 else angle + 180.0, True
