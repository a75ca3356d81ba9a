"""A fit without the few cells that are dead: they read an end of the scale, whatever is there."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from lumitip.estimation.bank import Bank
from lumitip.estimation.fit import RIVAL, Fit, Frame, doubtful, fit, poses_of
from lumitip.estimation.shapes import Shape
from lumitip.grid import Floats

_MOST = 0.1
"""Share of the cells that may be left out."""
_FAR_SD = 6.0
"""Standard deviations from the others' fit beyond which a cell is left out."""
_CLEARLY = 0.25
"""Share of the loss that may remain."""
_EACH = 10.0
"""Loss of a cell that is left out: one less is preferred to a slightly better fit."""
_STARTS, _ROUNDS = 4, 3


def without_dead(
    shape: Shape, bank: Bank, found: Fit, full: Callable[[Floats, Frame, int], Floats]
) -> Fit | None:
    """The fit with the fewest cells left out that explains all others, or nearly so; none if there
    is none.

    Args:
        shape: the object.
        bank: of its kind.
        found: the best fit to all cells, with free optics.
        full: a pose of the bank with all entries of a fit: of pose, frame and number of drifts.
    """
    frame = found.frame
    usable = frame.scale > 0.0
    most = int(_MOST * np.count_nonzero(usable))
    poses = bank.robust(frame.light, usable, _STARTS, most)
    starts = [full(pose, frame, found.drifts) for pose in poses]
    enough = _CLEARLY * found.cost
    trimmed = (_trimmed(shape, start, frame, most, enough) for start in starts)
    tried = [each for each in trimmed if each]
    if not tried:
        return None
    best = min(tried, key=_cost)
    near = [each for each in tried if _cost(each) < _cost(best) + RIVAL]
    return replace(best, rivals=poses_of(bank.elsewhere(best, near)))


def _cost(found: Fit) -> float:
    """Loss of a fit and of the cells that it leaves out."""
    return found.cost + _EACH * np.count_nonzero(found.frame.scale == 0.0)


def _trimmed(shape: Shape, start: Floats, frame: Frame, most: int, enough: float) -> Fit | None:
    """The fit from a start without the cells that are far from it.

    Args:
        shape: the object.
        start: its pose.
        frame: the values.
        most: number of cells to leave out, all of which may be dead.
        enough: a loss that is small enough, although the fit does not explain the other cells: the
            line may be curved.
    """
    share, _ = shape.slopes(start[None])
    model = start[-2] - start[-1] * share[0]
    for _ in range(_ROUNDS):
        far = np.where(frame.stuck, frame.misses(model), 0.0)
        wild = far > max(_FAR_SD, np.sort(far)[-most - 1])
        found = fit(shape, start, frame.without(wild))
        if not doubtful(found):
            break
        start, model = found.pose, found.model
    wild = frame.stuck & (frame.misses(found.model) > _FAR_SD)
    if not 0 < np.count_nonzero(wild) <= most:
        return None
    again = fit(shape, found.pose, frame.without(wild))
    return again if not doubtful(again) or again.cost < enough else None
