"""Errors of the pose estimator on frames of built fingers, many frames at once.

The estimator believes in the drawing. Its bank and its least squares (`lumitip.estimation`) are
used as it uses them, except that the first fit of a frame, with the expected optics, begins at the
true pose, and that dead cells are not looked for.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lumitip.estimation import PoseEstimator
from lumitip.estimation.fit import (
    ANGLE_SD_DEG,
    OFFSET_SD_MM,
    Fit,
    Frame,
    Prior,
    doubtful,
    fits,
    likely,
)
from lumitip.estimation.learn import drift_from, gains_from
from lumitip.estimation.search import LOOSE
from lumitip.estimation.uncertain import covariance
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Model
from lumitip.twin.built import Lines

MOST_MM, MOST_DEG = 2.0, 10.0
"""An error of this size or more is gross. It counts as this one in rms errors."""
_STARTS, _KEPT = 8, 3  # poses of the bank that a doubtful fit is tried from, and kept
_GLANCE, _ROUNDS = 2, 8  # steps of all of them, and of the kept ones
_LEARNED = 3  # rounds of self-calibration
_FIXED = 1e8  # strength of a prior that holds the optics


@dataclass(frozen=True, eq=False)
class Known:
    """What self-calibration has found of fingers; without it, 1 and 0."""

    gains: Floats
    """Of the cells, shape `(fingers, cells)`."""
    drift: Floats
    """Of gap and scattered share, in the estimator's deviations, shape `(fingers, 2)`."""


class Estimates:
    """Estimates of many frames, by an estimator that believes in a drawing."""

    def __init__(self, layout: Layout, model: Model, diameter_mm: float) -> None:
        """Prepare the estimator.

        Args:
            layout: the cells.
            model: optics that it expects.
            diameter_mm: of the cables that it expects.
        """
        self._estimator = PoseEstimator(layout, model, diameter_mm=diameter_mm)
        self._drifts = self._estimator.search.drifts

    def nothing_known(self, fingers: int) -> Known:
        """What it knows of fingers that were never calibrated."""
        cells = len(self._estimator.layout)
        return Known(np.ones((fingers, cells)), np.zeros((fingers, self._drifts)))

    def errors(self, values: Floats, lines: Lines, known: Known) -> Floats:
        """Errors of offset (mm) and angle (degrees), shape `(fingers, poses, 2)`.

        Args:
            values: of frames, shape `(fingers, poses, cells)`.
            lines: true poses of the frames of each finger.
            known: of the fingers.
        """
        frame, drift, begin = self._rows(values, lines, known)
        found = self._fits(lines, frame, drift, begin)
        doubted = np.flatnonzero([doubtful(one) for one in found])
        if doubted.size:
            plain = np.array([found[place].pose[:2] for place in doubted])
            loose = self._loose(lines, frame.some(doubted), drift[doubted], plain)
            for place, one in zip(doubted, loose, strict=True):
                found[place] = one
        poses = np.array([self._reported(lines.kind, one) for one in found])
        return _errors(poses.reshape(*values.shape[:2], 2), lines)

    def searched(self, values: Floats, lines: Lines) -> tuple[Floats, NDArray[np.bool_]]:
        """The same errors by `PoseEstimator`, and which frames it flags as ambiguous, shape
        `(fingers, poses)`."""
        found = [[self._estimator(row, lines.kind) for row in rows] for rows in values]
        poses = np.array([[(math.radians(e.angle_deg), e.offset_mm) for e in es] for es in found])
        ambiguous = np.array([["ambiguous" in e.flags for e in es] for es in found])
        return _errors(poses, lines), ambiguous

    def _reported(self, kind: str, found: Fit) -> Floats:
        """Angle and offset of a fit; of an edge that cells hardly see, their likely values."""
        if kind == "edge":
            deviations = np.sqrt(np.abs(np.diag(covariance(found))[:2]))
            if np.any(deviations > (math.radians(ANGLE_SD_DEG), OFFSET_SD_MM)):
                return likely(self._estimator.search.shape(kind), found, deviations)[:2]
        return found.pose[:2]

    def learned(self, values: Floats, lines: Lines) -> Known:
        """Gains and optics as `lumitip.estimation.learn` finds them, from frames of a minute's use.

        Args:
            values: of frames, shape `(fingers, poses, cells)`.
            lines: poses of each finger's frames, where the fits begin.
        """
        fingers, poses, _ = values.shape
        known = self.nothing_known(fingers)
        for _ in range(_LEARNED):
            found = self._fits(lines, *self._rows(values, lines, known))
            gains = [gains_from(found[n * poses :][:poses], known.gains[n]) for n in range(fingers)]
            known = replace(known, gains=np.array(gains))
            found = self._fits(lines, *self._rows(values, lines, known), free=True)
            steps = [
                drift_from([_moved(one, -known.drift[n]) for one in found[n * poses :][:poses]])
                for n in range(fingers)
            ]
            known = replace(known, drift=known.drift + np.array(steps))
        return known

    def _rows(self, values: Floats, lines: Lines, known: Known) -> tuple[Frame, Floats, Floats]:
        """All frames, the drift of their optics, and their true poses, a row for each."""
        fingers, poses, cells = values.shape
        rows, gains = values.reshape(-1, cells), known.gains.repeat(poses, axis=0)
        frame = self._estimator.frame(rows, np.ones(rows.shape, bool))
        calibrated = replace(
            frame,
            light=frame.light / gains,
            scale=frame.scale * gains,
            counts=frame.counts * gains,
        )
        return calibrated, known.drift.repeat(poses, axis=0), np.tile(lines.poses, (fingers, 1))

    def _loose(self, lines: Lines, frame: Frame, drift: Floats, plain: Floats) -> list[Fit]:
        """The best fits of frames that the expected optics do not explain, as the estimator finds
        them: from its fit with the expected optics and from the closest poses of its bank."""
        bank, loose = self._estimator.search.bank(lines.kind), frame.looser(LOOSE)
        near = (bank.closest(*of, _STARTS) for of in zip(loose.light, loose.scale, strict=True))
        starts = np.array(
            [
                np.vstack([of, *[own] * (1 + _STARTS - len(of))])
                for of, own in zip(near, plain, strict=True)
            ]
        )
        for rounds, kept in ((_GLANCE, _KEPT), (_ROUNDS, 1)):
            count = starts.shape[1]
            row = np.arange(len(plain)).repeat(count)
            tried = self._fits(
                lines, loose.some(row), drift[row], starts.reshape(-1, 2), True, rounds
            )
            cost = np.array([one.cost for one in tried]).reshape(-1, count)
            best = (
                cost.argsort(axis=1, kind="stable")[:, :kept]
                + np.arange(0, row.size, count)[:, None]
            )
            starts = np.array([[tried[at].pose[:2] for at in places] for places in best])
        return [tried[at] for (at,) in best]

    def _fits(
        self,
        lines: Lines,
        frame: Frame,
        drift: Floats,
        begin: Floats,
        free: bool = False,
        rounds: int = _ROUNDS,
    ) -> list[Fit]:
        """Fits of frames, a row for each.

        Args:
            lines: their kind.
            frame: the frames.
            drift: of the optics, shape `(n, drifts)`.
            begin: poses where the fits begin, shape `(n, 2)`.
            free: whether the optics may differ from that drift.
            rounds: largest number of steps.
        """
        shape = self._estimator.search.shape(lines.kind)
        light = frame.light.max(axis=1)
        if lines.kind == "cable":
            taken, width = light, [np.full(len(begin), lines.diameter_mm)]
        else:
            taken, width = light - frame.light.min(axis=1), []
        starts = np.column_stack([begin, *width, drift, light, taken])
        prior = Prior.of(shape, starts.shape[1])
        optics = slice(len(shape.names), -2)
        expected = np.tile(prior.known, (len(begin), 1))
        expected[:, optics] = drift
        held = np.zeros(starts.shape[1])
        held[optics] = 0.0 if free else _FIXED
        return fits(shape, starts, frame, rounds, Prior(expected, prior.normal + np.diag(held)))


def _moved(found: Fit, drift: Floats) -> Fit:
    """A fit with its drift counted from another one."""
    pose = found.pose.copy()
    pose[-2 - drift.size : -2] += drift
    return replace(found, pose=pose)


def gross(errors: Floats) -> NDArray[np.bool_]:
    """Which estimates have a gross error of offset or angle.

    Args:
        errors: clipped offset (mm) and angle (degrees), shape `(..., 2)`.
    """
    return np.asarray((np.abs(errors) >= (MOST_MM, MOST_DEG)).any(axis=-1))


def _errors(poses: Floats, lines: Lines) -> Floats:
    """Errors of offset (mm) and angle (degrees) of poses, shape `(fingers, poses, 2)`."""
    other_way = np.cos(poses[..., 0] - lines.poses[:, 0]) < 0.0
    reversed_mm = poses[..., 1] * np.where(other_way, -1.0, 1.0)
    away = np.stack([poses[..., 0], reversed_mm], axis=-1) - lines.poses
    turn_deg = np.degrees((away[..., 0] + np.pi / 2.0) % np.pi - np.pi / 2.0)
    most = np.array([MOST_MM, MOST_DEG])
    missed: Floats = np.nan_to_num(np.stack([away[..., 1], turn_deg], axis=-1), nan=MOST_DEG)
    return missed.clip(-most, most)
