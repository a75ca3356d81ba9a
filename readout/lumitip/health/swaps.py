"""Swapped cells, found from correlations while an object moves over all cells.

The correlation of two cells depends on the offset between them, whatever the object. Its median
over all pairs of the same offset is the expected correlation of each pair. Swapped cells fit the
expectation better at each other's places.
"""

from dataclasses import dataclass

import numpy as np

from lumitip.frame import Values
from lumitip.grid import Floats
from lumitip.layout import Layout

LEAST_GAIN, LEAST_TO_SPREAD = 0.03, 0.5
"""Smallest gain in correlation per pair: absolute, and relative to the median spread of pairs with
the same offset. On the twin (20 s of discs, edges, corners and cables of 2 to 12 mm, free or to
and fro) a healthy fingertip stays below 0.012, or below 0.4 of the spread where the movement is
uneven; 88 % of all swaps are found, 74 % of swaps of neighbours."""
LEAST_ORDER = 0.3
"""Smallest `order`. In the same recordings a healthy fingertip has at least 0.36, shuffled cells
have at most 0.18."""
_MOST = 8  # with more swaps the layout is wrong
_REACH = 6.6  # largest offset (pitches): all pairs of the published sensor
_LEAST_PAIRS = 4  # of the same offset, for a meaningful median

Mask = np.ndarray[tuple[int], np.dtype[np.bool_]]
Pairs = np.ndarray[tuple[int, int], np.dtype[np.intp]]
Cells = np.ndarray[tuple[int], np.dtype[np.intp]]
PairMask = np.ndarray[tuple[int, int], np.dtype[np.bool_]]


@dataclass(frozen=True)
class Swap:
    """Two cells that are probably swapped."""

    cells: tuple[int, int]
    gain: float
    """Mean improvement of their correlations if swapped back."""
    sure: bool
    """Whether each half of the recording alone shows it."""


def swaps(light: Values, offsets: Pairs, usable: Mask) -> list[Swap]:
    """Cells that are probably swapped, largest gain first, at most eight pairs.

    Args:
        light: shape `(n, cells)`.
        offsets: from `offset_classes`.
        usable: cells to compare, shape `(cells,)`.
    """
    halves = [_correlations(half) for half in (light[: len(light) // 2], light[len(light) // 2 :])]
    correlations, free, found = _correlations(light), usable.copy(), list[Swap]()
    for _ in range(_MOST):
        gain, least = gains(correlations, offsets, usable)
        gain[~free] = gain[:, ~free] = -1.0
        i, j = sorted(int(n) for n in np.unravel_index(int(gain.argmax()), gain.shape))
        if gain[i, j] < least:
            break
        parts = (gains(half, offsets, usable, np.array([i, j])) for half in halves)
        sure = all(own[0, 1] >= most for own, most in parts)
        found.append(Swap((i, j), float(gain[i, j]), sure))
        free[[i, j]] = False
        for matrix in (correlations, *halves):
            matrix[[i, j]] = matrix[[j, i]]
            matrix[:, [i, j]] = matrix[:, [j, i]]
    return found


def order(light: Values, offsets: Pairs, usable: Mask) -> float:
    """Share of the variance of the correlations that the offsets explain: at most 1, about 0 for
    shuffled cells. Arguments of `swaps`."""
    correlations = _correlations(light)
    expected, known = _expected(correlations, offsets, _compared(usable))
    values = correlations[known]
    variance = float(values.var()) if values.size else 0.0
    return 1.0 - float(np.mean((values - expected[known]) ** 2)) / variance if variance else 0.0


def gains(
    correlations: Floats, offsets: Pairs, usable: Mask, among: Cells | None = None
) -> tuple[Floats, float]:
    """Mean improvement of the correlations when two cells are swapped.

    Args:
        correlations: shape `(cells, cells)`.
        offsets: from `offset_classes`.
        usable: cells to compare.
        among: cells whose swaps are tested; default: all.

    Returns:
        The gain of each pair, shape `(among, among)`, -1 where there is none; and the smallest
        gain of a swap.
    """
    expected, known = _expected(correlations, offsets, _compared(usable))
    spread = float(np.median(np.abs(correlations[known] - expected[known]))) if known.any() else 0.0
    cells = np.arange(len(correlations)) if among is None else among
    seen = correlations if among is None else np.ascontiguousarray(correlations[:, cells])
    # misfit[a, i]: distance of cell a's correlations from those expected at place i. By rows, which
    # are contiguous in memory; the correlations are symmetric.
    misfit = np.stack(
        [np.abs(seen[known[i]] - expected[i, known[i], None]).sum(axis=0) for i in cells], axis=1
    )
    correlations, expected = correlations[np.ix_(cells, cells)], expected[np.ix_(cells, cells)]
    weight, others = known[np.ix_(cells, cells)].astype(np.float64), known[cells].sum(axis=1)
    # The correlation of the two with each other does not change.
    own = np.diag(misfit)[:, None] - weight * np.abs(correlations - expected)
    other = misfit.T - weight * np.abs(1.0 - expected)
    pairs = others[:, None] + others[None, :] - 2.0 * weight
    gain: Floats = np.where(pairs > 0, (own + own.T - other - other.T) / np.maximum(pairs, 1), -1.0)
    gain[~usable[cells]] = gain[:, ~usable[cells]] = -1.0
    np.fill_diagonal(gain, -1.0)
    return gain, max(LEAST_GAIN, LEAST_TO_SPREAD * spread)


def offset_classes(layout: Layout) -> Pairs:
    """A number for each offset between two cells, equal for the opposite offset, 0 beyond the
    reach, shape `(cells, cells)`."""
    # In hundredths of a mm: tolerates rounding.
    x, y = (np.rint(1e2 * (a[:, None] - a)).astype(np.int64) for a in (layout.x_mm, layout.y_mm))
    near = x * x + y * y <= (1e2 * _REACH * layout.pitch_mm) ** 2
    np.fill_diagonal(near, False)
    offsets: Pairs = np.zeros(near.shape, np.intp)
    offsets[near] = 1 + np.unique(np.abs((x[near] << 24) + y[near]), return_inverse=True)[1]
    return offsets


def enough_pairs(offsets: Pairs) -> bool:
    """Whether any offset has enough pairs to find swaps."""
    count = np.bincount(np.triu(offsets).ravel(), minlength=1)
    return bool((count[1:] >= _LEAST_PAIRS).any())


def _compared(usable: Mask) -> PairMask:
    pairs: PairMask = np.outer(usable, usable)
    np.fill_diagonal(pairs, False)
    return pairs


def _expected(correlations: Floats, offsets: Pairs, compared: PairMask) -> tuple[Floats, PairMask]:
    """The median over pairs of the same offset, and the pairs with enough others."""
    pair = np.triu(compared & (offsets > 0))
    number, value = offsets[pair], correlations[pair]
    order = np.lexsort((value, number))
    number, value = number[order], value[order]
    count = np.bincount(number, minlength=int(offsets.max()) + 1)
    first = np.cumsum(count) - count
    if not value.size:
        return np.zeros_like(correlations), np.zeros_like(compared)
    low, high = (
        np.minimum(first + half, value.size - 1)
        for half in (np.maximum(count - 1, 0) // 2, count // 2)
    )
    median = (value[low] + value[high]) / 2.0
    return median[offsets], (count >= _LEAST_PAIRS)[offsets] & compared


def _correlations(light: Values) -> Floats:
    with np.errstate(invalid="ignore", divide="ignore"):
        found: Floats = np.corrcoef(light.T.astype(np.float64))
    return np.nan_to_num(np.atleast_2d(found))
