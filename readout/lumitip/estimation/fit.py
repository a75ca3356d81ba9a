"""Fit of a shape's pose to a frame, by robust least squares."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lumitip.estimation.shapes import Shape
from lumitip.grid import Floats

ROUNDS = 12
_FLOOR = 1e-6
_WILD = 36.0  # loss of one cell
_SETTLED = 1e-3  # expected gain of loss below which the fit has converged


@dataclass(frozen=True, eq=False)
class Frame:
    """One frame for the fit; arrays of shape `(cells,)`."""

    light: Floats
    """Shares of the empty grasp's light."""
    scale: Floats
    """One over the standard deviation of each share."""
    counts: Floats
    """Counts of 255 for a share of one."""
    full: NDArray[np.bool_]
    """Saturated cells: more light would read the same."""
    huber: float
    """Standard deviations beyond which the loss grows linearly."""

    def looser(self, share: float) -> "Frame":
        """The frame with this share of each cell's light uncertain as well."""
        more = share * self.light * self.scale
        return replace(self, scale=self.scale / np.sqrt(1.0 + more * more))


@dataclass(frozen=True, eq=False)
class Fit:
    """Result of a fit."""

    frame: Frame
    pose: Floats
    """Its last entries are `light` and `taken`; before them are drifts of free optics."""
    cost: float
    """Sum of Huber losses, in standard deviations squared."""
    normal: Floats
    """Matrix of the normal equations, shape `(p, p)`."""
    model: Floats
    """Shares of light at the pose, shape `(cells,)`."""
    converged: bool
    drifts: int = 0
    """Number of drifts of the optics in the pose."""
    ambiguous: bool = False
    """Whether another line explains the frame nearly as well."""


def fit(shape: Shape, start: Floats, frame: Frame, rounds: int = ROUNDS) -> Fit:
    """The pose of least loss near a start.

    Args:
        shape: the object.
        start: initial pose; with drifts the optics are free.
        frame: the values.
        rounds: largest number of steps.
    """
    prior = _Prior.of(shape, len(start))
    pose = np.array(start, dtype=np.float64)
    damping, converged = 1e-3, False
    now = _Point(shape, pose, frame, prior)
    for _ in range(rounds):
        matrix = now.normal.copy()
        # The floor keeps the matrix regular if no cell sees the line.
        matrix.flat[:: pose.size + 1] += damping * now.normal.diagonal() + _FLOOR
        step = np.linalg.solve(matrix, now.slope)
        expected = float(step @ now.slope)
        then = _Point(shape, pose + step, frame, prior)
        if then.cost <= now.cost:
            gained = now.cost - then.cost
            pose, now, damping = pose + step, then, damping * 0.1
            if expected < _SETTLED or gained < 5e-3 * now.cost:
                converged = True
                break
        else:
            if expected < _SETTLED:
                converged = True
                break
            damping = max(damping, 1e-4) * 20.0
    drifts = pose.size - len(shape.names) - 2
    return Fit(frame, pose, now.cost, now.normal, now.model, converged, drifts)


def bounded(found: Fit) -> float:
    """Loss of a fit with at most `_WILD` for each cell, so that no single cell decides between
    fits."""
    frame = found.frame
    miss = (frame.light - found.model) * frame.scale
    size = np.where(frame.full, np.maximum(miss, 0.0), np.abs(miss))
    within = np.minimum(size, frame.huber)
    return found.cost - float(np.maximum(within * (2.0 * size - within) - _WILD, 0.0).sum())


def drifting(shape: Shape, found: Fit, drifts: int) -> Fit:
    """The same fit with drifts of the optics in its pose, at 0, and in its matrix."""
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
_TIE = np.array([[1.0, -1.0], [-1.0, 1.0]])  # ties `taken` to `light`
_TIED = _TIE, 400.0 * _TIE  # of sheets, and of cables, which are opaque


class _Point:
    """Loss and normal equations at one pose."""

    __slots__ = ("cost", "model", "normal", "slope")

    def __init__(self, shape: Shape, pose: Floats, frame: Frame, prior: _Prior) -> None:
        share, slopes = shape.slopes(pose)
        size = pose.size
        self.model = pose[-2] - pose[-1] * share
        rows = np.empty((size + 1, share.size))  # slopes by each entry of the pose, and the misfit
        np.multiply(slopes, -pose[-1], out=rows[: size - 2])
        rows[size - 2] = 1.0
        np.negative(share, out=rows[size - 1])
        np.subtract(frame.light, self.model, out=rows[size])
        rows *= frame.scale
        miss = rows[size]
        weight = frame.huber / np.maximum(np.abs(miss), frame.huber)
        weight[frame.full & (miss <= 0.0)] = 0.0  # a saturated cell would read the same
        weighted = rows * weight
        products = weighted[:size] @ rows.T
        away = prior.known - pose
        pull = prior.normal @ away
        self.normal = products[:, :size] + prior.normal
        self.slope = products[:, size] + pull
        self.cost = float(weighted[size] @ (2.0 * miss - weighted[size]) + away @ pull)


OFFSET_SD_MM, ANGLE_SD_DEG = 0.1, 0.4
"""Standard deviations from which the mean of the likelihood is used."""
_POINTS = 13
_MOST = np.array([np.radians(5.0), 1.2])  # rad, mm


def likely(shape: Shape, found: Fit, deviations: Floats) -> Floats:
    """The pose with angle and offset at the mean of the likelihood.

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
    # A misfit that no pose explains must not make one pose look certain.
    spare = max(float(losses.min()) / frame.light.size, 1.0)
    weights = np.exp(-0.5 * (losses - losses.min()) / spare)
    moved = pose.copy()
    moved[:2] += weights @ steps / weights.sum()
    return moved
