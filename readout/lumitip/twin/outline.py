"""Area inside an outline, computed from the outline without a raster.

By Green's theorem the sum of a cell's weights within an outline is the integral along it of
C dy, where C(x, y) is the sum of the weights left of x in the row at y. C is tabulated once for a
plane, and read at points along the outline.
"""

import numpy as np
from numpy.typing import NDArray

from lumitip.grid import Floats
from lumitip.twin.raster import Plane
from lumitip.twin.scene import Numbers

_STEP_PIXELS = 0.5  # between points along the outline
_MOST_NUMBERS = 20_000_000  # of a table


class Outline:
    """The weights of a plane, summed from the left."""

    def __init__(self, plane: Plane) -> None:
        """Tabulate the sums of a plane whose weights are dense."""
        self._pixel_mm = plane.pixel_mm
        column, row = _places(plane)
        # Empty rows on both sides, so that what is outside reads nothing.
        self._left, self._low = int(column.min()), int(row.min()) - 1
        wide, high = int(column.max()) - self._left + 1, int(row.max()) - self._low + 2
        weights = np.zeros((high, wide + 1, len(plane.weights)), dtype=np.float32)
        weights[row - self._low, column - self._left + 1] = plane.weights.T
        sums = np.cumsum(weights, axis=1)
        self._high, self._wide = high, wide + 1
        self._sums = sums.reshape(high * (wide + 1), -1)

    @staticmethod
    def fits(plane: Plane) -> bool:
        """Whether a plane can be tabulated: of many cells it would be large."""
        if plane.index is not None:
            return False
        extent = [int(np.ptp(place)) + 3 for place in _places(plane)]
        return extent[0] * extent[1] * len(plane.weights) <= _MOST_NUMBERS

    def __call__(self, points_mm: Floats) -> Numbers:
        """Sum of each cell's weights within a closed polygon that does not cross itself.

        Args:
            points_mm: its corners in either order, shape `(n, 2)` (mm).

        Returns:
            Shape `(cells,)`.
        """
        corner = points_mm.T * (1.0 / self._pixel_mm)
        side = np.empty_like(corner)
        np.subtract(corner[:, 1:], corner[:, :-1], out=side[:, :-1])
        np.subtract(corner[:, 0], corner[:, -1], out=side[:, -1])
        turn = float(corner[0] @ side[1] - corner[1] @ side[0])  # above 0 counter-clockwise
        # Steps of each side; their middles count on over all sides.
        steps = (np.abs(side).max(axis=0) * (1.0 / _STEP_PIXELS)).astype(np.int64) + 1
        pace = side / steps
        last = np.cumsum(steps)
        middles = np.arange(0.5, float(last[-1]))
        start = corner - (last - steps) * pace
        x, y, across, up = np.concatenate([start, pace]).repeat(steps, axis=1)
        return self._summed(x + middles * across, y + middles * up, up if turn > 0.0 else -up)

    def _summed(self, x: Floats, y: Floats, up: Floats) -> Numbers:
        """The sums at points (pixels), each times `up`, linear between columns and rows."""
        across = np.minimum(np.maximum(x - self._left, 0.0), self._wide - 1.001)
        rows = np.minimum(np.maximum(y - (self._low + 0.5), 0.0), self._high - 1.001)
        column, row = across.astype(np.int64), rows.astype(np.int64)
        right, above = across - column, (rows - row) * up
        below = up - above
        at = row * self._wide + column
        share = np.concatenate(
            [below - below * right, below * right, above - above * right, above * right]
        )
        places = np.concatenate([at, at + 1, at + self._wide, at + (self._wide + 1)])
        summed: Numbers = share.astype(np.float32) @ self._sums.take(places, axis=0)
        return summed


def _places(plane: Plane) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Column and row of each pixel, 0 right of and above the origin."""
    column, row = (
        np.floor(np.asarray(a, np.float64) / plane.pixel_mm).astype(np.int64)
        for a in (plane.x_mm, plane.y_mm)
    )
    return column, row
