"""Fit of a shape's pose to a frame, by robust least squares."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from lumitip.estimation.shapes import Shape
from lumitip.grid import Floats, Integers

ROUNDS = 12
RIVAL = 6.0
"""Loss behind the best, within which another pose makes a fit ambiguous."""
_FLOOR = 1e-6
_WILD = 36.0  # loss of one cell
_DOUBT = 1.3  # loss for each cell beyond which the fingertip differs from the expected one
_SETTLED = 1e-3  # expected gain of loss below which the fit has converged


@dataclass(frozen=True, eq=False)
class Frame:
    """One frame for the fit; arrays of shape `(cells,)`, or `(n, cells)` of several frames."""

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
    stuck: NDArray[np.bool_]
    """Cells that may be dead: they read an end of the scale."""

    def looser(self, share: float) -> "Frame":
        """The frame with this share of each cell's light uncertain as well."""
        more = share * self.light * self.scale
        return replace(self, scale=self.scale / np.sqrt(1.0 + more * more))

    def without(self, cells: NDArray[np.bool_]) -> "Frame":
        """The frame without some cells."""
        return replace(self, scale=np.where(cells, 0.0, self.scale))

    def some(self, at: Integers | NDArray[np.bool_] | int) -> "Frame":
        """Those of several frames at some places; one frame as it is."""
        if self.light.ndim == 1:
            return self
        names = ("light", "scale", "counts", "full", "stuck")
        return replace(self, **{name: getattr(self, name)[at] for name in names})

    def misses(self, model: Floats) -> Floats:
        """How far the cells are from shares of light `(..., cells)`, in standard deviations."""
        miss = (self.light - model) * self.scale
        size: Floats = np.where(self.full, np.maximum(miss, 0.0), np.abs(miss))
        return size


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
    rivals: tuple[Floats, ...] = ()
    """Poses of other lines that explain the frame nearly as well."""


def fit(shape: Shape, start: Floats, frame: Frame, rounds: int = ROUNDS) -> Fit:
    """The pose of least loss near a start.

    Args:
        shape: the object.
        start: initial pose; with drifts the optics are free.
        frame: the values.
        rounds: largest number of steps.
    """
    return fits(shape, np.asarray(start, dtype=np.float64)[None], frame, rounds)[0]


def fits(
    shape: Shape,
    starts: Floats,
    frame: Frame,
    rounds: int = ROUNDS,
    prior: "Prior | None" = None,
) -> list[Fit]:
    """The poses of least loss near several starts, all at once.

    Args:
        shape: the object.
        starts: initial poses, shape `(n, p)`; with drifts the optics are free.
        frame: the values of one frame, or of one for each start.
        rounds: largest number of steps.
        prior: of the poses; by default that of the shape.
    """
    count, size = starts.shape
    prior = prior or Prior.of(shape, size)
    now = _Points.at(shape, starts.copy(), frame, prior)
    damping, converged = np.full(count, 1e-3), np.zeros(count, bool)
    left = np.arange(count)  # not converged yet
    for _ in range(rounds):
        whole = left.size == count
        here = now if whole else now.some(left)
        matrix = here.normal.copy()
        # The floor keeps the matrix regular if no cell sees the line.
        diagonal = matrix.reshape(left.size, -1)[:, :: size + 1]
        diagonal += damping[left, None] * diagonal + _FLOOR
        step = np.linalg.solve(matrix, here.slope[..., None])[..., 0]
        values, expected = (frame, prior) if whole else (frame.some(left), prior.some(left))
        then = _Points.at(shape, here.pose + step, values, expected)
        gained = here.cost - then.cost
        better = gained >= 0.0
        done = (step * here.slope).sum(axis=1) < _SETTLED
        done |= better & (gained < 5e-3 * here.cost)
        now = then if better.all() and whole else now.but(left[better], then, better)
        worse = 20.0 * np.maximum(damping[left], 1e-4)
        damping[left] = np.where(better, 0.1 * damping[left], worse)
        converged[left[done]] = True
        left = left[~done]
        if not left.size:
            break
    drifts = size - len(shape.names) - 2
    return [
        Fit(frame.some(number), pose, float(cost), normal, model, bool(is_so), drifts)
        for number, (pose, cost, normal, model, is_so) in enumerate(
            zip(now.pose, now.cost, now.normal, now.model, converged, strict=True)
        )
    ]


def bounded(found: Sequence[Fit]) -> Floats:
    """Losses of fits to one frame with at most `_WILD` for each cell, so that no single cell
    decides between fits; shape `(n,)`."""
    frame = found[0].frame
    size = frame.misses(np.array([each.model for each in found]))
    within = np.minimum(size, frame.huber)
    beyond = np.maximum(within * (2.0 * size - within) - _WILD, 0.0).sum(axis=1)
    losses: Floats = np.array([each.cost for each in found]) - beyond
    return losses


def poses_of(found: Sequence[Fit]) -> tuple[Floats, ...]:
    """The poses of some fits."""
    return tuple(each.pose for each in found)


def doubtful(found: Fit) -> bool:
    """Whether the loss of a fit is too large for what its frame takes as uncertain."""
    return found.cost > _DOUBT * int(np.count_nonzero(found.frame.scale))


def drifting(shape: Shape, found: Fit, drifts: int) -> Fit:
    """The same fit with drifts of the optics in its pose, at 0, and in its matrix."""
    names = len(shape.names)
    if found.pose.size > names + 2 or not drifts:
        return found
    pose = np.concatenate([found.pose[:names], np.zeros(drifts), found.pose[names:]])
    at = _Points.at(shape, pose[None], found.frame, Prior.of(shape, pose.size))
    return replace(found, pose=pose, normal=at.normal[0], drifts=drifts)


@dataclass(frozen=True, eq=False)
class Prior:
    """Prior of a pose."""

    known: Floats
    """Expected pose, shape `(p,)`, or `(n, p)` for each of several."""
    normal: Floats
    """Its contribution to the normal equations, shape `(p, p)`."""

    @classmethod
    def of(cls, shape: Shape, size: int) -> "Prior":
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

    def some(self, at: Integers) -> "Prior":
        """Those of several poses at some places; one for all as it is."""
        return self if self.known.ndim == 1 else Prior(self.known[at], self.normal)


_LIGHT_SD = 0.1
_TIE = np.array([[1.0, -1.0], [-1.0, 1.0]])  # ties `taken` to `light`
_TIED = _TIE, 400.0 * _TIE  # of sheets, and of cables, which are opaque


@dataclass(frozen=True, eq=False)
class _Points:
    """Losses and normal equations at poses; arrays of shape `(n, ...)`."""

    pose: Floats
    model: Floats
    normal: Floats
    slope: Floats
    cost: Floats

    @classmethod
    def at(cls, shape: Shape, pose: Floats, frame: Frame, prior: Prior) -> "_Points":
        share, slopes = shape.slopes(pose)
        size, light, taken = pose.shape[1], pose[:, -2:-1], pose[:, -1:]
        model = light - taken * share
        # Slopes by each entry of the pose, and the misfit.
        rows = np.empty((len(pose), size + 1, share.shape[1]))
        for entry, slope in enumerate(slopes):
            np.multiply(slope, -taken, out=rows[:, entry])
        rows[:, size - 2] = 1.0
        np.negative(share, out=rows[:, size - 1])
        np.subtract(frame.light, model, out=rows[:, size])
        rows *= frame.scale[..., None, :]
        miss = rows[:, size]
        weight = frame.huber / np.maximum(np.abs(miss), frame.huber)
        weight[frame.full & (miss <= 0.0)] = 0.0  # a saturated cell would read the same
        weighted = rows * weight[:, None]
        products = weighted[:, :size] @ rows.swapaxes(1, 2)
        away = prior.known - pose
        pull = away @ prior.normal
        cost = (weighted[:, size] * (2.0 * miss - weighted[:, size])).sum(axis=1)
        cost += (away * pull).sum(axis=1)
        return cls(
            pose, model, products[..., :size] + prior.normal, products[..., size] + pull, cost
        )

    def some(self, at: Integers) -> "_Points":
        """These at some places."""
        return _Points(*(getattr(self, each.name)[at] for each in fields(self)))

    def but(self, at: Integers, other: "_Points", some: NDArray[np.bool_]) -> "_Points":
        """These, changed: with some of others at some places."""
        for each in fields(self) if at.size else ():
            getattr(self, each.name)[at] = getattr(other, each.name)[some]
        return self


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
