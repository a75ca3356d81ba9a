"""`Polygon`: an object of any outline."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from lumitip import arguments
from lumitip.grid import Floats, Integers
from lumitip.twin.optics import TwinError
from lumitip.twin.scene import Numbers, Shape


@dataclass(frozen=True, eq=False)
class Polygon(Shape):
    """A closed polygon, its corners in either order, shape `(n, 2)` (mm)."""

    points_mm: Floats | Sequence[tuple[float, float]] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        points = arguments.numbers(self.points_mm, "points_mm", TwinError)
        if points.ndim != 2 or points.shape[1] != 2 or len(points) < 3:
            raise TwinError(f"points_mm has shape {points.shape}; three or more (x, y) are needed")
        if not np.isfinite(points).all():
            raise TwinError("points_mm: a corner is not finite, (x, y) in mm are needed")
        object.__setattr__(self, "points_mm", points.copy())

    @cached_property
    def simple(self) -> bool:
        """Whether no side touches another one but its neighbours."""
        return not _crosses_itself(np.asarray(self.points_mm))

    def signed_distance_mm(self, x_mm: Numbers, y_mm: Numbers) -> Numbers:
        """See `Shape`; inside is where a ray to the right crosses an odd number of edges."""
        begin: Floats = np.asarray(self.points_mm)
        nearest = np.full(np.broadcast_shapes(np.shape(x_mm), np.shape(y_mm)), np.inf)
        inside = np.zeros(nearest.shape, dtype=bool)
        for (ax, ay), (bx, by) in zip(begin, np.roll(begin, -1, axis=0), strict=True):
            dx, dy, x, y = bx - ax, by - ay, x_mm - ax, y_mm - ay
            share = np.clip((x * dx + y * dy) / max(dx * dx + dy * dy, 1e-18), 0.0, 1.0)
            nearest = np.minimum(nearest, (x - share * dx) ** 2 + (y - share * dy) ** 2)
            if ay != by:
                inside ^= ((y_mm < ay) != (y_mm < by)) & (x < dx * y / dy)
        distance: Numbers = np.sqrt(nearest)
        return np.where(inside, -distance, distance)


def _crosses_itself(points_mm: Floats) -> bool:
    """Whether a closed polygon touches or crosses itself, shape `(n, 2)`."""
    after, strangers = _neighbours(len(points_mm))
    x, y = points_mm.T
    along, up = (points_mm[after] - points_mm).T
    # On which side of each side's line (row) each corner (column) lies.
    left = along[:, None] * y - up[:, None] * x
    left -= left.diagonal()[:, None]
    apart = left * left[:, after] <= 0.0
    return bool((apart & apart.T & strangers).any())


@lru_cache(maxsize=64)
def _neighbours(count: int) -> tuple[Integers, NDArray[np.bool_]]:
    """The next corner of each, and which sides of a polygon do not meet at a corner anyway."""
    which = np.arange(count)
    away = (which - which[:, None]) % count
    return (which + 1) % count, (away > 1) & (away < count - 1)
