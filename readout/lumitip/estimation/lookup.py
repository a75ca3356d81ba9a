"""`Lookup`: the twin's table of an edge or a cable, with its slopes, for many lines at once."""

from collections.abc import Sequence

import numpy as np

from lumitip.grid import Floats
from lumitip.twin import LineTable
from lumitip.twin.scene import Singles
from lumitip.twin.tables import STEP_DEG, STEP_MM

_NONE = np.empty(0)


class Lookup:
    """Shares of light and their derivatives, linear between the entries of a `LineTable`."""

    def __init__(self, table: LineTable, drifted: Sequence[LineTable] = ()) -> None:
        """Arrange the tables so that one gather reads four neighbouring entries.

        Args:
            table: of the expected optics.
            drifted: of the same cells, each with one parameter of the optics changed by a standard
                deviation.
        """
        shares = table.shares
        cells, self._angles, self._distances = shares.shape
        expected = _flat(shares)
        self._tables = np.empty((1 + len(drifted), expected.size), np.float32)
        self._tables[0] = expected
        for row, other in zip(self._tables[1:], drifted, strict=True):
            np.subtract(_flat(_as_wide(other.shares, self._distances)), expected, out=row)
        self._begin = np.arange(cells) * ((self._angles + 1) * self._distances)
        self._corners = np.array([[0, 1], [self._distances, self._distances + 1]])
        self._middle = table.reach_mm / STEP_MM
        self._most = self._distances - 1.001

    def __call__(
        self, angle: Floats, left_mm: Floats, drift: Floats = _NONE
    ) -> tuple[Floats, Floats, Floats, Floats]:
        """Share, slope by distance (1/mm) and by angle (1/rad), each of shape `(..., cells)`, and
        by each drift, shape `(drifts, ..., cells)`.

        Args:
            angle: direction of each line, shape `(..., 1)`, or beside each cell, `(..., cells)`
                (rad).
            left_mm: distance of each cell, left of it, shape `(..., cells)` (mm).
            drift: of the optics, in standard deviations of each parameter, shape `(drifts,)`; empty
                for the expected optics, without slopes by drift.
        """
        turn = np.asarray(angle) * (180.0 / np.pi / STEP_DEG) % self._angles
        first = turn.astype(np.int64)
        down = turn - first
        way = np.minimum(np.maximum(left_mm * (1.0 / STEP_MM) + self._middle, 0.0), self._most)
        column = way.astype(np.int64)
        right = way - column
        at = self._begin + column + first * self._distances
        at = at + self._corners.reshape(2, 2, *(1,) * at.ndim)
        # By table, by direction, by distance; the drifts' tables are differences to the first.
        entries = self._tables[: 1 + drift.size].take(at, axis=1)
        if drift.any():
            entries[0] += (drift @ entries[1:].reshape(drift.size, -1)).reshape(at.shape)
        steps = entries[:, :, 1] - entries[:, :, 0]
        rows = entries[:, :, 0] + right * steps
        between = rows[:, 1] - rows[:, 0]
        shares = rows[:, 0] + down * between
        by_left, further = steps[0]
        slope = (by_left + down * (further - by_left)) * (1.0 / STEP_MM)
        return shares[0], slope, between[0] * (180.0 / np.pi / STEP_DEG), shares[1:]

    def shares(self, angle: Floats, left_mm: Floats, drift: Floats = _NONE) -> Floats:
        """The shares alone."""
        return self(angle, left_mm, drift)[0]


def _flat(shares: Singles) -> Singles:
    # With the first direction repeated at the end, no index needs to be wrapped.
    return np.concatenate([shares, shares[:, :1]], axis=1).ravel()


def _as_wide(shares: Singles, distances: int) -> Singles:
    """The shares over more or fewer distances; beyond its ends a table is constant."""
    spare = (distances - shares.shape[2]) // 2
    if spare >= 0:
        return np.pad(shares, ((0, 0), (0, 0), (spare, spare)), mode="edge")
    return shares[:, :, -spare:spare]
