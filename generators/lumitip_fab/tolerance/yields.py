"""Yield of fingers, and its interval: fingers of one set of poses are good or bad together."""

import math
from dataclasses import astuple

import numpy as np
from numpy.typing import NDArray

from lumitip.grid import Floats
from lumitip_fab.tolerance.bench import POSE_SETS
from lumitip_fab.tolerance.options import Goals

Good = NDArray[np.bool_]
"""Whether each finger is good; one after the other is tried at the next set of poses."""
_Z = 1.96  # of 95 %


def worst_of(rows: Floats, goals: Goals) -> Floats:
    """Errors of position and angle in units of their goals, the worse of edges and cables, shape
    `(fingers, 2)`; of a figure without any goal in mm or degrees."""
    units = np.array(astuple(goals)).reshape(2, 2)  # kind and figure
    units[:, np.isinf(units).all(axis=0)] = 1.0
    edges, cables = (rows[:, :4].reshape(-1, 2, 2) / units).transpose(1, 0, 2)
    worst: Floats = np.fmax(edges, cables)  # NaN where a kind was not tried
    return worst


def good(rows: Floats, goals: Goals) -> Good:
    """Whether the errors of each finger (see `Bench.errors`) meet the goals and none is gross."""
    missed = (rows[:, :4] > astuple(goals)).any(axis=1)  # NaN, where no cable was tried, is not
    found: Good = ~missed & (rows[:, 4] == 0.0)
    return found


def interval(found: Good) -> tuple[float, float]:
    """Interval that has the true yield with 95 %: Wilson's, of as many independent fingers as tell
    as much as these."""
    return wilson(float(found.mean()), len(found) / design_effect(found))


def design_effect(found: Good) -> float:
    """How many times the variance of the yield is that of independent fingers, by what differs
    between sets of poses; at least 1, and 1 where all fingers are good or none is."""
    share, count = float(found.mean()), len(found)
    sets = np.arange(count) % POSE_SETS
    beyond = np.bincount(sets, found - share)
    most = len(beyond)
    if share in (0.0, 1.0) or most < 2:
        return 1.0
    variance = float((beyond**2).sum()) * most / (most - 1) / count**2
    return max(variance / (share * (1.0 - share) / count), 1.0)


def wilson(share: float, count: float) -> tuple[float, float]:
    """Interval that has the true share with 95 %, of independent fingers (Wilson)."""
    middle, scale = share + _Z * _Z / (2 * count), 1.0 + _Z * _Z / count
    half = _Z * math.sqrt(share * (1.0 - share) / count + (_Z / (2 * count)) ** 2)
    return max((middle - half) / scale, 0.0), min((middle + half) / scale, 1.0)
