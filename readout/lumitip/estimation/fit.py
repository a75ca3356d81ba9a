"""Fit of a shape's pose to a frame, also where the shape moved while it was read."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lumitip.estimation.shapes import Shape
from lumitip.grid import Floats

ROUNDS = 12
_FLOOR = 1e-6
_WILD = 36.0  # loss of one cell
_SETTLED = 1e-3  # loss that a last step may still promise


@dataclass(frozen=True, eq=False)
class Frame:
    """One frame as the fit sees it; arrays of shape `(cells,)`."""

    light: Floats
    """Shares of the empty grasp's light."""
    scale: Floats
    """One over the standard deviation of each share."""
    counts: Floats
    """Counts of 255 that a share of one is worth there."""
    full: NDArray[np.bool_]
    """Cells that read full light: more of it would read the same."""
    huber: float
    """Standard deviations beyond which the loss grows linearly."""

    def looser(self, share: float) -> "Frame":
        """The same frame, if this share of each cell's light were uncertain as well."""
        more = share * self.light * self.scale
        return replace(self, scale=self.scale / np.sqrt(1.0 + more * more))


@dataclass(frozen=True, eq=False)
class Fit:
    """Where the fit ended."""

    frame: Frame
    """Result of a fit."""
    pose: Floats
    """With `light` and `taken` at its end, and drifts of the optics before them if these were
    free."""
    cost: float
    """Sum of Huber losses, in standard deviations squared."""
    normal: Floats
    """Matrix of the normal equations, shape `(p, p)`."""
    model: Floats
    """Shares that the pose gives, shape `(cells,)`."""
    settled: bool
    drifts: int = 0
    """How many drifts of the optics the pose has."""
    ambiguous: bool = False
    """Whether another line, elsewhere, explains the frame nearly as well."""


def fit(shape: Shape, start: Floats, frame: Frame, rounds: int = ROUNDS) -> Fit:
    """The pose of least loss near a start.

    Args:
        shape: the object.
        start: pose with `light` and `taken` at its end; the optics are free if it has drifts.
        frame: what was read.
        rounds: most steps.
    """
    prior = _Prior.of(shape, len(start))
    pose = np.array(start, dtype=np.float64)
    damping, settled = 1e-3, False
    now = _Point(shape, pose, frame, prior)
    for _ in range(rounds):
        matrix = now.normal.copy()
        # The floor keeps the matrix regular where a line has left every cell's sight.
        matrix.flat[:: pose.size + 1] += damping * now.normal.diagonal() + _FLOOR
        step = np.linalg.solve(matrix, now.slope)
        expected = float(step @ now.slope)
        then = _Point(shape, pose + step, frame, prior)
        if then.cost <= now.cost:
            gained = now.cost - then.cost
            pose, now, damping = pose + step, then, damping * 0.1
            if expected < _SETTLED or gained < 5e-3 * now.cost:
                settled = True
                break
        else:
            if expected < _SETTLED:
                settled = True
                break
            damping = max(damping, 1e-4) * 20.0
    drifts = pose.size - len(shape.names) - 2
    return Fit(frame, pose, now.cost, now.normal, now.model, settled, drifts)


def bounded(found: Fit) -> float:
    """The loss of a fit with no cell counted for more than `_WILD`, by which fits compare: one
    wild cell must not decide between poses."""
    frame = found.frame
    miss = (frame.light - found.model) * frame.scale
    size = np.where(frame.full, np.maximum(miss, 0.0), np.abs(miss))
    within = np.minimum(size, frame.huber)
    return found.cost - float(np.maximum(within * (2.0 * size - within) - _WILD, 0.0).sum())


def drifting(shape: Shape, found: Fit, drifts: int) -> Fit:
    """The same fit with optics that could be off: its matrix has them, nothing has moved."""
    names = len(shape.names)
    if found.pose.size > names + 2 or not drifts:
        return found
    pose = np.concatenate([found.pose[:names], np.zeros(drifts), found.pose[names:]])
    at = _Point(shape, pose, found.frame, _Prior.of(shape, pose.size))
    return replace(found, pose=pose, normal=at.normal, drifts=drifts)


@dataclass(frozen=True, eq=False)
class _Prior:
    """Prior of a pose."""

    known: Floats
    normal: Floats
    """Its contribution to the normal equations, shape `(p, p)`."""

    @classmethod
    def of(cls, shape: Shape, size: int) -> "_Prior":
        means, deviations = shape.priors()
        # Light beside the object is that of the empty grasp but for drift.
        strength = np.ones(size)
        strength[: means.size] = deviations**-2.0
        strength[-2:] = _LIGHT_SD**-2.0, 0.0
        normal = np.diag(strength)
        normal[-2:, -2:] += _TIED[shape.kind == "cable"]
        known = np.zeros(size)
        known[: means.size], known[-2:] = means, 1.0
        return cls(known, normal)


_LIGHT_SD = 0.1
_TIE = np.array([[1.0, -1.0], [-1.0, 1.0]])  # of what is taken to the light beside it
_TIED = _TIE, 400.0 * _TIE  # cables are opaque; sheets take what they will


class _Point:
    """Loss and normal equations at one pose."""

    __slots__ = ("cost", "model", "normal", "slope")

    def __init__(self, shape: Shape, pose: Floats, frame: Frame, prior: _Prior) -> None:
        share, slopes = shape.slopes(pose)
        size = pose.size
        self.model = pose[-2] - pose[-1] * share
        rows = np.empty((size + 1, share.size))  # by each entry of the pose, and the misses
        np.multiply(slopes, -pose[-1], out=rows[: size - 2])
        rows[size - 2] = 1.0
        np.negative(share, out=rows[size - 1])
        np.subtract(frame.light, self.model, out=rows[size])
        rows *= frame.scale
        miss = rows[size]
        weight = frame.huber / np.maximum(np.abs(miss), frame.huber)
        weight[frame.full & (miss <= 0.0)] = 0.0  # would read the same a little off
        weighted = rows * weight
        products = weighted[:size] @ rows.T
        away = prior.known - pose
        pull = prior.normal @ away
        self.normal = products[:, :size] + prior.normal
        self.slope = products[:, size] + pull
        self.cost = float(weighted[size] @ (2.0 * miss - weighted[size]) + away @ pull)


OFFSET_SD_MM, ANGLE_SD_DEG = 0.1, 0.4
"""Standard deviations from which on the mean is taken."""
_POINTS = 13
_MOST = np.array([np.radians(5.0), 1.2])  # rad, mm


def likely(shape: Shape, found: Fit, deviations: Floats) -> Floats:
    """The pose with angle and offset of the likelihood's mean; all else stays.

    Args:
        shape: an edge.
        found: the best fit.
        deviations: of its angle (rad) and offset (mm).
    """
    frame, pose = found.frame, found.pose
    reach = np.minimum(3.0 * deviations, _MOST)
    line = np.linspace(-1.0, 1.0, _POINTS)
    steps = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2) * reach
    poses = pose[:2] + steps
    miss = (frame.light - pose[-2] + pose[-1] * shape.shares(poses, pose[2:-2])) * frame.scale
    miss[frame.full & (miss < 0.0)] = 0.0
    size = np.minimum(np.abs(miss), frame.huber)
    losses = (size * (2.0 * np.abs(miss) - size)).sum(axis=1)
    # A misfit that no pose explains must not make one of them look certain.
    spare = max(float(losses.min()) / frame.light.size, 1.0)
    weights = np.exp(-0.5 * (losses - losses.min()) / spare)
    moved = pose.copy()
    moved[:2] += weights @ steps / weights.sum()
    return moved
