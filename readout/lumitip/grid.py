r"""The hexagonal grid of cells: the one place where positions and neighbours are computed.

    column 0   1   2          pitch_mm: distance of a cell to each of its six neighbours
           o       o   row 0  (nearest the tip)
               o       row 0
           o       o   row 1
               o       row 1
           o       o   row 2

Columns are centred on y = 0 and stand `pitch_mm * sqrt(3) / 2` apart; the origin is the mean of
the cell centres. Cells are ordered column by column, leftmost first in the receiver's sensor
frame, row 0 nearest the tip.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip.errors import ArgumentError
from lumitip.given import as_float, shown

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Grid:
    """Cells of a hexagonal grid in frame order; every array has shape `(cells,)`."""

    x_mm: Floats
    """Distance from the mean of the cell centres, to the right in the receiver's frame."""
    y_mm: Floats
    """Distance from the mean of the cell centres, towards the tip."""
    column: Integers
    """Column of each cell, 0 leftmost."""
    row: Integers
    """Row of each cell within its column, 0 nearest the tip."""


def column_pitch_mm(pitch_mm: float) -> float:
    """Distance between neighbouring columns of a hexagonal grid of this pitch (mm)."""
    return float(pitch_mm * np.sqrt(3.0) / 2.0)


def hexagonal_grid(columns: Sequence[int], pitch_mm: float) -> Grid:
    """Cell centres of a hexagonal grid.

    Args:
        columns: number of cells of each column; neighbouring columns differ by one.
        pitch_mm: distance between neighbouring cells (mm), finite and above zero.

    Raises:
        ArgumentError: if two neighbouring columns do not differ by exactly one cell, a column is
            empty or no whole number, or the pitch is no such number.
    """
    counts = _counts(columns)
    if not 0.0 < as_float(pitch_mm) < math.inf:
        raise ArgumentError(f"pitch_mm: {shown(pitch_mm)} given, a number above 0 is needed")
    pitch_mm = float(pitch_mm)
    column = np.repeat(np.arange(counts.size), counts)
    first = np.cumsum(counts) - counts
    row = np.arange(counts.sum()) - first[column]
    y_mm = ((counts[column] - 1) / 2.0 - row) * pitch_mm
    across = column - column.mean()
    return Grid(across * column_pitch_mm(pitch_mm), y_mm, column, row)


def hexagonal_neighbours(columns: Sequence[int]) -> Integers:
    """All pairs of neighbouring cells of a hexagonal grid, each pair once.

    Args:
        columns: number of cells of each column, as for `hexagonal_grid`.

    Returns:
        Cell indices of shape `(pairs, 2)`, smaller index first, sorted.

    Raises:
        ArgumentError: as `hexagonal_grid`, of columns.
    """
    index: dict[tuple[int, int], int] = {}
    for column, count in enumerate(_counts(columns).tolist()):
        for row in range(count):
            # Height in half pitches: an integer, so neighbours are found without tolerance.
            index[column, count - 1 - 2 * row] = len(index)
    pairs = [
        (here, index[there])
        for (column, height), here in index.items()
        for there in ((column, height - 2), (column + 1, height + 1), (column + 1, height - 1))
        if there in index
    ]
    return np.array(sorted(pairs), dtype=np.int64).reshape(-1, 2)


def _counts(columns: Sequence[int]) -> Integers:
    try:
        told = np.asarray(columns)
    except ValueError as error:  # rows of different lengths
        raise _refused(columns, "whole numbers are needed") from error
    if told.ndim != 1 or (told.size and told.dtype.kind not in "iu"):
        raise _refused(columns, "whole numbers are needed")
    counts = told.astype(np.int64)
    if counts.size == 0 or (counts < 1).any():
        raise _refused(columns, "every column needs at least one cell")
    if (np.abs(np.diff(counts)) != 1).any():
        raise _refused(columns, "neighbouring columns must differ by one cell")
    return counts


def _refused(columns: object, needed: str) -> ArgumentError:
    return ArgumentError(f"columns: {shown(columns)} given, {needed}")
