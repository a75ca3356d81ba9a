"""Shaded pictures of solids: what both have in grey, what one alone has in its colour, seen through
what hides it."""

import io
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.depths import counted, parts_of
from lumitip_fab.scenes.drawing import SHARP_DEG, View, view

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
COLOURS = {"both": (150, 158, 168), "a": (214, 96, 20), "b": (30, 110, 200)}
VIEWS = (view(-35, 28), view(145, -28))
"""From the front above, and from behind below."""
_SIZE_PX, _FINER = (440, 340), 2
_MARGIN = 0.04  # of the picture, each side
_LIGHT = np.array([-0.35, 0.45, 0.82])  # on the page: from the left, from above
_NEARER_MM = 0.01  # by which a difference must lie before the rest: surfaces of both are the rest's
_THICK_MM = 0.02  # of a difference along the line of sight: less is rounding of surfaces of both
_FLAT = 1e-9  # twice the area of a triangle that covers nothing, in pixels
_HIDDEN = 0.6  # opacity of a difference behind the rest
_CHUNK = 1_000_000  # pixels of triangles at a time
_EDGE = 0.45  # of the brightness, on lines
_STEP_SHARE = 0.012  # of the picture's width in mm: a step in depth that is drawn as a line


def pictures(bodies: Mapping[str, Mesh]) -> list[bytes]:
    """PNG of each of `VIEWS`, without background; the same bytes for the same bodies.

    Args:
        bodies: by `"both"`, `"a"` and `"b"`; at least one.
    """
    return [_picture(bodies, seen_by) for seen_by in VIEWS]


def _picture(bodies: Mapping[str, Mesh], seen_by: View) -> bytes:
    points = {name: seen_by.seen(mesh.points_mm) for name, mesh in bodies.items()}
    together = np.concatenate(list(points.values()))[:, :2]
    low, high = together.min(axis=0), together.max(axis=0)
    size = np.array(_SIZE_PX) * _FINER
    scale = float(((1 - 2 * _MARGIN) * size / np.maximum(high - low, 1e-6)).min())
    shift = size / 2 - scale * (low + high) / 2
    colour = np.zeros((size[1], size[0], 3))
    depth = np.full((size[1], size[0]), -np.inf)
    for name in ("both", "a", "b"):
        if name not in bodies:
            continue
        corners = points[name][bodies[name].triangles]
        nearest, normal, through = _seen(corners * (scale, scale, 1.0) + (*shift, 0.0), depth.shape)
        there = np.isfinite(nearest) & ((through > _THICK_MM) | (name == "both"))
        own = _brightness(nearest, normal, _STEP_SHARE * size[0] / scale)[..., None]
        own = own * np.array(COLOURS[name])
        before = there & (nearest > depth + _NEARER_MM)
        hidden = there & ~before
        colour[before] = own[before]
        colour[hidden] += _HIDDEN * (own[hidden] - colour[hidden])
        depth[before] = nearest[before]
    shown = np.dstack([colour, 255.0 * np.isfinite(depth)])[::-1].clip(0, 255).astype(np.uint8)
    file = io.BytesIO()
    Image.fromarray(shown, "RGBA").reduce(_FINER).save(file, "png", optimize=True)
    return file.getvalue()


def _seen(corners: Array, shape: tuple[int, ...]) -> tuple[Array, Array, Array]:
    """The nearest surface of a body in each pixel.

    Args:
        corners: of its triangles, shape `(n, 3, 3)`: x and y in pixels, height above the page (mm).
        shape: rows and columns.

    Returns:
        Height of the nearest point (mm), minus infinity where there is none; the unit normal there,
        shape `(*shape, 3)`; and the length in the material along the line of sight (mm).
    """
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    kept = np.abs(across[:, 2]) > _FLAT
    corners, across = corners[kept], across[kept]
    count = int(np.prod(shape))
    nearest, through = np.full(count, -np.inf), np.zeros(count)
    seen = np.full(count, -1)
    rows = _lengths(corners[:, :, 1])
    for part in parts_of(rows[1] * np.ptp(corners[:, :, 0], axis=1), _CHUNK):
        triangle, x, y = _pixels(corners, across, part)
        start, normal = corners[triangle, 0], across[triangle]
        off = normal[:, 0] * (x - start[:, 0]) + normal[:, 1] * (y - start[:, 1])
        z, at = start[:, 2] - off / normal[:, 2], y * shape[1] + x
        np.add.at(through, at, np.sign(normal[:, 2]) * z)
        np.maximum.at(nearest, at, z)
        first = z == nearest[at]
        seen[at[first]] = triangle[first]
    normals = np.zeros((count, 3))
    hit = seen >= 0
    normals[hit] = across[seen[hit]] / np.linalg.norm(across[seen[hit]], axis=1, keepdims=True)
    return nearest.reshape(shape), normals.reshape(*shape, 3), through.reshape(shape)


def _pixels(corners: Array, across: Array, part: Indices) -> tuple[Indices, Indices, Indices]:
    """Triangle, column and row of each pixel whose centre lies in one of some triangles; one on a
    common edge of two lies in one of them."""
    first, count = _lengths(corners[part, :, 1])
    line = np.repeat(np.arange(len(part)), count)
    y = first[line] + counted(count)
    low, high = np.full(len(y), -np.inf), np.full(len(y), np.inf)
    turn = np.sign(across[part, 2])
    for one, other in ((0, 1), (1, 2), (2, 0)):
        start, side = corners[part, one], corners[part, other] - corners[part, one]
        rise = (side[:, 1] * turn)[line]
        with np.errstate(divide="ignore", invalid="ignore"):
            x = start[line, 0] + (y - start[line, 1]) * (side[:, 0] / side[:, 1])[line]
        low = np.where(rise < 0, np.maximum(low, x), low)
        high = np.where(rise > 0, np.minimum(high, x), high)
    left, width = _lengths(np.stack([low, high], axis=1))
    pixel = np.repeat(np.arange(len(y)), width)
    return part[line[pixel]], left[pixel] + counted(width), y[pixel]


def _lengths(ends: Array) -> tuple[Indices, Indices]:
    """First whole number, and how many there are, from the least to below the largest of ends."""
    first, last = np.ceil(ends.min(axis=1)), np.ceil(ends.max(axis=1))
    return first.astype(np.int64), (last - first).astype(np.int64)


def _brightness(depth: Array, normal: Array, step_mm: float) -> Array:
    """Lambert's law with some light from everywhere; dark lines on sharp edges and contours."""
    bright = 0.62 + 0.48 * (normal @ (_LIGHT / np.linalg.norm(_LIGHT))).clip(0.0)
    filled = np.where(np.isfinite(depth), depth, -1e6)
    line = np.zeros(depth.shape, dtype=bool)
    for axis, by in ((0, 1), (0, -1), (1, 1), (1, -1)):
        beside, turned = np.roll(filled, by, axis), np.roll(normal, by, axis)
        sharp = (normal * turned).sum(axis=2) < np.cos(np.radians(SHARP_DEG))
        line |= (filled - beside > step_mm) | (sharp & (beside > -1e6))
    return np.asarray(np.where(line, bright * _EDGE, bright))
