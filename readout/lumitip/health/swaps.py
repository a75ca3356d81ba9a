"""Swapped cells, told from how cells go together while something moves over them.

How much two cells darken together depends on the way from one to the other: the same for all pairs
that lie so, whatever it is that moves and however thin it is. For each such way the median of its
pairs is what a pair should have; swapped cells have it with each other's surroundings.
"""

from dataclasses import dataclass

import numpy as np

from lumitip.frame import Values
from lumitip.grid import Floats
from lumitip.layout import Layout

LEAST_GAIN, LEAST_TO_SPREAD = 0.03, 0.5
"""Least gain of correlation for each pair, at all and in parts of how far pairs that lie the same
way differ anyway (their median). On the twin (20 s of discs, edges, corners and cables of 2 to
12 mm, free or to and fro) a sound fingertip stays below 0.012, or below 0.4 of that spread where
the movement differs from place to place; of swaps of any two cells 88 % are found, of neighbours
74 %."""
LEAST_ORDER = 0.3
"""Least order, as of `order`. In the same recordings sound fingertips have 0.36 and more, cells in
no order at most 0.18."""
_MOST = 8  # more swaps than these are another layout
_REACH = 6.6  # pitches between two cells that are compared: all of the published sensor's
_LEAST_PAIRS = 4  # that lie the same way, for their median to be worth something

Mask = np.ndarray[tuple[int], np.dtype[np.bool_]]
Pairs = np.ndarray[tuple[int, int], np.dtype[np.intp]]
Cells = np.ndarray[tuple[int], np.dtype[np.intp]]
PairMask = np.ndarray[tuple[int, int], np.dtype[np.bool_]]


@dataclass(frozen=True)
class Swap:
    """Two cells that look swapped."""

    cells: tuple[int, int]
    gain: float
    """By how much nearer to what is usual their correlations would be, for each pair."""
    sure: bool
    """Whether both halves of the recording say so, each by itself."""


def swaps(light: Values, ways: Pairs, usable: Mask) -> list[Swap]:
    """Cells that look swapped, the clearest first, at most eight pairs.

    Args:
        light: shape `(n, cells)`.
        ways: number of the way that each pair lies, as of `ways_of`.
        usable: which cells to compare, shape `(cells,)`.
    """
    halves = [_alike(half) for half in (light[: len(light) // 2], light[len(light) // 2 :])]
    alike, free, found = _alike(light), usable.copy(), list[Swap]()
    for _ in range(_MOST):
        gain, least = gains(alike, ways, usable)
        gain[~free] = gain[:, ~free] = -1.0
        i, j = sorted(int(n) for n in np.unravel_index(int(gain.argmax()), gain.shape))
        if gain[i, j] < least:
            break
        told = (gains(half, ways, usable, np.array([i, j])) for half in halves)
        sure = all(own[0, 1] >= most for own, most in told)
        found.append(Swap((i, j), float(gain[i, j]), sure))
        free[[i, j]] = False
        for matrix in (alike, *halves):
            matrix[[i, j]] = matrix[[j, i]]
            matrix[:, [i, j]] = matrix[:, [j, i]]
    return found


def order(light: Values, ways: Pairs, usable: Mask) -> float:
    """How far the cells lie as the layout says: the share of the variance of their correlations
    that the way from one to the other tells, 1 at most; about 0 for cells in no order.

    Arguments as of `swaps`.
    """
    alike = _alike(light)
    usual, known = _usual(alike, ways, _compared(usable))
    values = alike[known]
    variance = float(values.var()) if values.size else 0.0
    return 1.0 - float(np.mean((values - usual[known]) ** 2)) / variance if variance else 0.0


def gains(
    alike: Floats, ways: Pairs, usable: Mask, among: Cells | None = None
) -> tuple[Floats, float]:
    """By how much swapping two cells would bring their correlations nearer to what is usual.

    Args:
        alike: correlations, shape `(cells, cells)`.
        ways: number of the way that each pair lies, as of `ways_of`.
        usable: which cells to compare.
        among: the cells whose swaps are judged; all, if left out.

    Returns:
        For each pair of `among` that is compared, shape `(among, among)`, -1 on the diagonal and
        for cells that cannot be compared; and the gain from which on a swap is told.
    """
    usual, known = _usual(alike, ways, _compared(usable))
    spread = float(np.median(np.abs(alike[known] - usual[known]))) if known.any() else 0.0
    those = np.arange(len(alike)) if among is None else among
    seen = alike if among is None else np.ascontiguousarray(alike[:, those])
    # astray[a, i]: how far cell a would be from what is usual at place i. A pair's correlation is
    # the same either way round, so that cells can be taken by rows, which lie together in memory.
    astray = np.stack(
        [np.abs(seen[known[i]] - usual[i, known[i], None]).sum(axis=0) for i in those], axis=1
    )
    alike, usual = alike[np.ix_(those, those)], usual[np.ix_(those, those)]
    weight, others = known[np.ix_(those, those)].astype(np.float64), known[those].sum(axis=1)
    # The correlation of the two with each other is the same either way.
    own = np.diag(astray)[:, None] - weight * np.abs(alike - usual)
    other = astray.T - weight * np.abs(1.0 - usual)
    pairs = others[:, None] + others[None, :] - 2.0 * weight
    gain: Floats = np.where(pairs > 0, (own + own.T - other - other.T) / np.maximum(pairs, 1), -1.0)
    gain[~usable[those]] = gain[:, ~usable[those]] = -1.0
    np.fill_diagonal(gain, -1.0)
    return gain, max(LEAST_GAIN, LEAST_TO_SPREAD * spread)


def ways_of(layout: Layout) -> Pairs:
    """A number for each way from one cell to another, there and back the same, 0 for those too
    far apart to be compared, shape `(cells, cells)`."""
    # In hundredths of a mm, which tell ways apart and forgive rounded places.
    x, y = (np.rint(1e2 * (a[:, None] - a)).astype(np.int64) for a in (layout.x_mm, layout.y_mm))
    near = x * x + y * y <= (1e2 * _REACH * layout.pitch_mm) ** 2
    np.fill_diagonal(near, False)
    ways: Pairs = np.zeros(near.shape, np.intp)
    ways[near] = 1 + np.unique(np.abs((x[near] << 24) + y[near]), return_inverse=True)[1]
    return ways


def enough_ways(ways: Pairs) -> bool:
    """Whether enough pairs lie the same way for swaps to show, by the numbers of `ways_of`."""
    count = np.bincount(np.triu(ways).ravel(), minlength=1)
    return bool((count[1:] >= _LEAST_PAIRS).any())


def _compared(usable: Mask) -> PairMask:
    pairs: PairMask = np.outer(usable, usable)
    np.fill_diagonal(pairs, False)
    return pairs


def _usual(alike: Floats, ways: Pairs, compared: PairMask) -> tuple[Floats, PairMask]:
    """The median of the pairs that lie as each pair, and which pairs are compared with enough
    others."""
    pair = np.triu(compared & (ways > 0))
    number, value = ways[pair], alike[pair]
    order = np.lexsort((value, number))
    number, value = number[order], value[order]
    count = np.bincount(number, minlength=int(ways.max()) + 1)
    first = np.cumsum(count) - count
    if not value.size:
        return np.zeros_like(alike), np.zeros_like(compared)
    low, high = (
        np.minimum(first + half, value.size - 1)
        for half in (np.maximum(count - 1, 0) // 2, count // 2)
    )
    median = (value[low] + value[high]) / 2.0
    return median[ways], (count >= _LEAST_PAIRS)[ways] & compared


def _alike(light: Values) -> Floats:
    with np.errstate(invalid="ignore", divide="ignore"):
        found: Floats = np.corrcoef(light.T.astype(np.float64))
    return np.nan_to_num(np.atleast_2d(found))
