"""`Lookup`: the twin's table of an edge or a cable, with its slopes, for many lines at once."""

import numpy as np

from lumitip.grid import Floats
from lumitip.twin import LineTable
from lumitip.twin.tables import STEP_DEG, STEP_MM


class Lookup:
    """Shares of light and their derivatives, linear between the entries of a `LineTable`."""

    def __init__(self, table: LineTable) -> None:
        """Lay out a table so that four neighbouring entries are one gather."""
        shares = table.shares
        cells, self._angles, self._distances = shares.shape
        # The first direction once more at the end, so that no index needs to be wrapped.
        self._flat = np.concatenate([shares, shares[:, :1]], axis=1).ravel()
        self._begin = np.arange(cells) * ((self._angles + 1) * self._distances)
        self._corners = np.array([0, 1, self._distances, self._distances + 1])
        self._middle = table.reach_mm / STEP_MM
        self._most = self._distances - 1.001

    def __call__(self, angle: Floats, left_mm: Floats) -> tuple[Floats, Floats, Floats]:
        """Share, slope by distance (1/mm) and by angle (1/rad), each of shape `(..., cells)`.

        Args:
            angle: direction of each line, shape `(...)` (rad).
            left_mm: distance of each cell, left of it, shape `(..., cells)` (mm).
        """
        turn = np.asarray(angle) * (180.0 / np.pi / STEP_DEG) % self._angles
        first = turn.astype(np.int64)
        down = (turn - first)[..., None]
        way = np.minimum(np.maximum(left_mm * (1.0 / STEP_MM) + self._middle, 0.0), self._most)
        column = way.astype(np.int64)
        right = way - column
        at = self._begin + column + (first * self._distances)[..., None]
        one, two, three, four = self._flat[at + self._corners.reshape(4, *(1,) * at.ndim)]
        upper, lower = two - one, four - three
        near, far = one + right * upper, three + right * lower
        share = near + down * (far - near)
        slope = (upper + down * (lower - upper)) * (1.0 / STEP_MM)
        return share, slope, (far - near) * (180.0 / np.pi / STEP_DEG)

    def shares(self, angle: Floats, left_mm: Floats) -> Floats:
        """The shares alone."""
        return self(angle, left_mm)[0]
