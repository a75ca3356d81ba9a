"""The deviations of a pair of fingers that explain what it read of the gauge."""

from dataclasses import dataclass

import numpy as np

from lumitip.acceptance.response import NAMES, Response
from lumitip.acceptance.spread import spread
from lumitip.grid import Floats
from lumitip.health.swaps import Mask
from lumitip.twin.optics import drive_of_values

ROUGH = 4.0
"""Standard deviation of a cell's value from its model, of the spread of parts and of gains that
drift, as if it were independent of other cells (counts of 255)."""
SIGMA = 1.5
"""The same without parts and drift, whose covariance is known: noise, and silicone that leans."""
_REFINED = 2  # fits with that covariance
_FAR = 12.0  # counts of 255: a cell that misfits as much counts half
_LEFT_OUT = 1e4  # counts of 255: standard deviation of a cell with a fault of its own
_ROUNDS = 15
_NEAR = 0.01  # of a prior: a smaller step ends the fit
_MOST_STEP, _MOST = 1.0, 2.0  # of a prior: a step, and a deviation
_POOR = 3.0  # counts, above which the fit begins anew from other deviations
_STARTS = (("gap", -1.0), ("gap", 1.2), ("gap", 2.4), ("scatter", -0.45))
_TRIALS = 4  # of shorter steps


@dataclass(frozen=True, eq=False)
class Fitted:
    """The most likely deviations, in the order of `DEVIATIONS`."""

    deviations: Floats
    sd: Floats
    """Standard deviation of each."""
    residual: Floats
    """Measured less expected values, shape `(placements, cells)`; NaN for cells left out."""

    @property
    def rms(self) -> float:
        """Of the residual over all cells and placements (counts of 255)."""
        return float(np.sqrt(np.nanmean(self.residual**2)))


def fit(
    response: Response,
    values: Floats,
    empty: Floats,
    usable: Mask,
    thicker_mm: tuple[float, float] | None = None,
) -> Fitted:
    """Find the deviations.

    Single parts differ, and their effects on the cells are correlated: the residual is weighed with
    its covariance. Cells that no deviation explains count less, so that single faults do not bend
    the result.

    Args:
        response: of the gauge.
        values: measured, 255 is the empty grasp at the gauge's gap, shape `(placements, cells)`.
        empty: light of each cell in the empty grasp, not calibrated, shape `(cells,)`.
        usable: cells without a fault of their own, shape `(cells,)`.
        thicker_mm: silicone of receiver and emitter beyond the drawing, if it was measured.
    """
    drive, likely = drive_of_values(empty, response.model), response.likely(thicker_mm)
    search = _Search(response, values, drive, usable, likely)
    best = search.minimum(search.begin(likely[0]))
    for name, value in _STARTS if search.rms(best) > _POOR else ():
        start = likely[0].copy()
        start[NAMES.index(name)] = value
        best = min(best, search.minimum(search.begin(start)), key=search.robust)
    for _ in range(_REFINED):
        search.weigh(spread(response, best.at, drive))
        best = search.minimum(best, renewed=False)
    return search.fitted(best)


@dataclass(frozen=True, eq=False)
class _Place:
    """Deviations, and the values there."""

    at: Floats
    off: Floats
    """Measured less expected values, shape `(placements, cells)`."""
    steepness: Floats
    """Their derivative, perhaps that at another place."""


class _Search:
    """Least squares with the covariance of the spread of parts."""

    def __init__(
        self,
        response: Response,
        values: Floats,
        drive: Floats,
        usable: Mask,
        likely: tuple[Floats, Floats],
    ) -> None:
        self._response, self._values = response, values
        self._drive, self._usable = drive, usable
        self._expected, self._priors = likely
        self._least, self._most = (self._expected + way * self._priors for way in (-_MOST, _MOST))
        at, (least, most) = NAMES.index("scatter"), response.scatter_range
        self._least[at], self._most[at] = least, most
        self._whitening = np.eye(values.size) / ROUGH

    def begin(self, at: Floats) -> _Place:
        """A place where a fit may begin."""
        return _Place(at, self._off(at), self._response.nominal_jacobian)

    def weigh(self, parts: Floats) -> None:
        """Count the spread of parts, as `spread` has it, from now on."""
        own = np.where(np.tile(self._usable, len(self._values)), SIGMA, _LEFT_OUT)
        lower = np.linalg.cholesky(parts.T @ parts + np.diag(own**2))
        self._whitening = np.linalg.inv(lower)

    def minimum(self, place: _Place, renewed: bool = True) -> _Place:
        """The place with the least misfit near another one.

        Args:
            place: where the search begins.
            renewed: whether the derivative is computed again where the steps end.
        """
        at, off, steepness = place.at, place.off, place.steepness
        exact = False
        for _ in range(_ROUNDS):
            weights = self._weights(off)
            step = self._step(steepness, off, weights, at)
            found, moved = self._descent(weights, at, off, step)
            near = found is None or np.all(np.abs(moved - at) < _NEAR * self._priors)
            if near and (exact or not renewed):
                break
            if found is None:
                steepness, exact = self._response.jacobian(at, self._drive), True
                continue
            change = moved - at
            # The change that was seen corrects the derivative along the step (Broyden).
            seen = (off - found) - steepness @ change
            steepness = steepness + seen[..., None] * change / float(change @ change)
            at, off, exact = moved, found, False
            if near:
                steepness, exact = self._response.jacobian(at, self._drive), True
        return _Place(at, off, steepness)

    def fitted(self, place: _Place) -> Fitted:
        """The result at a place."""
        own = slice(len(NAMES))  # the play of the gauge is of no interest
        weights = self._weights(place.off)
        covariance = np.linalg.inv(self._information(self._white(place.steepness, weights)))
        # Where the twin explains less than it should, its deviations are less certain.
        numbers = len(self._values) * self._usable.sum()
        excess = float((self._white(place.off, weights) ** 2).sum()) / max(numbers, 1)
        sd = np.sqrt(np.diag(covariance) * max(excess, 1.0))[own]
        return Fitted(place.at[own], sd, np.where(self._usable, place.off, np.nan))

    def rms(self, place: _Place) -> float:
        """Of what remains, over the usable cells (counts of 255)."""
        return float(np.sqrt(np.mean(place.off[:, self._usable] ** 2)))

    def robust(self, place: _Place) -> float:
        """Sum over the cells of a loss that grows ever slower, and of the priors."""
        far = np.log1p(np.mean(place.off**2, axis=0) / _FAR**2)[self._usable]
        return float(len(place.off) * (_FAR / ROUGH) ** 2 * far.sum() + self._unlikely(place.at))

    def _off(self, at: Floats) -> Floats:
        """Measured less expected values."""
        return np.asarray(self._values - self._response.values(at, self._drive))

    def _white(self, of: Floats, weights: Floats) -> Floats:
        """Residual or derivative in independent numbers of unit deviation, a row for each."""
        rows = np.tile(np.sqrt(weights), len(of))[:, None] * of.reshape(weights.size * len(of), -1)
        return np.asarray(self._whitening @ rows)

    def _descent(
        self, weights: Floats, at: Floats, off: Floats, step: Floats
    ) -> tuple[Floats | None, Floats]:
        """The residual after the step, or after a shorter one, that lowers the misfit, and its
        place; no residual if none does."""
        before = self._misfit(off, weights, at)
        for _ in range(_TRIALS):
            moved = np.clip(at + step, self._least, self._most)
            found = self._off(moved)
            if self._misfit(found, weights, moved) < before:
                return found, moved
            step = step / 3.0
        return None, at

    def _weights(self, off: Floats) -> Floats:
        """Of each cell, shape `(cells,)`."""
        far = np.mean(off**2, axis=0) / _FAR**2
        return np.where(self._usable, 1.0 / (1.0 + far), 0.0)

    def _misfit(self, off: Floats, weights: Floats, at: Floats) -> float:
        return float((self._white(off, weights) ** 2).sum() + self._unlikely(at))

    def _unlikely(self, at: Floats) -> float:
        return float((((at - self._expected) / self._priors) ** 2).sum())

    def _information(self, white: Floats) -> Floats:
        return np.asarray(white.T @ white + np.diag(self._priors**-2.0))

    def _step(self, steepness: Floats, off: Floats, weights: Floats, at: Floats) -> Floats:
        white = self._white(steepness, weights)
        pull = white.T @ self._white(off, weights)[:, 0]
        pull -= (at - self._expected) / self._priors**2
        step = np.linalg.solve(self._information(white), pull)
        longest = float(np.abs(step / self._priors).max())
        return np.asarray(step * min(1.0, _MOST_STEP / max(longest, 1e-9)))
