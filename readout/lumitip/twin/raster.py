"""The plane of an object as a raster: the light that each pixel contributes to each cell.

Direct light crosses the pixel on its way from an LED to the cell's detector. Scattered light is
sent there by a diffuse object in that pixel, as a Lambertian sheet: the irradiance by all LEDs,
times the detector's view of the pixel, times its area over pi.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip.grid import Floats, Integers
from lumitip.layout import Layout
from lumitip.twin.lines import Numbers
from lumitip.twin.optics import Model
from lumitip.twin.pairs import Emitter, Pairs, spread, tally
from lumitip.twin.rays import REACH_MM, hole_points, in_hole, relative_light
from lumitip.twin.scene import PIXEL_MM, Singles

_DENSE_CELLS = 64  # with more cells, gathering the pixels of each is faster
_PATCH_MM = 8.0  # around an LED or detector, beyond which scattered light is neglected
_THICK_MM = 0.2  # smallest distance of a sheet from a mask
_COARSE = 3  # points across half of a hole; enough for scattered light
_LEAST = 1e-5  # share of a cell's light below which a pixel is neglected


@dataclass(frozen=True, eq=False)
class Plane:
    """Pixels of a plane, and the share of each cell's light that they contribute."""

    x_mm: Singles
    """Centre of each pixel, shape `(pixels,)` (mm)."""
    y_mm: Singles
    pixel_mm: float
    """Width of a pixel (mm)."""
    weights: Singles
    """Share of each cell's light, shape `(cells, pixels)`, or `(cells, most)` with `index`."""
    index: NDArray[np.intp] | None
    """With many cells: the pixels that each sees, shape `(cells, most)`."""

    def __call__(self, coverage: Singles) -> Numbers:
        """Share of each cell's light from a coverage of the pixels.

        Args:
            coverage: shape `(pixels,)` or `(n, pixels)`; the result is `(cells,)` or `(n, cells)`.
        """
        if self.index is None:
            if coverage.ndim == 1:
                one: Numbers = np.dot(self.weights, coverage)
                return one
            many: Numbers = np.dot(coverage, self.weights.T)
            return many
        if coverage.ndim == 1:
            alone: Numbers = np.einsum("jk,jk->j", self.weights, coverage[self.index])
            return alone
        by_pixel = np.ascontiguousarray(coverage.T)
        pairs = zip(self.weights, self.index, strict=True)
        return np.stack([weight @ by_pixel[index] for weight, index in pairs], axis=1)


def direct_plane(layout: Layout, pairs: Pairs, emitter: Emitter, height: float) -> Plane:
    """Light that crosses the plane at a height in the gap (0 receiver, 1 emitter)."""
    grid = _Grid.around(layout, emitter.model)
    return _plane(len(layout), grid, _Direct(layout, pairs, height, grid).row)


def scattered_plane(layout: Layout, pairs: Pairs, emitter: Emitter, height: float) -> Plane:
    """Light from a plane of which every pixel scatters all light that falls on it."""
    grid = _Grid.around(layout, emitter.model)
    scattered = _Scattered(layout, emitter, height, grid)
    return _plane(len(layout), grid, lambda cell: scattered.row(cell) / pairs.full[cell])


def blended(direct: Plane, scattered: Plane, clear: float, diffuse: float) -> Plane:
    """The plane of one material: light taken by an object of it, less the light that it scatters.

    Both planes must be dense.
    """
    size = scattered.weights.shape[1]
    both = np.concatenate([direct.x_mm + 1j * direct.y_mm, scattered.x_mm + 1j * scattered.y_mm])
    places, each = np.unique(both, return_inverse=True)
    weights = np.zeros((len(direct.weights), places.size), dtype=np.float32)
    weights[:, each[:-size]] = np.float32(1.0 - clear) * direct.weights
    weights[:, each[-size:]] -= np.float32(diffuse) * scattered.weights
    x_mm, y_mm = places.real.astype(np.float32), places.imag.astype(np.float32)
    return Plane(x_mm, y_mm, direct.pixel_mm, weights, None)


def _plane(cells: int, grid: "_Grid", row: Callable[[int], Floats]) -> Plane:
    seen, rows = [], []
    for cell in range(cells):
        light = row(cell)
        lit = np.flatnonzero(light > _LEAST)
        seen.append(lit)
        # Light of the neglected pixels is spread over the others.
        rows.append(light[lit] * (light.sum() / light[lit].sum()))
    used = np.unique(np.concatenate(seen))
    dense = cells <= _DENSE_CELLS
    most = used.size if dense else max(map(len, seen))
    index = np.zeros((cells, most), dtype=np.intp)
    weights = np.zeros((cells, most), dtype=np.float32)
    for cell, (lit, light) in enumerate(zip(seen, rows, strict=True)):
        places = np.searchsorted(used, lit)
        index[cell, : lit.size] = places
        weights[cell, places if dense else slice(lit.size)] = light
    return Plane(*grid.centres(used), grid.pixel_mm, weights, None if dense else index)


@dataclass(frozen=True)
class _Grid:
    """Pixels, symmetric about the origin: centres at odd multiples of half a pixel."""

    left: int
    low: int
    wide: int
    high: int
    pixel_mm: float

    @classmethod
    def around(cls, layout: Layout, model: Model) -> "_Grid":
        # Small holes resolve finer details than the usual pixel.
        pixel_mm = min(PIXEL_MM, model.hole_mm * float(layout.hole_share.min()) / 5.0)
        margin = REACH_MM / 2.0 + _PATCH_MM / 2.0
        half = [
            int(np.ceil((np.abs(a).max() + margin) / pixel_mm)) for a in (layout.x_mm, layout.y_mm)
        ]
        return cls(-half[0], -half[1], 2 * half[0], 2 * half[1], pixel_mm)

    @property
    def pixels(self) -> int:
        return self.wide * self.high

    def centres(self, index: Integers) -> tuple[Singles, Singles]:
        x = (index % self.wide + self.left + 0.5) * self.pixel_mm
        y = (index // self.wide + self.low + 0.5) * self.pixel_mm
        return x.astype(np.float32), y.astype(np.float32)

    def near(self, x_mm: float, y_mm: float) -> Integers:
        """Pixels within a patch around a place."""
        half = round(_PATCH_MM / self.pixel_mm)
        column, row = int(np.floor(x_mm / self.pixel_mm)), int(np.floor(y_mm / self.pixel_mm))
        columns = np.arange(max(column - half, self.left), min(column + half, -self.left - 1) + 1)
        rows = np.arange(max(row - half, self.low), min(row + half, -self.low - 1) + 1)
        return self.index(columns[None, :], rows[:, None]).ravel()

    def index(self, column: Integers, row: Integers) -> Integers:
        return (row - self.low) * self.wide + column - self.left


class _Direct:
    """Light that crosses each pixel, as shares of a cell's light."""

    def __init__(self, layout: Layout, pairs: Pairs, height: float, grid: _Grid) -> None:
        self._layout, self._pairs, self._grid = layout, pairs, grid
        self._spots = [pairs.spots(kind, height) for kind in range(len(pairs.kinds))]

    def row(self, cell: int) -> Floats:
        """Light of one cell, shape `(pixels,)`."""
        spots = [self._spots[k] for k in self._pairs.kind[self._pairs.cell == cell]]
        x, y, light = (np.concatenate(part) for part in zip(*spots, strict=True))
        column, row, share = spread(
            (x + self._layout.x_mm[cell]) / self._grid.pixel_mm - 0.5,
            (y + self._layout.y_mm[cell]) / self._grid.pixel_mm - 0.5,
        )
        index = self._grid.index(column, row).ravel()
        shares: Floats = (
            tally(index, (share * light).ravel(), self._grid.pixels) / self._pairs.full[cell]
        )
        return shares


class _Scattered:
    """Light that each pixel sends to a cell if it scatters all light that falls on it."""

    def __init__(self, layout: Layout, emitter: Emitter, height: float, grid: _Grid) -> None:
        self._layout, self._grid, self._height = layout, grid, height
        self._model = model = emitter.model
        self._gap_mm = gap_mm = emitter.gap_mm(layout.y_mm)
        led_x, led_y = emitter.leds_mm(layout)
        self._irradiance = np.zeros(grid.pixels)
        for x, y, gap, share in zip(led_x, led_y, gap_mm, layout.hole_share, strict=True):
            index, light = self._patch(
                x, y, share, (1.0 - height) * gap, model.emitter_depth_mm, model.led_exponent
            )
            self._irradiance[index] += light

    def row(self, cell: int) -> Floats:
        """Light of one cell, shape `(pixels,)`, on the scale of the bundles."""
        index, light = self._patch(
            self._layout.x_mm[cell],
            self._layout.y_mm[cell],
            self._layout.hole_share[cell],
            self._height * self._gap_mm[cell],
            self._model.detector_depth_mm,
            self._model.detector_exponent,
        )
        row = np.zeros(self._grid.pixels)
        row[index] = self._irradiance[index] * light * (self._grid.pixel_mm**2 / np.pi)
        return row

    def _patch(
        self,
        x_mm: float,
        y_mm: float,
        hole: float,
        away_mm: float,
        depth_mm: float,
        exponent: float,
    ) -> tuple[Integers, Floats]:
        """Pixels around an LED or detector, and the light that passes between it and each."""
        away_mm = max(away_mm, _THICK_MM)
        index = self._grid.near(x_mm, y_mm)
        x, y = (a.astype(np.float64) for a in self._grid.centres(index))
        x, y = x - x_mm, y - y_mm
        power = -(exponent + 3.0) / 2.0
        deep = away_mm + depth_mm
        through = in_hole(self._model, hole)(x * (depth_mm / deep), y * (depth_mm / deep))
        die = through * (1.0 + (x * x + y * y) / deep**2) ** power / deep**2
        hole_x, hole_y = hole_points(self._model, _COARSE)
        square = (x[:, None] - hole * hole_x) ** 2 + (y[:, None] - hole * hole_y) ** 2
        spread = ((1.0 + square / away_mm**2) ** power).mean(axis=1) / away_mm**2
        spread *= relative_light(self._model, hole, depth_mm, exponent)
        light: Floats = (1.0 - self._model.alpha) * die + self._model.alpha * spread
        return index, light
