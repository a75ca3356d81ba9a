"""`Polygon` and `Image`: objects of any form; `Outline`: the light within an outline.

By Green's theorem the sum of a cell's weights within an outline is the integral along it of
C dy, where C(x, y) is the sum of the weights left of x in the row at y. C is tabulated once for a
plane and read at points along the outline, so no pixel is drawn.
"""

import math
from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from lumitip import arguments
from lumitip.grid import Floats, Integers
from lumitip.twin.lines import Numbers, square_from_segment
from lumitip.twin.optics import TwinError
from lumitip.twin.raster import Plane
from lumitip.twin.scene import PIXEL_MM, Shape, Singles, Thing

_STEP_PIXELS = 0.5  # between points along the outline
_MOST_NUMBERS = 20_000_000  # of a table


@dataclass(frozen=True, eq=False)
class Polygon(Shape):
    """A closed polygon; its corners in either order, shape `(n, 2)` (mm)."""

    points_mm: Floats | Sequence[tuple[float, float]] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        points = arguments.numbers(self.points_mm, "points_mm", TwinError)
        if points.ndim != 2 or points.shape[1] != 2 or len(points) < 3:
            raise TwinError(
                f"points_mm has shape {points.shape}; three or more corners (x, y) are needed"
            )
        if not np.isfinite(points).all():
            raise TwinError("points_mm has a corner that is not finite; (x, y) in mm are needed")
        object.__setattr__(self, "points_mm", points.copy())

    @cached_property
    def simple(self) -> bool:
        """Whether no side touches another side, apart from its two neighbours."""
        return not _crosses_itself(np.asarray(self.points_mm))

    def signed_distance_mm(self, x_mm: Numbers, y_mm: Numbers) -> Numbers:
        """See `Shape`; inside is where a ray to the right crosses an odd number of edges."""
        begin = np.asarray(self.points_mm).tolist()
        shape = np.broadcast_shapes(np.shape(x_mm), np.shape(y_mm))
        nearest = np.full(shape, np.inf, np.result_type(x_mm, y_mm, np.float32))
        inside = np.zeros(nearest.shape, dtype=bool)
        for (ax, ay), (bx, by) in zip(begin, begin[1:] + begin[:1], strict=True):
            nearest = np.minimum(nearest, square_from_segment(x_mm, y_mm, (ax, ay), (bx, by)))
            if ay != by:
                crossing = (bx - ax) * (y_mm - ay) / (by - ay)
                inside ^= ((y_mm < ay) != (y_mm < by)) & (x_mm - ax < crossing)
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


@dataclass(frozen=True, eq=False)
class Image(Thing):
    """An object as pixels: coverage 0 to 1, first row nearest the tip, shape `(rows, columns)`.

    Its middle is at `(x_mm, y_mm)`, turned by `angle_deg`; nothing is covered outside of it.
    """

    pixels: Numbers
    pixel_mm: float = PIXEL_MM
    x_mm: float = 0.0
    y_mm: float = 0.0
    angle_deg: float = 0.0
    _framed: Singles = field(init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        pixels = arguments.numbers(self.pixels, "pixels", TwinError)
        if pixels.ndim != 2 or not pixels.size or not (0.0 <= pixels.min() <= pixels.max() <= 1.0):
            raise TwinError(
                f"pixels has shape {pixels.shape}; rows of coverage from 0 to 1 are needed"
            )
        arguments.number(self.pixel_mm, "pixel_mm", above=0.0, error=TwinError)
        # With a border of zeros, places outside need no test.
        object.__setattr__(self, "_framed", np.pad(pixels.astype(np.float32), 1))

    @classmethod
    def of(cls, thing: Thing, size_mm: float = 80.0, pixel_mm: float = 0.1) -> "Image":
        """Draw an object once, in a square around the origin, so that it moves at little cost."""
        size_mm = arguments.number(size_mm, "size_mm", above=0.0, error=TwinError)
        pixel_mm = arguments.number(pixel_mm, "pixel_mm", above=0.0, error=TwinError)
        half = int(np.ceil(size_mm / 2.0 / pixel_mm))
        line = np.arange(-half, half + 1) * pixel_mm
        pixels = thing.coverage(line[None, :], -line[:, None]).astype(np.float32)
        return cls(pixels, pixel_mm, clear=thing.clear, diffuse=thing.diffuse, height=thing.height)

    def coverage(self, x_mm: Numbers, y_mm: Numbers, pixel_mm: float = PIXEL_MM) -> Numbers:  # noqa: ARG002
        """See `Thing`: the value of the pixel at each place."""
        angle, scale = math.radians(self.angle_deg), 1.0 / self.pixel_mm
        cos, sin = math.cos(angle) * scale, math.sin(angle) * scale
        rows, columns = self._framed.shape
        right = 0.5 * columns - self.x_mm * cos - self.y_mm * sin
        down = 0.5 * rows + self.y_mm * cos - self.x_mm * sin
        column = np.clip(x_mm * cos + y_mm * sin + right, 0.0, columns - 1.0).astype(np.int32)
        row = np.clip(x_mm * sin - y_mm * cos + down, 0.0, rows - 1.0).astype(np.int32)
        found: Numbers = self._framed.ravel()[row * np.int32(columns) + column]
        return found

    def at(self, x_mm: float, y_mm: float, angle_deg: float) -> "Image":
        """The same image at another place (mm, degrees); the pixels are shared."""
        moved = copy(self)
        for name, value in (("x_mm", x_mm), ("y_mm", y_mm), ("angle_deg", angle_deg)):
            object.__setattr__(moved, name, value)
        arguments.finite_fields(moved, TwinError)
        return moved


class Outline:
    """The weights of a dense plane, summed from the left."""

    def __init__(self, plane: Plane) -> None:
        self._pixel_mm = plane.pixel_mm
        column, row = _places(plane)
        # With empty rows on both sides, places outside add nothing.
        self._left, self._low = int(column.min()), int(row.min()) - 1
        wide, high = int(column.max()) - self._left + 1, int(row.max()) - self._low + 2
        weights = np.zeros((high, wide + 1, len(plane.weights)), dtype=np.float32)
        weights[row - self._low, column - self._left + 1] = plane.weights.T
        sums = np.cumsum(weights, axis=1)
        self._high, self._wide = high, wide + 1
        self._sums = sums.reshape(high * (wide + 1), -1)

    @staticmethod
    def fits(plane: Plane) -> bool:
        """Whether the table of a plane is small enough."""
        if plane.index is not None:
            return False
        extent = [int(np.ptp(place)) + 3 for place in _places(plane)]
        return extent[0] * extent[1] * len(plane.weights) <= _MOST_NUMBERS

    def __call__(self, points_mm: Floats) -> Numbers:
        """Sum of each cell's weights within a simple polygon, shape `(cells,)`.

        Args:
            points_mm: its corners in either order, shape `(n, 2)` (mm).
        """
        corner = points_mm.T * (1.0 / self._pixel_mm)
        side = np.empty_like(corner)
        np.subtract(corner[:, 1:], corner[:, :-1], out=side[:, :-1])
        np.subtract(corner[:, 0], corner[:, -1], out=side[:, -1])
        turn = float(corner[0] @ side[1] - corner[1] @ side[0])  # above 0: counter-clockwise
        # The middles of the steps are numbered through all sides.
        steps = (np.abs(side).max(axis=0) * (1.0 / _STEP_PIXELS)).astype(np.int64) + 1
        pace = side / steps
        last = np.cumsum(steps)
        middles = np.arange(0.5, float(last[-1]))
        start = corner - (last - steps) * pace
        x, y, across, up = np.concatenate([start, pace]).repeat(steps, axis=1)
        return self._summed(x + middles * across, y + middles * up, up if turn > 0.0 else -up)

    def _summed(self, x: Floats, y: Floats, up: Floats) -> Numbers:
        """Interpolate the sums at points (pixels), times `up`, bilinearly."""
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
    """Column and row of each pixel; 0 is right of and above the origin."""
    column, row = (
        np.floor(np.asarray(a, np.float64) / plane.pixel_mm).astype(np.int64)
        for a in (plane.x_mm, plane.y_mm)
    )
    return column, row
