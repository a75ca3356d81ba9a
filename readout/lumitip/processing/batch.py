"""Threshold of a frame; thresholds, centres and markers of many frames at once.

The threshold λ between dark and light cells is the mean of the means of two clusters. The values
are sorted and cut in two at the largest step between neighbours in this order; of equal steps the
lowest counts. So a value between the step and λ is dark or light by λ alone.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip.grid import Floats, Integers
from lumitip.processing.fits import Points
from lumitip.values import one_line

Flags = NDArray[np.bool_]

FULL_LIGHT = 255.0
"""Value of a cell in full light; 0 is dark. In raw ADC codes dark is high."""
MOST = 1e9
"""Largest magnitude of a value that counts; sums of larger ones could overflow."""
_BLOCK_VALUES = 32_768  # of a block of frames, 256 KiB: it stays in the processor's cache


def usable_cells(values: Floats) -> Flags:
    """Mask of the values that count: neither NaN nor beyond `MOST`."""
    usable: Flags = np.abs(values) <= MOST
    return usable


def threshold(values: Floats) -> tuple[float, float]:
    """λ of one frame, and its contrast: the difference of the means of both clusters.

    Args:
        values: finite, shape `(cells,)`, at least two.
    """
    ordered = values.copy()
    ordered.sort()
    first = int((ordered[1:] - ordered[:-1]).argmax()) + 1
    low = float(np.add.reduce(ordered[:first])) / first
    high = float(np.add.reduce(ordered[first:])) / (ordered.size - first)
    return (low + high) / 2.0, high - low


def darkness(values: Floats) -> Floats:
    """Weight of dark cells in the dark centre, as published: 255 − value, within 0 to 255.

    Args:
        values: finite or NaN, any shape; NaN stays NaN. Not raw codes.
    """
    weights: Floats = FULL_LIGHT - np.minimum(np.maximum(values, 0.0), FULL_LIGHT)
    return weights


@dataclass(frozen=True, slots=True, eq=False)
class Batch:
    """Results of many frames; frames without contact have NaN, and no markers."""

    thresholds: Floats
    """λ of each frame, shape `(n,)`."""
    centres_mm: Floats
    """Mean of the dark cells, weighted with 255 − value, shape `(n, 2)` (mm)."""
    markers_mm: Floats
    """Markers of each frame, padded with NaN, shape `(n, most, 2)` (mm)."""
    counts: Integers
    """Number of markers of each frame, shape `(n,)`."""

    def __repr__(self) -> str:
        return one_line(self)


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """Cells and pairs of neighbours of a layout; points are complex numbers (mm)."""

    cells: Points
    begin: Integers
    end: Integers
    steps: Points

    def between(self, usable: Flags) -> "Grid":
        """The grid with only the pairs of usable cells."""
        kept = usable[self.begin] & usable[self.end]
        return Grid(self.cells, self.begin[kept], self.end[kept], self.steps[kept])


def process(values: Floats, grid: Grid, min_contrast: float) -> Batch:
    """Results of all frames of `values`, shape `(n, cells)`; other values are ignored."""
    frames, cells = values.shape
    levels = np.full(frames, np.nan)
    centres: Points = np.full(frames, complex(np.nan, np.nan))
    counts = np.zeros(frames, dtype=np.int64)
    markers = [np.empty(0, dtype=np.complex128)]
    block = max(_BLOCK_VALUES // cells, 1)
    for start in range(0, frames if cells > 1 else 0, block):
        here = slice(start, start + block)
        part, usable = values[here], None
        finite = usable_cells(part)
        if np.count_nonzero(finite) < part.size:
            part, usable = np.where(finite, part, np.nan), finite
        level, contrast = thresholds(part, usable)
        level[~((contrast >= min_contrast) & (contrast > 0.0))] = np.nan  # so no cell is dark
        is_dark = part < level[:, None]
        levels[here], centres[here] = level, _centres(part, is_dark, grid.cells)
        found, counts[here] = _markers(part, is_dark, level, usable, grid)
        markers.append(found)
    return Batch(levels, _pairs(centres), _pairs(padded(np.concatenate(markers), counts)), counts)


def thresholds(values: Floats, usable: Flags | None = None) -> tuple[Floats, Floats]:
    """λ and contrast of each row, see `threshold`.

    Args:
        values: shape `(n, cells)`, NaN where not usable.
        usable: mask of the finite values, `None` for all.
    """
    ordered = np.sort(values, axis=1)
    steps = ordered[:, 1:] - ordered[:, :-1]
    counts: Integers | int = values.shape[1]
    if usable is not None:
        counts = np.count_nonzero(usable, axis=1)
        steps[np.isnan(steps)] = -1.0
        ordered[np.isnan(ordered)] = 0.0
    first = steps.argmax(axis=1)
    running = np.add.accumulate(ordered, axis=1)
    below = running[np.arange(first.size), first]
    low = below / (first + 1)
    high = (running[:, -1] - below) / np.maximum(counts - 1 - first, 1)
    return (low + high) / 2.0, np.where(np.less(counts, 2), 0.0, high - low)


def padded(points: Points, counts: Integers) -> Points:
    """Rows of `counts` points each, padded with NaN to the longest."""
    most = int(counts.max(initial=0))
    rows: Points = np.full((counts.size, most), complex(np.nan, np.nan))
    rows[np.arange(most) < counts[:, None]] = points
    return rows


def _centres(values: Floats, is_dark: Flags, cells: Points) -> Points:
    weights = np.where(is_dark, darkness(values), 0.0)
    weightless = ~weights.any(axis=1)
    if weightless.any():
        weights[weightless] = is_dark[weightless]
    columns = np.stack((cells.real, cells.imag, np.ones(cells.size)), axis=1)
    x_mm, y_mm, total = (weights @ columns).T
    total[total == 0.0] = np.nan
    return np.asarray(x_mm / total + 1j * (y_mm / total))


def _markers(
    values: Floats, is_dark: Flags, level: Floats, usable: Flags | None, grid: Grid
) -> tuple[Points, Integers]:
    crossed = is_dark.take(grid.begin, axis=1) != is_dark.take(grid.end, axis=1)
    if usable is not None:
        crossed &= usable.take(grid.begin, axis=1) & usable.take(grid.end, axis=1)
    counts = np.count_nonzero(crossed, axis=1)
    pairs = crossed.ravel().nonzero()[0]
    rows = np.repeat(np.arange(counts.size), counts)
    pairs -= rows * grid.begin.size
    begin = grid.begin[pairs]
    row_starts, flat = rows * values.shape[1], np.ascontiguousarray(values).ravel()
    first = flat[row_starts + begin]
    last = flat[row_starts + grid.end[pairs]]
    share = (level[rows] - first) / (last - first)
    return grid.cells[begin] + share * grid.steps[pairs], counts


def _pairs(points: Points) -> Floats:
    return points.view(np.float64).reshape(*points.shape, 2)
