"""Fit of the twin's terms to the published frames, and their misfit on a frame left out.

Shared numbers are fitted on two frames with a Huber-like loss, since the objects of the frames
differ from the model at single cells. On the third frame they are fixed, and the frame's own
numbers are fitted by least squares. Gains of the cells have a Gaussian prior about 1.
"""

from dataclasses import dataclass

import numpy as np

from lumitip.grid import Floats
from real_frames import KINDS, real_frame
from real_terms import LIMITS, Numbers, RealTwin

NAMES = tuple(KINDS)
COUNTS = 8.0
"""Residual beyond which the loss of a joint fit grows linearly (counts)."""
NOISE = 10.0
"""Deviation of a residual against which the prior of the gains is weighed (counts)."""
_STARTS: tuple[Numbers, ...] = (
    {},
    {"gap_mm": 2.5},
    {"gap_mm": 4.5},
    {"gap_mm": 4.5, "clear": 0.5, "hem_mm": 20.0},
)
"""Other starts, since a corner with hems has several minima."""
_STEPS = {
    "gap_mm": 0.05,
    "calibration_gap_mm": 0.05,
    "angle_deg": 0.1,
    "bend": 0.01,
    "bend_growth": 0.01,
}
_HELPS = 0.02  # counts by which another round of starts must lower the misfit
_STEP, _GAIN_STEP, _ROUNDS, _CONVERGED = 2e-3, 1e-3, 25, 1e-4


@dataclass(frozen=True, eq=False)
class Shared:
    """What the frames have in common."""

    numbers: Numbers
    gains: Floats


@dataclass(frozen=True, eq=False)
class Joint:
    """A fit of several frames."""

    own: dict[str, Numbers]
    shared: Shared
    rms: dict[str, float]
    """Misfit of each frame (counts)."""


class RealFit:
    """Fits of a twin to the frames."""

    def __init__(self, twin: RealTwin) -> None:
        self._twin = twin
        self._cells = len(twin.layout)
        self._real = {name: real_frame(name) for name in NAMES}
        self.nothing = Shared({}, np.ones(self._cells))

    def alone(self, name: str, own: Numbers, shared: Shared) -> Joint:
        """The best of several fits of one frame, with the shared numbers fixed.

        They start from `own` and, as long as that helps, from the best fit so far.
        """
        best, misfit = own, np.inf
        while True:
            starts = [best | change for change in _STARTS if change.keys() <= own.keys()]
            fits = [_Problem(self, {name: start}, shared, (), 0.0).solved() for start in starts]
            found = min(fits, key=lambda fit: fit.rms[name])
            if found.rms[name] > misfit - _HELPS:
                return found
            best, misfit = found.own[name], found.rms[name]

    def together(self, own: dict[str, Numbers], shared: Shared, gain_sd: float = 0.0) -> Joint:
        """Fit of several frames with their shared numbers, and gains if `gain_sd` is above 0."""
        return _Problem(self, own, shared, tuple(shared.numbers), gain_sd).solved()

    def held_out(
        self, own: dict[str, Numbers], term: Numbers, gain_sd: float = 0.0
    ) -> dict[str, tuple[float, Shared]]:
        """Misfit of each frame with what was fitted on the two others, and what that was.

        Args:
            own: fits of each frame without the term.
            term: shared numbers where the fit starts.
            gain_sd: deviation of the prior of the gains, 0 for gains of 1.
        """
        found = {}
        for name in NAMES:
            others = {other: own[other] for other in NAMES if other != name}
            shared = self.together(others, Shared(term, np.ones(self._cells)), gain_sd).shared
            found[name] = (self.alone(name, own[name], shared).rms[name], shared)
        return found

    def started(self, name: str, own: Numbers, shared: Shared) -> float:
        """Misfit of one frame by a single fit, with the shared numbers fixed (counts)."""
        return _Problem(self, {name: own}, shared, (), 0.0).solved().rms[name]

    def values(self, name: str, own: Numbers, shared: Shared) -> Floats:
        """Values of a frame."""
        light, drive = self._twin.light(name, own, shared.numbers)
        return self._twin.values(light * shared.gains, drive, shared.numbers)

    def missed(self, name: str, own: Numbers, shared: Shared) -> Floats:
        """Residuals of a frame (counts)."""
        return self.values(name, own, shared) - self._real[name]


class _Problem:
    """Least squares over the numbers of some frames and what they share."""

    def __init__(
        self,
        fit: RealFit,
        own: dict[str, Numbers],
        shared: Shared,
        free: tuple[str, ...],
        gain_sd: float,
    ) -> None:
        self._fit, self._own, self._shared, self._free = fit, own, shared, free
        self._gain_sd = gain_sd
        self._names = [(frame, number) for frame in own for number in own[frame]]
        self._names += [("", number) for number in free]
        numbers = [n for _, n in self._names]
        limits = np.array([LIMITS.get(n, (-400.0, 400.0)) for n in numbers])
        self._low, self._high = limits.T
        self._steps = np.array([_STEPS.get(n, _STEP) for n in numbers])
        self._gains = fit.missed(*_first(own), shared).size if gain_sd else 0

    def solved(self) -> Joint:
        """The Levenberg–Marquardt method within limits."""
        start = [(self._own[f] if f else self._shared.numbers)[n] for f, n in self._names]
        place = np.concatenate([np.clip(start, self._low, self._high), np.zeros(self._gains)])
        low = np.concatenate([self._low, np.full(self._gains, -1.0)])
        high = np.concatenate([self._high, np.full(self._gains, 1.0)])
        missed, damping = self._residuals(place), 1e-2
        for _ in range(_ROUNDS):
            slopes = self._slopes(place, missed)
            normal, pull, before = slopes.T @ slopes, -slopes.T @ missed, missed @ missed
            while damping < 1e6:
                step = _step(normal, pull, damping, place, low, high)
                tried = np.clip(place + step, low, high)
                new = self._residuals(tried)
                if new @ new < before:
                    break
                damping *= 4.0
            else:
                break
            place, missed, damping = tried, new, max(damping / 6.0, 1e-6)
            if before - missed @ missed < _CONVERGED * before:
                break
        own, shared = self._unpacked(place)
        left = {name: self._fit.missed(name, own[name], shared) for name in own}
        return Joint(own, shared, {n: float(np.sqrt(np.mean(e**2))) for n, e in left.items()})

    def _unpacked(self, place: Floats) -> tuple[dict[str, Numbers], Shared]:
        own: dict[str, Numbers] = {frame: {} for frame in self._own}
        shared = dict(self._shared.numbers)
        for (frame, number), value in zip(self._names, place.tolist(), strict=False):
            (own[frame] if frame else shared)[number] = value
        gains = np.exp(place[-self._gains :]) if self._gains else self._shared.gains
        return own, Shared(shared, gains)

    def _residuals(self, place: Floats) -> Floats:
        own, shared = self._unpacked(place)
        parts = [self._fit.missed(name, own[name], shared) for name in own]
        if len(own) > 1:
            parts = [_robust(part) for part in parts]
        if self._gains:
            parts.append(place[-self._gains :] * (NOISE / self._gain_sd))
        return np.concatenate(parts)

    def _slopes(self, place: Floats, missed: Floats) -> Floats:
        slopes = np.zeros((missed.size, place.size))
        for i, step in enumerate(self._steps):
            ahead = place.copy()
            ahead[i] += step if place[i] + step <= self._high[i] else -step
            slopes[:, i] = (self._residuals(ahead) - missed) / (ahead[i] - place[i])
        if self._gains:
            # A gain changes its own cell alone: one step of all gains has all derivatives.
            ahead = place.copy()
            ahead[-self._gains :] += _GAIN_STEP
            change = (self._residuals(ahead) - missed) / _GAIN_STEP
            for block in range(len(self._own) + 1):
                cells = np.arange(self._gains)
                slopes[block * self._gains + cells, cells - self._gains] = change[
                    block * self._gains + cells
                ]
        return slopes


def _first(own: dict[str, Numbers]) -> tuple[str, Numbers]:
    return next(iter(own.items()))


def _robust(missed: Floats) -> Floats:
    """Residuals whose squares are the pseudo-Huber loss."""
    square = 2.0 * COUNTS**2 * (np.sqrt(1.0 + (missed / COUNTS) ** 2) - 1.0)
    scaled: Floats = np.sign(missed) * np.sqrt(square)
    return scaled


def _step(
    normal: Floats, pull: Floats, damping: float, place: Floats, low: Floats, high: Floats
) -> Floats:
    """A damped step; numbers at a limit that it would cross stay."""
    damped = normal + damping * np.diag(np.diag(normal) + 1e-9)
    free, step = np.ones(place.size, bool), np.zeros(place.size)
    for _ in range(3):
        step[:] = 0.0
        step[free] = np.linalg.lstsq(damped[np.ix_(free, free)], pull[free], rcond=None)[0]
        beyond = ((place + step < low) & (place <= low)) | ((place + step > high) & (place >= high))
        if not (beyond & free).any():
            break
        free &= ~beyond
    return step
