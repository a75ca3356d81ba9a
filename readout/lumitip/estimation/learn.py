"""Self-calibration from a minute of ordinary use: gain of each cell, gap and scatter.

Every frame is fitted as by `PoseEstimator`. A cell that is brighter than its fits in most frames
has a gain above one. Gap and scattered share are free in the fit of each frame; the result is
their mean over all frames, weighted by the information in each. Poses must differ: a cell
that the object never uncovers, or never half covers, keeps a gain of one.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lumitip import arguments
from lumitip.estimation.estimate import rms_counts
from lumitip.estimation.estimator import EstimationError, PoseEstimator
from lumitip.estimation.fit import Fit
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.processing.processor import batch_values
from lumitip.twin import Model
from lumitip.values import one_line

_ROUNDS = 4
_LEAST_LIGHT = 0.15  # of the empty grasp; darker cells show little of their gain
_LEAST_FRAMES = 20
_DOUBT = 1.0  # weight of the expected gain of one, in frames of full light
_SPREAD = 0.25  # larger deviations are a broken cell or a bad fit


@dataclass(frozen=True, eq=False)
class Learned:
    """Result of learning: `PoseEstimator(layout, learned.model, gains=learned.gains)` uses it."""

    gains: Floats
    """Light of each cell relative to its empty grasp, their mean is 1, shape `(cells,)`."""
    model: Model
    """The optics with the learned gap and scattered share."""
    rms_counts: float
    """Misfit of the median frame (counts of 255)."""
    rms_before_counts: float
    """The same with the expected optics and gains of one."""
    frames: int
    """Number of frames used."""

    def __repr__(self) -> str:
        return one_line(self)


def learn(
    layout: Layout,
    values: ArrayLike,
    kind: str | None = None,
    model: Model | None = None,
    most_frames: int = 150,
) -> Learned:
    """Learn gains, gap and scattered share from frames.

    Args:
        layout: the cells.
        values: calibrated values of many frames, shape `(n, cells)`, in any order.
        kind: of the object, as for `PoseEstimator`.
        model: the expected optics; by default those of the layout.
        most_frames: number of frames to use, evenly spread.

    Raises:
        LayoutError: if `layout` is no layout.
        ValuesError: if there is another number of values, or they are no numbers.
        EstimationError: if fewer than twenty frames show an edge, cable or corner, or the kind is
            unknown.
    """
    estimator = PoseEstimator(layout, model)
    most = arguments.count(most_frames, "most_frames", _LEAST_FRAMES)
    rows = batch_values(values, layout)
    if len(rows):
        rows = rows[np.unique(np.linspace(0, len(rows) - 1, most).astype(np.int64))]
    trusted = [(row, e) for row in rows if (e := estimator(row, kind)).trusted]
    if len(trusted) < _LEAST_FRAMES:
        raise EstimationError(
            f"{len(trusted)} frames show an edge, cable or corner; at least {_LEAST_FRAMES} "
            "are needed. Move an object between the fingers"
        )
    rows, kinds = np.array([row for row, _ in trusted]), [estimate.kind for _, estimate in trusted]
    gains, misfits = np.ones(len(layout)), []
    for _ in range(_ROUNDS):
        fits = _fitted(estimator, rows, kinds)
        misfits.append(_misfit(fits))
        gains = gains_from(fits, gains)
        free = _fitted(estimator.with_gains(gains), rows, kinds, free=True)
        estimator = PoseEstimator(layout, estimator.optics_at(drift_from(free)), gains=gains)
    left = _misfit(_fitted(estimator, rows, kinds))
    return Learned(gains, estimator.model, left, misfits[0], len(rows))


def _fitted(
    estimator: PoseEstimator, rows: Floats, kinds: Sequence[str], free: bool = False
) -> list[Fit]:
    return [estimator.fitted(row, kind, free) for row, kind in zip(rows, kinds, strict=True)]


def _misfit(fits: Sequence[Fit]) -> float:
    return float(np.median([rms_counts(found) for found in fits]))


def gains_from(fits: Sequence[Fit], before: Floats) -> Floats:
    """Gains of the cells from fits that used the gains before, shape `(cells,)`."""
    light = np.stack([found.frame.light for found in fits]) * before
    shares = np.stack([found.model for found in fits])
    full = np.stack([found.frame.full for found in fits])
    # A saturated cell reads the same however bright it is.
    weights = ((shares > _LEAST_LIGHT) & ~full) * np.minimum(shares, 1.0) ** 2
    ratio = light / np.maximum(shares, _LEAST_LIGHT)
    gains = (weights * ratio).sum(axis=0) + _DOUBT
    gains = np.clip(gains / (weights.sum(axis=0) + _DOUBT), 1.0 - _SPREAD, 1.0 + _SPREAD)
    return np.asarray(gains / gains.mean())


def drift_from(fits: Sequence[Fit]) -> Floats:
    """Drift of the optics from all fits, in standard deviations of each parameter.

    The prior, which every fit has, counts once.
    """
    size = fits[0].drifts
    known, sums = np.eye(size), np.zeros(size)
    for found in fits:
        end = found.pose.size - 2
        drift = np.arange(end - size, end)
        rest = np.setdiff1d(np.arange(found.pose.size), drift)
        across = found.normal[np.ix_(drift, rest)]
        seen = found.normal[np.ix_(drift, drift)] - across @ np.linalg.solve(
            found.normal[np.ix_(rest, rest)], across.T
        )
        known += seen - np.eye(size)
        sums += seen @ found.pose[drift]
    return np.asarray(np.linalg.solve(known, sums))
