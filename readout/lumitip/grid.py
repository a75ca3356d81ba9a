r"""The hexagonal grid of cells: the only place that computes positions and neighbours.

    column 0   1   2          pitch_mm: distance of a cell to each of its six neighbours
           o       o   row 0  (nearest the tip)
               o       row 0
           o       o   row 1
               o       row 1
           o       o   row 2

Columns may have any lengths. They are `pitch_mm * sqrt(3) / 2` apart; each is offset by half a
pitch from the one before it. If the lengths of neighbouring columns differ by 1, 3, 5 ..., every
column is centred on y = 0. Otherwise every column is shifted by a quarter of the pitch: columns of
equal length alternate towards the tip and away from it, the leftmost towards the tip.

x = 0 is the mean of the cell centres; y = 0 is the centre line of the columns. Cells are ordered
column by column, leftmost first in the receiver's sensor frame, row 0 nearest the tip.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip.errors import ArgumentError
from lumitip.values import as_float, shown

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Grid:
    """Cells of a hexagonal grid in frame order, arrays of shape `(cells,)`."""

    x_mm: Floats
    """Distance from the mean of the cell centres, to the right in the receiver's frame."""
    y_mm: Floats
    """Distance from the centre line of the columns, towards the tip."""
    column: Integers
    """Column of each cell, 0 leftmost."""
    row: Integers
    """Row of each cell within its column, 0 nearest the tip."""


def column_pitch_mm(pitch_mm: float) -> float:
    """Distance between neighbouring columns of a hexagonal grid (mm)."""
    return float(pitch_mm * np.sqrt(3.0) / 2.0)


def hexagonal_grid(columns: Sequence[int], pitch_mm: float) -> Grid:
    """Cell centres of a hexagonal grid.

    Args:
        columns: number of cells of each column.
        pitch_mm: distance between neighbouring cells (mm), above 0.

    Raises:
        ArgumentError: if a column has no cell or the pitch is not above 0.
    """
    counts = _counts(columns)
    if not 0.0 < as_float(pitch_mm) < math.inf:
        raise ArgumentError(f"pitch_mm is {shown(pitch_mm)}; a number above 0 is needed")
    pitch_mm = float(pitch_mm)
    column, row = _places(counts)
    y_mm = _quarters(counts) / 4.0 * pitch_mm
    across = column - column.mean()
    return Grid(across * column_pitch_mm(pitch_mm), y_mm, column, row)


def hexagonal_neighbours(columns: Sequence[int]) -> Integers:
    """Pairs of cells one pitch apart, sorted, smaller index first, shape `(pairs, 2)`.

    Raises:
        ArgumentError: if a column has no cell.
    """
    counts = _counts(columns)
    columns_of, heights = _places(counts)[0].tolist(), _quarters(counts).tolist()
    index = {place: i for i, place in enumerate(zip(columns_of, heights, strict=True))}
    pairs = [
        (here, index[there])
        for (column, height), here in index.items()
        for there in ((column, height - 4), (column + 1, height + 2), (column + 1, height - 2))
        if there in index
    ]
    return np.array(sorted(pairs), dtype=np.int64).reshape(-1, 2)


def collinear(x_mm: Floats, y_mm: Floats) -> bool:
    """Whether all cells lie on one line: the angle of an edge across it is then unknown."""
    places = np.stack([x_mm - x_mm[0], y_mm - y_mm[0]])
    sizes = np.linalg.svd(places, compute_uv=False)
    return bool(sizes[-1] <= 1e-6 * sizes[0])


def _places(counts: Integers) -> tuple[Integers, Integers]:
    """Column and row of each cell."""
    column = np.repeat(np.arange(counts.size), counts)
    first = np.cumsum(counts) - counts
    return column, np.arange(counts.sum()) - first[column]


def _quarters(counts: Integers) -> Integers:
    """Height of each cell above y = 0 in quarters of the pitch: exact integers."""
    column, row = _places(counts)
    # Columns of the same class, centred, fit the same lattice; the other class is half a pitch off.
    other_class = (counts - 1 - np.arange(counts.size)) % 2 != (counts[0] - 1) % 2
    shifts = np.where(other_class, -1, 1) if other_class.any() else np.zeros_like(counts)
    return np.asarray(2 * (counts[column] - 1) - 4 * row + shifts[column], dtype=np.int64)


def _counts(columns: Sequence[int]) -> Integers:
    try:
        array = np.asarray(columns)
    except ValueError as error:  # rows of different lengths
        raise _column_error(columns, "whole numbers are needed") from error
    if array.ndim != 1 or (array.size and array.dtype.kind not in "iu"):
        raise _column_error(columns, "whole numbers are needed")
    counts = array.astype(np.int64)
    if counts.size == 0 or (counts < 1).any():
        raise _column_error(columns, "every column needs at least one cell")
    return counts


def _column_error(columns: object, needed: str) -> ArgumentError:
    return ArgumentError(f"columns is {shown(columns)}; {needed}")
