"""A buffer of depths: how near to the viewer the nearest surface is in each pixel of a page."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Indices = NDArray[np.int64]
PIXEL_MM = 0.25
_FLAT = 1e-9  # twice the area of a triangle that covers nothing, in pixels
_CHUNK = 200_000  # pixels of triangles at a time


def depths_mm(bodies: Iterable[Points]) -> tuple[Points, Points]:
    """The greatest height above the page in each pixel.

    Args:
        bodies: corners of the triangles of each, shape `(n, 3, 3)`: x and y on the page, and the
            height above it (mm).

    Returns:
        The corner of the page at pixel 0, 0 (mm); and the heights by row and column, minus infinity
        where nothing is.
    """
    corners = np.concatenate(list(bodies))
    low = corners[:, :, :2].min(axis=(0, 1)) - 2 * PIXEL_MM
    high = corners[:, :, :2].max(axis=(0, 1)) + 2 * PIXEL_MM
    columns, rows = np.ceil((high - low) / PIXEL_MM).astype(int) + 1
    heights = np.full((int(rows), int(columns)), -np.inf)
    corners[:, :, :2] = (corners[:, :, :2] - low) / PIXEL_MM
    first = np.ceil(corners[:, :, :2].min(axis=1)).astype(np.int64)
    sizes = np.floor(corners[:, :, :2].max(axis=1)).astype(np.int64) - first + 1
    covers = (sizes > 0).all(axis=1) & (np.cross(*sides(corners))[:, 2] > _FLAT)
    corners, first, sizes = corners[covers], first[covers], sizes[covers]
    for part in parts_of(sizes.prod(axis=1), _CHUNK):
        _raise(heights, corners[part], first[part], sizes[part])
    return low, heights


def _raise(heights: Points, corners: Points, first: Indices, sizes: Indices) -> None:
    """Raise a buffer to triangles that look to the viewer.

    Args:
        heights: the buffer; it changes.
        corners: of the triangles, x and y in pixels.
        first: column and row at the lower left of the box round each, shape `(n, 2)`.
        sizes: columns and rows of that box, shape `(n, 2)`.
    """
    counts = sizes.prod(axis=1)
    of, place = np.repeat(np.arange(len(counts)), counts), counted(counts)
    x = first[of, 0] + place % sizes[of, 0]
    y = first[of, 1] + place // sizes[of, 0]
    (x0, y0, z0), (x1, y1, z1), (x2, y2, z2) = corners[of].transpose(1, 2, 0)
    area = (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)
    one = ((x - x0) * (y2 - y0) - (y - y0) * (x2 - x0)) / area
    two = ((x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)) / area
    within = (one >= -1e-9) & (two >= -1e-9) & (one + two <= 1 + 1e-9)
    z = z0 + one * (z1 - z0) + two * (z2 - z0)
    np.maximum.at(heights, (y[within], x[within]), z[within])


def sides(corners: Points) -> tuple[Points, Points]:
    """Two sides of each triangle, from its first corner."""
    return corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]


def counted(counts: Indices) -> Indices:
    """0, 1, 2 … for each count, one after the other."""
    return np.arange(int(counts.sum())) - np.repeat(np.cumsum(counts) - counts, counts)


def parts_of(sizes: NDArray[np.generic], most: int) -> list[Indices]:
    """Places in a list, in parts of which the sizes sum up to about `most`."""
    breaks = np.flatnonzero(np.diff(np.cumsum(sizes) // most)) + 1
    return np.split(np.arange(len(sizes)), breaks)
