"""`Last`: what a tracker knows of the frame before."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip.estimation.estimate import Estimate
from lumitip.estimation.fit import Fit
from lumitip.estimation.search import BENT
from lumitip.grid import Floats

_BEARABLE = frozenset({"misfit", "bright", "ambiguous", "dead"})


@dataclass(frozen=True, eq=False)
class Last:
    """The fit of the frame before."""

    name: str
    """Of the shape."""
    pose: Floats
    rivals: tuple[Floats, ...]
    """Poses that explained it nearly as well."""
    misfit_counts: float
    """Least misfit since the last search, so that a bend does not raise the limit for a line that
    is straight again."""
    dead: NDArray[np.bool_]
    """Cells that were left out although they had a value."""
    light: Floats
    """What each cell saw: a dead one sees the same in every frame."""


def after(
    last: Last | None, name: str, found: Fit, estimate: Estimate, dead: NDArray[np.bool_]
) -> Last | None:
    """What the next frame starts from; nothing if the fit failed.

    Args:
        last: the same of the frame before, unless a search began anew.
        name: of the shape that was fitted.
        found: the fit.
        estimate: its pose.
        dead: cells that it left out although they had a value, shape `(cells,)`.
    """
    # The fit of a bend converges over some frames, that of a straight line at once.
    bearable = _BEARABLE | ({"unfinished"} if name == BENT else set())
    if not bearable.issuperset(estimate.flags):
        return None
    misfit = min(last.misfit_counts if last else math.inf, estimate.rms_counts)
    return Last(name, found.pose, found.rivals, misfit, dead, found.frame.light)
