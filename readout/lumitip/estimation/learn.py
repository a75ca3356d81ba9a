"""What a minute of ordinary use tells about a fingertip: how bright each cell is, and the gap.

Every frame is fitted as by `PoseEstimator`; a cell that is brighter than its fits say, frame after
frame, has a gain above one, and of several gaps that one is right whose fits leave least. Poses
must differ: cells that the object never uncovers, or never half covers, keep a gain of one.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lumitip.estimation.estimator import EstimationError, PoseEstimator
from lumitip.estimation.report import rms_counts
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Model

GAPS_MM = (2.0, 2.5, 3.0, 3.5, 4.0)
"""Gaps that are tried; the one told lies between them."""
_ROUNDS = 3
_LEAST_LIGHT = 0.15  # of the empty grasp: a darker cell tells little of its gain
_LEAST_FRAMES = 20
_DOUBT = 1.0  # frames in full light that a gain of one, the expected one, counts for
_SPREAD = 0.25  # gains beyond it are a broken cell or a bad fit


@dataclass(frozen=True, eq=False)
class Learned:
    """What was learned; `estimator` uses it."""

    gains: Floats
    """Light of each cell relative to its empty grasp, their mean is 1, shape `(cells,)`."""
    gap_mm: float
    """From skin to skin (mm)."""
    rms_counts: float
    """Misfit that is left, the median frame's (counts of 255)."""
    rms_before_counts: float
    """The same before, at the gap that was expected and with gains of one."""
    frames: int
    """Frames that it was learned from."""


def learn(
    layout: Layout,
    values: ArrayLike,
    kind: str | None = None,
    gaps_mm: Sequence[float] = GAPS_MM,
    model: Model | None = None,
    most_frames: int = 150,
) -> Learned:
    """Learn gains and gap from frames.

    Args:
        layout: where the cells are.
        values: calibrated values of many frames, shape `(n, cells)`, in any order.
        kind: what was between the fingers, as for `PoseEstimator`.
        gaps_mm: gaps to try, at least three, in steps and rising (mm).
        model: optics; those of the layout if not given. Its gap is the one that is expected.
        most_frames: so many frames are used, evenly spread.

    Raises:
        EstimationError: if fewer than twenty frames show an edge, cable or corner.
    """
    base = model or Model.from_layout(layout)
    rows: Floats = np.asarray(values, dtype=np.float64)
    rows = rows[np.unique(np.linspace(0, len(rows) - 1, most_frames).astype(np.int64))]
    before = PoseEstimator(layout, base)
    told = [(row, e) for row in rows if (e := before(row, kind)).trusted]
    if len(told) < _LEAST_FRAMES:
        raise EstimationError(
            f"{len(told)} frames with an edge, cable or corner given, at least {_LEAST_FRAMES} "
            "are needed: move an object between the fingers"
        )
    rows, kinds = np.array([row for row, _ in told]), [estimate.kind for _, estimate in told]
    gap_mm = _least(gaps_mm, [
        _gains(layout, base.changed(gap_mm=gap), rows, kinds)[1] for gap in gaps_mm
    ])  # fmt: skip
    gains, left = _gains(layout, base.changed(gap_mm=gap_mm), rows, kinds)
    rms_before = float(np.median([
        rms_counts(before.fitted(row, kind)) for row, kind in zip(rows, kinds, strict=True)
    ]))  # fmt: skip
    return Learned(gains, gap_mm, left, rms_before, len(rows))


def _gains(
    layout: Layout, model: Model, rows: Floats, kinds: Sequence[str]
) -> tuple[Floats, float]:
    """Gains at one gap, and the misfit (counts) that they leave."""
    gains, left = np.ones(len(layout)), np.inf
    estimator = PoseEstimator(layout, model)
    for _ in range(_ROUNDS):
        fits = [estimator.fitted(row, kind) for row, kind in zip(rows, kinds, strict=True)]
        light = np.stack([found.frame.light for found in fits]) * gains
        shares = np.stack([found.model for found in fits])
        full = np.stack([found.frame.full for found in fits])
        left = float(np.median([rms_counts(found) for found in fits]))
        # A full cell tells nothing: it reads the same however bright it is.
        weights = ((shares > _LEAST_LIGHT) & ~full) * np.minimum(shares, 1.0) ** 2
        ratio = light / np.maximum(shares, _LEAST_LIGHT)
        gains = (weights * ratio).sum(axis=0) + _DOUBT
        gains = np.clip(gains / (weights.sum(axis=0) + _DOUBT), 1 - _SPREAD, 1 + _SPREAD)
        gains /= gains.mean()
        estimator = estimator.with_gains(gains)
    return gains, left


def _least(gaps_mm: Sequence[float], misfits: Sequence[float]) -> float:
    """Where the parabola through the least misfit and its neighbours is lowest."""
    at = int(np.clip(int(np.argmin(misfits)), 1, len(gaps_mm) - 2))
    below, here, above = (float(m) ** 2 for m in misfits[at - 1 : at + 2])
    bend = below - 2.0 * here + above
    step = 0.5 * (below - above) / bend if bend > 0.0 else 0.0
    width_mm = (gaps_mm[at + 1] - gaps_mm[at - 1]) / 2.0
    return float(gaps_mm[at] + np.clip(step, -1.0, 1.0) * width_mm)
