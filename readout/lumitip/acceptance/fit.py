"""The deviations of a pair of fingers that explain what it read of the gauge."""

from dataclasses import dataclass

import numpy as np

from lumitip.acceptance.response import NAMES, Response
from lumitip.grid import Floats
from lumitip.health.swaps import Mask
from lumitip.twin.optics import drive_of_values

SIGMA = 4.0
"""Standard deviation of a cell's value from its model, of the spread of parts and of gains that
drift (counts of 255)."""
_ROUNDS = 15
_NEAR = 0.01  # of a prior: a smaller step ends the fit
_OUTLYING = 3.0  # times SIGMA: a cell that misfits as much counts half
_MOST_STEP, _MOST = 1.0, 2.0  # of a prior: a step, and a deviation
_POOR = 3.0  # counts, above which the fit begins anew from other gaps
_GAPS_MM = (-1.0, 1.2, 2.4)  # beyond the gauge's
_TRIALS = 4  # of shorter steps


@dataclass(frozen=True, eq=False)
class Fitted:
    """The most likely deviations, in the order of `DEVIATIONS`."""

    deviations: Floats
    sd: Floats
    """Standard deviation of each."""
    residual: Floats
    """Measured less expected values, shape `(placements, cells)`; NaN for cells left out."""
    misfit: float
    """Sum that the fit minimizes."""

    @property
    def rms(self) -> float:
        """Of the residual over all cells and placements (counts of 255)."""
        return float(np.sqrt(np.nanmean(self.residual**2)))


def fit(response: Response, values: Floats, empty: Floats, usable: Mask) -> Fitted:
    """Find the deviations.

    Cells that no deviation explains count less, so that single faults do not bend the result.

    Args:
        response: of the gauge.
        values: measured, 255 is the empty grasp at the gauge's gap, shape `(placements, cells)`.
        empty: light of each cell in the empty grasp, not calibrated, shape `(cells,)`.
        usable: cells without a fault of their own, shape `(cells,)`.
    """
    drive = drive_of_values(empty, response.model)
    starts = np.zeros((1 + len(_GAPS_MM), len(response.priors)))
    starts[1:, NAMES.index("gap")] = _GAPS_MM
    best = _from(response, values, drive, usable, starts[0])
    for start in starts[1:] if best.rms > _POOR else ():
        other = _from(response, values, drive, usable, start)
        best = min(best, other, key=lambda one: one.misfit)
    return best


def _from(response: Response, values: Floats, drive: Floats, usable: Mask, at: Floats) -> Fitted:
    """The fit that begins at some deviations."""
    steepness = response.nominal_jacobian
    off = np.asarray(values - response.values(at, drive))
    exact = False
    for _ in range(_ROUNDS):
        weights = _weights(off, usable)
        step = _step(response.priors, steepness, off, weights, at)
        found, moved = _descent(response, values, drive, weights, at, off, step)
        near = found is None or np.all(np.abs(moved - at) < _NEAR * response.priors)
        if near and exact:
            break
        if found is None:
            steepness, exact = response.jacobian(at, drive), True
            continue
        change = moved - at
        # The change that was seen corrects the derivative along the step (Broyden).
        seen = (off - found) - steepness @ change
        steepness = steepness + seen[..., None] * change / float(change @ change)
        at, off, exact = moved, found, False
        if near:
            steepness, exact = response.jacobian(at, drive), True
    weights = _weights(off, usable)
    information = _information(response.priors, steepness, weights)
    residual = np.where(usable, off, np.nan)
    own = slice(len(NAMES))  # the play of the gauge is of no interest
    sd = np.sqrt(np.diag(np.linalg.inv(information)))[own]
    return Fitted(at[own], sd, residual, _robust(response.priors, off, usable, at))


def _descent(
    response: Response,
    values: Floats,
    drive: Floats,
    weights: Floats,
    at: Floats,
    off: Floats,
    step: Floats,
) -> tuple[Floats | None, Floats]:
    """The residual after the step, or after a shorter one, that lowers the misfit, and its place;
    no residual if none does."""
    before = _misfit(response.priors, off, weights, at)
    for _ in range(_TRIALS):
        moved = np.clip(at + step, -_MOST * response.priors, _MOST * response.priors)
        found = np.asarray(values - response.values(moved, drive))
        if _misfit(response.priors, found, weights, moved) < before:
            return found, moved
        step = step / 3.0
    return None, at


def _weights(off: Floats, usable: Mask) -> Floats:
    """Of each cell, shape `(cells,)`."""
    far = np.mean(off**2, axis=0) / (_OUTLYING * SIGMA) ** 2
    return np.where(usable, 1.0 / (1.0 + far), 0.0)


def _robust(priors: Floats, off: Floats, usable: Mask, at: Floats) -> float:
    """Sum over the cells of a loss that grows ever slower, and of the priors."""
    scale = (_OUTLYING * SIGMA) ** 2
    far = np.log1p(np.mean(off**2, axis=0) / scale)[usable]
    return float(len(off) * scale / SIGMA**2 * far.sum() + ((at / priors) ** 2).sum())


def _misfit(priors: Floats, off: Floats, weights: Floats, at: Floats) -> float:
    return float((weights * off**2).sum() / SIGMA**2 + ((at / priors) ** 2).sum())


def _information(priors: Floats, steepness: Floats, weights: Floats) -> Floats:
    weighted = steepness * (weights[:, None] / SIGMA**2)
    return np.asarray(np.einsum("pci,pcj->ij", weighted, steepness) + np.diag(priors**-2.0))


def _step(priors: Floats, steepness: Floats, off: Floats, weights: Floats, at: Floats) -> Floats:
    pull = np.einsum("pci,pc->i", steepness, off * weights) / SIGMA**2 - at / priors**2
    step = np.linalg.solve(_information(priors, steepness, weights), pull)
    longest = float(np.abs(step / priors).max())
    return np.asarray(step * min(1.0, _MOST_STEP / max(longest, 1e-9)))
