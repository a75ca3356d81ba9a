"""How far two surfaces lie apart."""

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from lumitip_fab.checks.readers.solids import Vectors

_SAME_MM = 0.001  # a point of both
_BLOCK, _MOST = 2000, 2_000_000  # points at a time, and pairs with triangles near them
_EDGES = ((0, 1), (1, 2), (2, 0))


def surfaces_apart_mm(one: Vectors, other: Vectors, near_mm: float) -> float:
    """Farthest distance of a point of one surface to the other, either way (mm).

    It is taken at the corners and in the middle of the triangles, so a hole, a pocket or a pin
    that one of them lacks is seen by the other's triangles.

    Args:
        one: triangles, shape `(n, 3, 3)`.
        other: triangles of the other surface.
        near_mm: up to this it is exact; beyond, it is that to the nearest of those points.
    """
    if one.shape == other.shape and (apart := float(np.abs(one - other).max())) <= _SAME_MM:
        return apart  # corner by corner, which is most of all files
    pairs = (one, other), (other, one)
    return max(float(_off(a, b, near_mm).max(initial=0.0)) for a, b in pairs)


def volume_mm3(triangles: Vectors) -> float:
    """Volume inside a closed surface; below zero if it looks inwards."""
    a, b, c = (triangles[:, k] for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def _points(triangles: Vectors) -> Vectors:
    points = np.concatenate([triangles.reshape(-1, 3), triangles.mean(axis=1)]).round(5) + 0.0
    rows = points.view(f"V{points.itemsize * 3}").ravel()  # as bytes: ten times as fast
    return np.unique(rows).view(np.float64).reshape(-1, 3)


def _off(one: Vectors, other: Vectors, near_mm: float) -> Vectors:
    """Distance of the points of one surface to the other, shape `(n,)`."""
    points = _points(one)
    off = cKDTree(_points(other)).query(points)[0]
    left = np.flatnonzero(off > _SAME_MM)
    low, high = other.min(axis=1) - near_mm, other.max(axis=1) + near_mm
    i, j, k = np.argsort((high - low).mean(axis=0))  # the tree parts them where they are short
    tree = shapely.STRtree(shapely.box(low[:, i], low[:, j], high[:, i], high[:, j]))
    for block in np.array_split(left, len(left) // _BLOCK + 1):
        point, triangle = tree.query(shapely.points(points[block][:, [i, j]]))
        height = points[block[point], k]
        meet = (height >= low[triangle, k]) & (height <= high[triangle, k])
        point, triangle = block[point[meet]], triangle[meet]
        if len(point) > _MOST:
            continue  # triangles in disorder: the distance to the nearest point stands
        np.minimum.at(off, point, _distance(points[point], other[triangle]))
    return np.asarray(off)


def _distance(points: Vectors, triangles: Vectors) -> Vectors:
    """Distance of each point to its triangle, shape `(n,)`."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    normals = normals / np.where(lengths > 0, lengths, 1.0)[:, None]
    to_edges = np.full(len(points), np.inf)
    above: NDArray[np.bool_] = lengths > 0
    for i, j in _EDGES:
        along, start = triangles[:, j] - triangles[:, i], points - triangles[:, i]
        share = _dot(start, along) / np.maximum(_dot(along, along), 1e-30)
        foot = start - np.clip(share, 0.0, 1.0)[:, None] * along
        to_edges = np.minimum(to_edges, np.linalg.norm(foot, axis=1))
        above &= _dot(np.cross(along, start), normals) >= 0
    to_plane = np.abs(_dot(points - triangles[:, 0], normals))
    return np.where(above, to_plane, to_edges)


def _dot(a: Vectors, b: Vectors) -> Vectors:
    return np.asarray(np.einsum("ij,ij->i", a, b))
