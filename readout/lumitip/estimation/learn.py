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
from lumitip.estimation.estimator import EstimationError, PoseEstimator
from lumitip.estimation.fit import Fit
from lumitip.estimation.report import rms_counts
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.processing.processor import frames_values
from lumitip.twin import Model

_ROUNDS = 4
_LEAST_LIGHT = 0.15  # of the empty grasp: a darker cell tells little of its gain
_LEAST_FRAMES = 20
_DOUBT = 1.0  # frames in full light that a gain of one, the expected one, counts for
_SPREAD = 0.25  # gains beyond it are a broken cell or a bad fit


@dataclass(frozen=True, eq=False)
class Learned:
    """Result of learning: `PoseEstimator(layout, learned.model, gains=learned.gains)` uses it."""

    gains: Floats
    """Light of each cell relative to its empty grasp, their mean is 1, shape `(cells,)`."""
    model: Model
    """The optics, with the gap and the scattered share that were learned."""
    rms_counts: float
    """Misfit that is left, the median frame's (counts of 255)."""
    rms_before_counts: float
    """The same before, with the optics that were expected and gains of one."""
    frames: int
    """Frames that it was learned from."""


def learn(
    layout: Layout,
    values: ArrayLike,
    kind: str | None = None,
    model: Model | None = None,
    most_frames: int = 150,
) -> Learned:
    """Learn gains, gap and scattered share from frames.

    Args:
        layout: where the cells are.
        values: calibrated values of many frames, shape `(n, cells)`, in any order.
        kind: what was between the fingers, as for `PoseEstimator`.
        model: optics that are expected; those of the layout by default.
        most_frames: so many frames are used, evenly spread.

    Raises:
        LayoutError: if it is no layout.
        ValuesError: if the shape is another, or they are no numbers.
        EstimationError: if fewer than twenty frames show an edge, cable or corner, or there is no
            such kind.
    """
    estimator = PoseEstimator(layout, model)
    most = arguments.count(most_frames, "most_frames", _LEAST_FRAMES)
    rows = frames_values(values, layout)
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
        gains = _gains(fits, gains)
        free = _fitted(estimator.with_gains(gains), rows, kinds, free=True)
        estimator = PoseEstimator(layout, estimator.optics_at(_drift(free)), gains=gains)
    left = _misfit(_fitted(estimator, rows, kinds))
    return Learned(gains, estimator.model, left, misfits[0], len(rows))


def _fitted(
    estimator: PoseEstimator, rows: Floats, kinds: Sequence[str], free: bool = False
) -> list[Fit]:
    return [estimator.fitted(row, kind, free) for row, kind in zip(rows, kinds, strict=True)]


def _misfit(fits: Sequence[Fit]) -> float:
    return float(np.median([rms_counts(found) for found in fits]))


def _gains(fits: Sequence[Fit], before: Floats) -> Floats:
    """Gains that the fits leave, which were made with the gains before."""
    light = np.stack([found.frame.light for found in fits]) * before
    shares = np.stack([found.model for found in fits])
    full = np.stack([found.frame.full for found in fits])
    # A full cell tells nothing: it reads the same however bright it is.
    weights = ((shares > _LEAST_LIGHT) & ~full) * np.minimum(shares, 1.0) ** 2
    ratio = light / np.maximum(shares, _LEAST_LIGHT)
    gains = (weights * ratio).sum(axis=0) + _DOUBT
    gains = np.clip(gains / (weights.sum(axis=0) + _DOUBT), 1.0 - _SPREAD, 1.0 + _SPREAD)
    return np.asarray(gains / gains.mean())


def _drift(fits: Sequence[Fit]) -> Floats:
    """How far the optics are off by all fits together, in standard deviations of each thing that
    may be; what is known of them beforehand, which each fit has, counts once."""
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
