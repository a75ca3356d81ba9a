"""`Lookup`: the twin's tables of edges and cables, with their slopes, for many lines at once."""

from collections.abc import Sequence

import numpy as np

from lumitip.grid import Floats, Integers
from lumitip.twin import LineTable
from lumitip.twin.scene import Singles
from lumitip.twin.tables import STEP_DEG, STEP_MM

_NONE = np.empty(0)

Sheet = Sequence[LineTable]
"""A table of the expected optics, and one for each parameter of the optics, changed by a standard
deviation."""


class Lookup:
    """Shares of light and their derivatives, linear between the entries of tables."""

    def __init__(self, *sheets: Sheet) -> None:
        """Arrange the tables so that one gather reads four neighbouring entries of each.

        Args:
            sheets: of the same cells and optics, each with as many tables.
        """
        expected = sheets[0][0]
        rows, self._angles, _ = expected.shares.shape
        self._distances = max(table.shares.shape[2] for sheet in sheets for table in sheet)
        self._size = rows * (self._angles + 1) * self._distances
        self._tables = np.empty((len(sheets[0]), len(sheets) * self._size), np.float32)
        for number, sheet in enumerate(sheets):
            there = self._tables[:, number * self._size : (number + 1) * self._size]
            for row, table in zip(there, sheet, strict=True):
                row[:] = _flat(as_wide(table.shares, self._distances))
            there[1:] -= there[0]
        self._begin = expected.row * ((self._angles + 1) * self._distances)
        self._corners = np.array([[0, 1], [self._distances, self._distances + 1]])
        self._middle = (self._distances - 1) / 2.0
        self._most = self._distances - 1.001

    def __call__(
        self, angle: Floats, left_mm: Floats, drift: Floats = _NONE, sheet: Integers | int = 0
    ) -> tuple[Floats, Floats, Floats, Floats]:
        """Share, slope by distance (1/mm) and by angle (1/rad), each of shape `(..., cells)`, and
        by each drift, shape `(drifts, ..., cells)`.

        Args:
            angle: direction of each line, shape `(..., 1)`, or beside each cell, `(..., cells)`
                (rad).
            left_mm: distance of each cell, left of it, shape `(..., cells)` (mm).
            drift: of the optics, in standard deviations of each parameter, shape `(..., drifts)`;
                empty for the expected optics, without slopes by drift.
            sheet: number of the sheet, broadcast with `left_mm`.
        """
        turn = np.asarray(angle) * (180.0 / np.pi / STEP_DEG) % self._angles
        # The remainder of a tiny negative angle is a whole turn.
        first = np.minimum(turn.astype(np.int64), self._angles - 1)
        down = turn - first
        way = np.minimum(np.maximum(left_mm * (1.0 / STEP_MM) + self._middle, 0.0), self._most)
        column = way.astype(np.int64)
        right = way - column
        at = self._begin + column + first * self._distances + sheet * self._size
        at = at + self._corners.reshape(2, 2, *(1,) * at.ndim)
        drifts = drift.shape[-1]
        # By table, by direction, by distance; the drifts' tables are differences to the first.
        entries = self._tables[: 1 + drifts].take(at, axis=1)
        if drift.any():
            for number in range(drifts):
                entries[0] += drift[..., number, None] * entries[1 + number]
        steps = entries[:, :, 1] - entries[:, :, 0]
        rows = entries[:, :, 0] + right * steps
        between = rows[:, 1] - rows[:, 0]
        shares = rows[:, 0] + down * between
        by_left, further = steps[0]
        slope = (by_left + down * (further - by_left)) * (1.0 / STEP_MM)
        return shares[0], slope, between[0] * (180.0 / np.pi / STEP_DEG), shares[1:]

    def shares(
        self, angle: Floats, left_mm: Floats, drift: Floats = _NONE, sheet: Integers | int = 0
    ) -> Floats:
        """The shares alone: without a drift, from the tables of the expected optics."""
        return self(angle, left_mm, drift if drift.any() else _NONE, sheet)[0]


def _flat(shares: Singles) -> Singles:
    # With the first direction repeated at the end, no index needs to be wrapped.
    return np.concatenate([shares, shares[:, :1]], axis=1).ravel()


def as_wide(shares: Singles, distances: int) -> Singles:
    """The shares over more or fewer distances; beyond its ends a table is constant."""
    spare = (distances - shares.shape[2]) // 2
    if spare >= 0:
        return np.pad(shares, ((0, 0), (0, 0), (spare, spare)), mode="edge")
    return shares[:, :, -spare:spare]


def between_borders(cable: LineTable, edge: LineTable, diameter_mm: float) -> LineTable:
    """What a cable takes beyond a strip of sheet as wide as it.

    Args:
        cable: the table of the cable.
        edge: of a half-plane, for the same cells.
        diameter_mm: of the cable (mm).
    """
    steps = diameter_mm / 2.0 / STEP_MM
    spare = int(np.ceil(steps))
    distances = max(cable.shares.shape[2], edge.shares.shape[2] + 2 * spare)
    inner = as_wide(edge.shares, distances)
    beside = np.pad(inner, ((0, 0), (0, 0), (spare, spare)), mode="edge")

    def moved(by: float) -> Singles:
        """The edge's shares, read `by` steps further left of it."""
        whole = int(np.floor(by))
        low = beside[:, :, spare + whole : spare + whole + distances]
        if by == whole:
            return low
        high = beside[:, :, spare + whole + 1 : spare + whole + 1 + distances]
        return low + np.float32(by - whole) * (high - low)

    rest = as_wide(cable.shares, distances) - moved(-steps) + moved(steps)
    return LineTable(rest, (distances - 1) / 2.0 * STEP_MM, cable.row)
