"""Accuracy of poses with a design, in simulation: real estimates, and the bound.

Frames come from twins whose optics, gap and cells differ from what the estimator expects, so the
misses are those of a fingertip as it is made and not only those of noise. The same poses and the
same faults are drawn for every design. The Cramér–Rao bound is that of right optics.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip.estimation import PoseEstimator
from lumitip.estimation.estimator import DIAMETER_MM
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Cable, HalfPlane, Model, Twin
from lumitip.twin.noise import dimness
from lumitip.twin.optics import GAP_MM

KINDS: dict[str, type[HalfPlane | Cable]] = {"edge": HalfPlane, "cable": Cable}
NOISE = 1.5
"""Standard deviation of a value (counts of 255)."""
GAINS = 0.06
"""Spread of the cells' gains."""
MOST_MM, MOST_DEG = 2.0, 10.0
"""A larger miss is a gross error, and counts as this one in the rms."""
_GAP_MM, _EXPONENT, _ALPHA, _HOLE = 0.5, 0.6, 0.2, 0.05  # most by which the optics are off
_REACH = 0.35  # of the grid's smaller extent: how far from its middle lines lie
_STEP_MM, _STEP_DEG = 0.05, 0.3
_KNOWN = np.diag([1.0, 1.0 / 5.0**2, 100.0, 1.0])  # a line that no cell sees: 1 mm, 5 degrees


@dataclass(frozen=True)
class Sample:
    """Random draws that all designs share."""

    fingers: int = 5
    """Fingertips with faults."""
    poses: int = 30
    """Poses of each kind of object, with each fingertip."""
    seed: int = 0


@dataclass(frozen=True)
class Grasp:
    """A grasp that poses are estimated in; the estimator expects it."""

    gap_mm: float = GAP_MM
    """From skin to skin."""
    diameter_mm: float = DIAMETER_MM
    """Of cables."""
    gain: float = Model.gain
    """Photocurrent of the brightest cell, see `Model`; the estimator expects the default."""


class Trials:
    """Estimates of the poses of a sample, on frames of fingertips that differ from the drawing."""

    def __init__(self, layout: Layout, sample: Sample, grasp: Grasp) -> None:
        """Prepare estimator, poses and fingertips.

        Raises:
            EstimationError: if no pose can be estimated with these cells.
        """
        self._layout, self._sample, self._grasp = layout, sample, grasp
        self._estimator = PoseEstimator(layout, None, grasp.gap_mm, grasp.diameter_mm)
        self.poses = _poses(layout, sample)
        """Offsets (mm) and angles (degrees), shape `(n, 2)`."""
        straight = Model.from_layout(layout, grasp.gap_mm, gain=grasp.gain)
        self._noise = NOISE * dimness(Twin(layout, straight))
        self._twins = [_faulty(layout, sample.seed, n, grasp) for n in range(sample.fingers)]

    def misses(self, kind: str) -> Floats:
        """Errors of offset (mm) and angle (degrees) of one kind, shape `(n, 2)`."""
        chance = np.random.default_rng((self._sample.seed, 2))
        rows = []
        twins = np.repeat(np.array(self._twins), self._sample.poses)
        for (offset, angle), twin in zip(self.poses, twins, strict=True):
            values = twin.values(self._thing(kind, offset, angle))
            noisy = values + self._noise * chance.standard_normal(len(self._layout))
            found = self._estimator(np.floor(np.clip(noisy, 0.0, 255.0)), kind)
            rows.append(_miss(found.offset_mm, found.angle_deg, offset, angle))
        return np.array(rows)

    def _thing(self, kind: str, offset_mm: float, angle_deg: float) -> HalfPlane | Cable:
        if kind == "edge":
            return HalfPlane(offset_mm=offset_mm, angle_deg=angle_deg)
        diameter_mm = self._grasp.diameter_mm
        return Cable(offset_mm=offset_mm, angle_deg=angle_deg, diameter_mm=diameter_mm)


def accuracy(layout: Layout, sample: Sample) -> dict[str, float]:
    """Rms of offset (mm) and angle (degrees) over edges and cables, share of gross errors, and
    the Cramér–Rao bound of the offset (mm).

    Args:
        layout: the cells, with their optics.
        sample: what is drawn.
    """
    straight, trials = Twin(layout), Trials(layout, sample, Grasp())
    missed = {kind: trials.misses(kind) for kind in KINDS}
    bound = [_bound_mm(straight, shape, *pose) for shape in KINDS.values() for pose in trials.poses]
    both = np.concatenate(list(missed.values()))
    return {
        "error_mm": rms(both[:, 0]),
        "error_deg": rms(both[:, 1]),
        "edge_mm": rms(missed["edge"][:, 0]),
        "cable_mm": rms(missed["cable"][:, 0]),
        "gross_percent": 100.0 * float(gross(both).mean()),
        "bound_mm": rms(np.array(bound)),
    }


def gross(misses: Floats) -> NDArray[np.bool_]:
    """Which errors, shape `(n, 2)`, are gross."""
    return (misses[:, 0] >= MOST_MM) | (misses[:, 1] >= MOST_DEG)


def _poses(layout: Layout, sample: Sample) -> Floats:
    """Offsets (mm) and angles (degrees), shape `(n, 2)`, over the middle of the grid."""
    chance = np.random.default_rng((sample.seed, 0))
    reach_mm = _REACH * min(float(np.ptp(layout.x_mm)), float(np.ptp(layout.y_mm)))
    count = sample.fingers * sample.poses
    return np.stack(
        [chance.uniform(-reach_mm, reach_mm, count), chance.uniform(-90.0, 90.0, count)], axis=1
    )


def _faulty(layout: Layout, seed: int, number: int, grasp: Grasp) -> Twin:
    chance = np.random.default_rng((seed, 1, number))
    optics = layout.optics
    off = chance.uniform(-1.0, 1.0, 4)
    straight = Model.from_layout(layout, grasp.gap_mm, gain=grasp.gain)
    model = Model.from_layout(
        layout,
        gap_mm=straight.gap_mm + _GAP_MM * off[0],
        detector_exponent=max(optics.detector_exponent + _EXPONENT * off[1], 0.0),
        alpha=straight.alpha + _ALPHA * off[2],
        hole_mm=optics.hole_mm * (1.0 + _HOLE * off[3]),
        gain=grasp.gain,
    )
    gains = 1.0 + GAINS * chance.standard_normal(len(layout))
    return Twin(layout, model, gains=np.maximum(gains, 0.5))


def _miss(
    found_mm: float, found_deg: float, offset_mm: float, angle_deg: float
) -> tuple[float, float]:
    """Error of an estimate; a line that was not found counts as the largest error."""
    if not np.isfinite(found_mm):
        return MOST_MM, MOST_DEG
    turn = (found_deg - angle_deg + 180.0) % 360.0 - 180.0
    if abs(turn) > 90.0:  # the same line the other way round
        found_mm, turn = -found_mm, (turn + 90.0) % 180.0 - 90.0
    return min(abs(found_mm - offset_mm), MOST_MM), min(abs(turn), MOST_DEG)


def _bound_mm(twin: Twin, shape: type[HalfPlane | Cable], offset: float, angle: float) -> float:
    """Cramér–Rao bound of the offset (mm), light and transmittance unknown."""

    def read(offset_mm: float, angle_deg: float) -> Floats:
        return twin.values(shape(offset_mm=offset_mm, angle_deg=angle_deg))

    values = read(offset, angle)
    by_mm = read(offset + _STEP_MM, angle) - read(offset - _STEP_MM, angle)
    by_deg = read(offset, angle + _STEP_DEG) - read(offset, angle - _STEP_DEG)
    noise = np.hypot(NOISE, np.sqrt(1.0 / 12.0))  # whole counts add their own
    columns = [by_mm / (2.0 * _STEP_MM), by_deg / (2.0 * _STEP_DEG), values, 255.0 - values]
    jacobian = np.stack(columns, axis=1) / noise
    spread = np.linalg.inv(jacobian.T @ jacobian + _KNOWN)
    return float(np.sqrt(spread[0, 0]))


def rms(values: Floats) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(np.square(values))))
