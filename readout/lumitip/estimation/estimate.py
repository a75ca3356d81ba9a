"""`Estimate`: the pose of the object between the fingers, with its uncertainty.

Sensor frame of the receiver: millimetres, x to the right, y towards the tip; angles in degrees,
counter-clockwise from +x. A line has the direction `angle_deg` and the signed distance
`offset_mm` from the origin along its left normal (−sin, cos).
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip.estimation.fit import Fit
from lumitip.estimation.shapes import Shape
from lumitip.grid import Floats
from lumitip.processing.contact import Point
from lumitip.values import one_line

KINDS = ("edge", "cable", "corner")
LEAST_CELLS = 4
"""Fewer do not show a line."""
MISFIT_COUNTS = 16.0
"""Root mean square misfit above which the shape does not explain the frame. Of the published
frames the cloth edge has 9 counts; corner and cable have 18 to 29, since their shapes have neither
hem nor bend."""
MOST_GAIN = 1.04
"""Light beside the object, as a share of the tare's, above which there is more light than then:
ambient light, or LEDs that were colder at the tare. Frames of other optics than expected stay below
1.00, with 5 % more light below 1.03 for a cable."""
FAINT_CONTRAST = 10.0
"""Least contrast (counts of 255) of a cable that the cells hardly see, such as one of 3 mm between
two rows of cells: noise and 1 % of drift of an empty grasp stay below."""
BEND = "curvature_per_mm"
_WEAK_MM, _WEAK_DEG = 1.0, 6.0
_LEAST_GAIN = 1e-3  # with less light beside an object nothing is known of what it lets through


@dataclass(frozen=True, slots=True, eq=False)
class Estimate:
    """The pose in one frame; without contact the numbers are NaN."""

    kind: str
    """`"edge"`, `"cable"`, `"corner"`; without contrast `"none"` or `"covered"`."""
    offset_mm: float
    """Signed distance of the line from the origin along its left normal (mm). The line is the
    border of an edge, the axis of a cable, or the border of a corner that is closer to the x axis
    in direction."""
    angle_deg: float
    """Direction of that line, in (−90, 90]."""
    width_mm: float
    """Diameter of a cable (mm), NaN for other kinds."""
    transmittance: float
    """Share of light that passes the object, 0 to 1; NaN without light beside it."""
    gain: float
    """Light beside the object as a share of the empty grasp."""
    covariance: Floats
    """Covariance of `parameters` from the misfit of the frame, shape `(p, p)`."""
    quality: float
    """Share of the variance of the frame that the fit explains, at most 1."""
    curvature_per_mm: float = 0.0
    """One over the radius of a bent cable, positive to the left of `angle_deg` (1/mm). Only a
    tracker with `kind="cable"` fits it, after a straight cable; 0 if a straight line fits."""
    rms_counts: float = np.nan
    """Root mean square misfit (counts of 255)."""
    flags: tuple[str, ...] = ()
    """Faults of the fit: `"misfit"` if the shape does not explain the frame, `"weak"` if the frame
    hardly shows the line, `"astray"` if the fit left the fingertip, `"unfinished"` if it did not
    converge, `"bright"` if there is more light beside the object than at the tare, `"ambiguous"` if
    another line explains the frame nearly as well, `"dead"` if it is without cells that read an
    end of the scale: dead, or covered by another object; or if fewer than four cells have a value,
    so that nothing is known of the grasp."""
    dark_side: str = ""
    """Side of the line on which the sheet of an edge or corner is, `"left"` or `"right"`."""
    vertex_mm: Point | None = None
    """Vertex of a corner (mm)."""
    opening_deg: float = np.nan
    """Opening of a corner."""
    direction_deg: float = np.nan
    """Direction from a corner's vertex into the sheet, in [−180, 180]."""
    parameters: tuple[str, ...] = ()
    """Names of the rows of `covariance`, those of the numbers above: all kinds have `angle_deg`,
    `offset_mm`, `transmittance` (before it is limited to 0 to 1; no row where it is NaN) and
    `gain`; a cable has `width_mm` and may have `curvature_per_mm`, a corner `direction_deg`,
    `opening_deg`, and its vertex as `x_mm` and `y_mm`."""
    left_out: tuple[int, ...] = ()
    """Cells that the estimate does not use: those without a finite value, and a few that read an
    end of the scale while all others agree on a line: dead, stuck or covered."""

    def __repr__(self) -> str:
        return one_line(self)

    @property
    def trusted(self) -> bool:
        """Whether there is a line without flags."""
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


def contrast(values: Floats) -> float:
    """Between the lightest value and the darkest but one, of two or more: a single cell may be dead
    or dirty, and an empty grasp with it is no contact."""
    return float(values.max() - np.partition(values, 1)[1])


def without_contact(kind: str, usable: NDArray[np.bool_]) -> Estimate:
    """The estimate of a frame without contrast in its usable cells, shape `(cells,)`."""
    nan = float("nan")
    lost = tuple(np.flatnonzero(~usable).tolist())
    flags = ("dead",) if usable.size - len(lost) < LEAST_CELLS else ()
    none = np.empty((0, 0))
    return Estimate(kind, nan, nan, nan, nan, nan, none, nan, flags=flags, left_out=lost)


def half_turn(offset_mm: float, angle_deg: float) -> tuple[float, float, bool]:
    """The same line with its direction in (−90, 90], and whether it was reversed."""
    angle = (angle_deg + 180.0) % 360.0 - 180.0
    if -90.0 < angle <= 90.0:
        return offset_mm, angle, False
    return -offset_mm, angle - 180.0 if angle > 0.0 else angle + 180.0, True


def report(
    shape: Shape,
    found: Fit,
    uncertain: Floats,
    reach_mm: float,
    mirrored: bool = False,
    flags: tuple[str, ...] = (),
) -> Estimate:
    """The estimate from a fit.

    Args:
        shape: the fitted object.
        found: the fit.
        uncertain: its `covariance`.
        reach_mm: distance from the origin beyond which no cell sees a line (mm).
        mirrored: whether all cells lie on one line, so that a pose and its mirror image look alike.
        flags: more flags.
    """
    pose, corner = found.pose, shape.kind == "corner"
    (angle, offset_mm), by_pose, names = _line(pose, shape.names)
    offset_mm, angle_deg, turned = half_turn(offset_mm, math.degrees(angle))
    spread = by_pose @ uncertain @ by_pose.T
    seen = dict(zip(names, np.sqrt(np.abs(np.diag(spread))), strict=True))
    weak = not (seen["offset_mm"] < _WEAK_MM and seen["angle_deg"] < _WEAK_DEG)
    if turned:
        # A reversed line has its left and right exchanged.
        at = [names.index(name) for name in ("offset_mm", BEND) if name in names]
        spread[at] *= -1.0
        spread[:, at] *= -1.0
    bend = float(pose[names.index(BEND)]) if BEND in names else 0.0
    gain, taken = float(pose[-2]), float(pose[-1])
    misfit = rms_counts(found)
    faults = {
        "misfit": misfit > MISFIT_COUNTS,
        "weak": weak,
        "astray": max(map(abs, pose[1:3] if corner else pose[1:2])) > reach_mm,
        "unfinished": not found.converged,
        "bright": gain > MOST_GAIN,
        "ambiguous": bool(found.rivals) or mirrored,
    }
    return Estimate(
        kind=shape.kind,
        offset_mm=offset_mm,
        angle_deg=angle_deg,
        width_mm=float(pose[2]) if shape.kind == "cable" else math.nan,
        transmittance=min(max(1.0 - taken / gain, 0.0), 1.0) if gain > _LEAST_GAIN else math.nan,
        gain=gain,
        covariance=spread,
        quality=_quality(found),
        curvature_per_mm=-bend if turned else bend,
        rms_counts=misfit,
        flags=(*(name for name, is_so in faults.items() if is_so), *flags),
        dark_side="" if shape.kind == "cable" else "left" if turned else "right",
        vertex_mm=(float(pose[1]), float(pose[2])) if corner else None,
        opening_deg=math.degrees(float(pose[3])) if corner else math.nan,
        direction_deg=math.degrees(math.remainder(float(pose[0]), math.tau))
        if corner
        else math.nan,
        parameters=names,
        left_out=tuple(np.flatnonzero(found.frame.scale == 0.0).tolist()),
    )


def rms_counts(found: Fit) -> float:
    """Root mean square misfit of the cells that count (counts of 255)."""
    frame = found.frame
    miss = (frame.light - found.model) * frame.counts
    miss[frame.full & (miss < 0.0)] = 0.0
    usable = frame.scale > 0.0
    return math.sqrt(float(miss[usable] @ miss[usable]) / np.count_nonzero(usable))


def _quality(found: Fit) -> float:
    frame = found.frame
    usable = frame.scale > 0.0
    seen = frame.light[usable]
    model = np.where(frame.full, np.minimum(found.model, frame.light), found.model)[usable]
    spread = float(np.sum((seen - seen.mean()) ** 2))
    return 1.0 - float(np.sum((seen - model) ** 2)) / spread if spread else 0.0


def _line(
    pose: Floats, names: tuple[str, ...]
) -> tuple[tuple[float, float], Floats, tuple[str, ...]]:
    """Angle (rad) and offset (mm) of the reported line, the derivatives of all reported parameters
    by the pose, and their names."""
    light, light_names = _light(pose)
    if "opening_deg" not in names:
        by_pose = np.eye(pose.size)[: len(names)]
        by_pose[0, 0] = math.degrees(1.0)
        line = float(pose[0]), float(pose[1])
        return line, np.vstack([by_pose, light]), (*names, *light_names)
    angle, x_mm, y_mm, opening = (float(v) for v in pose[:4])
    borders = ((angle + opening / 2.0, 0.5), (angle - opening / 2.0 + math.pi, -0.5))
    border, half = min(borders, key=lambda b: abs(math.sin(b[0])))
    cos, sin = math.cos(border), math.sin(border)
    ahead_mm = -y_mm * sin - x_mm * cos
    by_pose = np.zeros((6, pose.size))
    by_pose[0, [0, 3]] = math.degrees(1.0), math.degrees(half)
    by_pose[1, :4] = ahead_mm, -sin, cos, half * ahead_mm
    by_pose[range(2, 6), range(4)] = math.degrees(1.0), 1.0, 1.0, math.degrees(1.0)
    names = ("angle_deg", "offset_mm", "direction_deg", "x_mm", "y_mm", "opening_deg")
    line = border, y_mm * cos - x_mm * sin
    return line, np.vstack([by_pose, light]), (*names, *light_names)


def _light(pose: Floats) -> tuple[Floats, tuple[str, ...]]:
    """Derivatives of transmittance and gain by the pose, and their names."""
    gain, taken = float(pose[-2]), float(pose[-1])
    rows = np.zeros((2, pose.size))
    rows[1, -2] = 1.0
    if gain <= _LEAST_GAIN:
        return rows[1:], ("gain",)
    rows[0, -2:] = taken / gain**2, -1.0 / gain
    return rows, ("transmittance", "gain")
