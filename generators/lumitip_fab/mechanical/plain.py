"""Plain bodies that stand for what is bought, as surfaces of triangles."""

import math

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.mechanical.surface import Mesh

SECTIONS = 96
"""Chords of a whole circle."""


def disc(diameter_mm: float, low_mm: float, high_mm: float) -> Mesh:
    """A cylinder round z."""
    return _prism(_ring(diameter_mm / 2), low_mm, high_mm)


def block(
    x_mm: tuple[float, float],
    y_mm: tuple[float, float],
    corner_mm: float,
    low_mm: float,
    high_mm: float,
) -> Mesh:
    """A block, its edges along z rounded."""
    quarter = SECTIONS // 4
    outline = []
    for k, (right, top) in enumerate(((1, 1), (0, 1), (0, 0), (1, 0))):
        centre = (x_mm[right] + corner_mm * (1 - 2 * right), y_mm[top] + corner_mm * (1 - 2 * top))
        for step in range(quarter + 1 if corner_mm else 1):
            turn = math.pi / 2 * (k + step / quarter)
            outline.append((centre[0] + corner_mm * math.cos(turn),
                            centre[1] + corner_mm * math.sin(turn)))  # fmt: skip
    rounded = np.round(np.array(outline), 9)
    distinct = np.abs(rounded - np.roll(rounded, 1, axis=0)).max(axis=1) > 1e-6
    return _prism(rounded[distinct], low_mm, high_mm)


def socket(diameter_mm: float, recess_mm: float, height_mm: float, depth_mm: float) -> Mesh:
    """A cylinder round z from z = 0, with a round recess in its top."""
    outer, inner = _ring(diameter_mm / 2), _ring(recess_mm / 2)
    floor = height_mm - depth_mm
    rings = [_at(outer, 0.0), _at(outer, height_mm), _at(inner, height_mm), _at(inner, floor)]
    n = len(outer)
    walls = [wall for k in range(3) for wall in _band(k * n, (k + 1) * n, n)]
    triangles = [*walls, *_fan(0, n)[:, ::-1].tolist(), *_fan(3 * n, n).tolist()]
    return Mesh(np.concatenate(rings), np.array(triangles, dtype=np.int64))


def _prism(outline: NDArray[np.float64], low_mm: float, high_mm: float) -> Mesh:
    """A convex outline, counter-clockwise, along z."""
    n = len(outline)
    triangles = [*_band(0, n, n), *_fan(0, n)[:, ::-1].tolist(), *_fan(n, n).tolist()]
    points = np.concatenate([_at(outline, low_mm), _at(outline, high_mm)])
    return Mesh(points, np.array(triangles, dtype=np.int64))


def _ring(radius_mm: float) -> NDArray[np.float64]:
    turn = np.arange(SECTIONS) * (2 * math.pi / SECTIONS)
    return np.column_stack([radius_mm * np.cos(turn), radius_mm * np.sin(turn)])


def _at(outline: NDArray[np.float64], z_mm: float) -> NDArray[np.float64]:
    return np.column_stack([outline, np.full(len(outline), z_mm)])


def _fan(first: int, n: int) -> NDArray[np.int64]:
    """Triangles over a convex ring of corners, seen from +z counter-clockwise."""
    return np.array([(first, first + k, first + k + 1) for k in range(1, n - 1)])


def _band(low: int, high: int, n: int) -> list[tuple[int, int, int]]:
    """Triangles between two rings of corners, from the outside if the second is above."""
    corners = [(k, (k + 1) % n) for k in range(n)]
    return [t for a, b in corners
            for t in ((low + a, low + b, high + b), (low + a, high + b, high + a))]  # fmt: skip
