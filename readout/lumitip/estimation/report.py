"""From where a fit ended to an `Estimate`."""

import math

import numpy as np

from lumitip.estimation.estimate import Estimate, half_turn
from lumitip.estimation.fit import Fit
from lumitip.estimation.shapes import Shape
from lumitip.grid import Floats

MISFIT_COUNTS = 16.0
"""Root mean square misfit above which the shape does not explain the frame: real frames have 10
to 16 counts of structure that the optical model lacks."""
BEND = "curvature_per_mm"
_WEAK_MM, _WEAK_DEG = 1.0, 6.0


def report(
    shape: Shape, found: Fit, uncertain: Floats, reach_mm: float, mirrored: bool = False
) -> Estimate:
    """The estimate of a fit.

    Args:
        shape: what was fitted.
        found: where the fit ended.
        uncertain: its `covariance`.
        reach_mm: distance from the origin beyond which no cell sees a line (mm).
        mirrored: whether all cells lie on one line, so that they see a pose and its mirror image
            alike.
    """
    pose, corner = found.pose, shape.kind == "corner"
    (angle, offset_mm), by_pose, names = _line(pose, shape.names)
    offset_mm, angle_deg, turned = half_turn(offset_mm, math.degrees(angle))
    spread = by_pose @ uncertain @ by_pose.T
    seen = dict(zip(names, np.sqrt(np.abs(np.diag(spread))), strict=True))
    weak = not (seen["offset_mm"] < _WEAK_MM and seen["angle_deg"] < _WEAK_DEG)
    if turned:
        # The other way round left is right, where offsets and bends count from.
        at = [names.index(name) for name in ("offset_mm", BEND) if name in names]
        spread[at] *= -1.0
        spread[:, at] *= -1.0
    bend = float(pose[names.index(BEND)]) if BEND in names else 0.0
    light, taken = float(pose[-2]), float(pose[-1])
    misfit = rms_counts(found)
    estimate = Estimate(
        kind=shape.kind,
        offset_mm=offset_mm,
        angle_deg=angle_deg,
        width_mm=float(pose[2]) if shape.kind == "cable" else math.nan,
        transmittance=min(max(1.0 - taken / light, 0.0), 1.0) if light > 0.0 else math.nan,
        gain=light,
        covariance=spread,
        quality=_quality(found),
        curvature_per_mm=-bend if turned else bend,
        rms_counts=misfit,
        dark_side="" if shape.kind == "cable" else "left" if turned else "right",
        vertex_mm=(float(pose[1]), float(pose[2])) if corner else None,
        opening_deg=math.degrees(float(pose[3])) if corner else math.nan,
        direction_deg=math.degrees(math.remainder(float(pose[0]), math.tau))
        if corner
        else math.nan,
        parameters=names,
    )
    astray = max(map(abs, pose[1:3] if corner else pose[1:2])) > reach_mm
    wrong = {
        "misfit": misfit > MISFIT_COUNTS,
        "weak": weak,
        "astray": astray,
        "unfinished": not found.settled,
        "ambiguous": found.ambiguous or mirrored,
    }
    object.__setattr__(estimate, "flags", tuple(name for name, is_so in wrong.items() if is_so))
    return estimate


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


def covariance(found: Fit) -> Floats:
    """Of a pose: the inverse of the normal matrix, larger by what the misfit is larger than
    expected."""
    spare = max(int(np.count_nonzero(found.frame.scale)) - found.pose.size, 1)
    # What no cell sees stays unknown, by a metre or a turn, and not by infinity.
    regular = found.normal + 1e-6 * np.eye(found.pose.size)
    return np.asarray(np.linalg.inv(regular), dtype=np.float64) * max(found.cost / spare, 1.0)


def _line(
    pose: Floats, names: tuple[str, ...]
) -> tuple[tuple[float, float], Floats, tuple[str, ...]]:
    """Angle (rad) and offset (mm) of the reported line, its derivatives by
    the pose, and their names."""
    size = pose.size
    if "opening_deg" not in names:
        by_pose = np.eye(size)[[*range(len(names)), -2, -1]]
        by_pose[0, 0] = math.degrees(1.0)
        return (float(pose[0]), float(pose[1])), by_pose, (*names, "light", "taken")
    angle, x_mm, y_mm, opening = (float(v) for v in pose[:4])
    borders = ((angle + opening / 2.0, 0.5), (angle - opening / 2.0 + math.pi, -0.5))
    border, half = min(borders, key=lambda b: abs(math.sin(b[0])))
    cos, sin = math.cos(border), math.sin(border)
    ahead_mm = -y_mm * sin - x_mm * cos
    by_pose = np.zeros((2, size))
    by_pose[0, [0, 3]] = math.degrees(1.0), math.degrees(half)
    by_pose[1, :4] = ahead_mm, -sin, cos, half * ahead_mm
    return (border, y_mm * cos - x_mm * sin), by_pose, ("angle_deg", "offset_mm")
