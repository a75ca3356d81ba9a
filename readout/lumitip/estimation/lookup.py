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
        """Lay out tables so that four neighbouring entries are one gather.

        Args:
            table: of the optics that are expected.
            drifted: of the same cells, each with one thing about the optics a standard deviation
                off.
        """
        shares = table.shares
        cells, self._angles, self._distances = shares.shape
        self._flat = _flat(shares)
        self._drifts = np.empty((len(drifted), self._flat.size), np.float32)
        for row, other in zip(self._drifts, drifted, strict=True):
            np.subtract(_flat(_as_wide(other.shares, self._distances)), self._flat, out=row)
        self._begin = np.arange(cells) * ((self._angles + 1) * self._distances)
        self._corners = np.array([0, 1, self._distances, self._distances + 1])
        self._middle = table.reach_mm / STEP_MM
        self._most = self._distances - 1.001

    def __call__(
        self, angle: Floats, left_mm: Floats, drift: Floats = _NONE
    ) -> tuple[Floats, Floats, Floats, Floats]:
        """Share, slope by distance (1/mm) and by angle (1/rad), each of shape `(..., cells)`, and
        by each drift, shape `(drifts, ..., cells)`.

        Args:
            angle: direction of each line, shape `(...)` (rad).
            left_mm: distance of each cell, left of it, shape `(..., cells)` (mm).
            drift: how far the optics are off, in standard deviations of each thing that may be,
                shape `(drifts,)`; empty for the optics that are expected, without slopes by them.
        """
        turn = np.asarray(angle) * (180.0 / np.pi / STEP_DEG) % self._angles
        first = turn.astype(np.int64)
        down = (turn - first)[..., None]
        way = np.minimum(np.maximum(left_mm * (1.0 / STEP_MM) + self._middle, 0.0), self._most)
        column = way.astype(np.int64)
        right = way - column
        at = self._begin + column + (first * self._distances)[..., None]
        at = at + self._corners.reshape(4, *(1,) * at.ndim)
        entries, by_drift = self._flat[at], np.empty((0, *left_mm.shape))
        if drift.size:
            more = self._drifts.take(at, axis=1)
            if drift.any():
                entries = entries + (drift @ more.reshape(drift.size, -1)).reshape(at.shape)
            near = more[:, 0] + right * (more[:, 1] - more[:, 0])
            by_drift = near + down * (more[:, 2] + right * (more[:, 3] - more[:, 2]) - near)
        one, two, three, four = entries
        upper, lower = two - one, four - three
        near, far = one + right * upper, three + right * lower
        share = near + down * (far - near)
        slope = (upper + down * (lower - upper)) * (1.0 / STEP_MM)
        return share, slope, (far - near) * (180.0 / np.pi / STEP_DEG), by_drift

    def shares(self, angle: Floats, left_mm: Floats, drift: Floats = _NONE) -> Floats:
        """The shares alone."""
        return self(angle, left_mm, drift)[0]


def _flat(shares: Singles) -> Singles:
    # The first direction once more at the end, so that no index needs to be wrapped.
    return np.concatenate([shares, shares[:, :1]], axis=1).ravel()


def _as_wide(shares: Singles, distances: int) -> Singles:
    """The shares over as many distances: beyond its ends a table does not change any more."""
    spare = (distances - shares.shape[2]) // 2
    if spare >= 0:
        return np.pad(shares, ((0, 0), (0, 0), (spare, spare)), mode="edge")
    return shares[:, :, -spare:spare]
