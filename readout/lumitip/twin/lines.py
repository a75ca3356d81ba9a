"""Distance from lines and arcs: plain arithmetic, for numbers and for arrays of lines alike."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.floating[Any]]
"""Floats of any precision: rasters are single, tables double."""
Each = float | Numbers
"""A number, or one for each line, broadcast with the places."""


def from_foot(
    x_mm: Numbers, y_mm: Numbers, offset_mm: Each, cos: Each, sin: Each
) -> tuple[Numbers, Numbers, Numbers]:
    """Distance left of a line, and x and y from its point nearest the origin (mm).

    Args:
        x_mm, y_mm: places (mm).
        offset_mm: of the line along its left normal (mm).
        cos, sin: of its direction.
    """
    left = y_mm * cos - x_mm * sin - offset_mm
    return left, x_mm + offset_mm * sin, y_mm - offset_mm * cos


def from_arc(left: Numbers, x: Numbers, y: Numbers, bend: Each) -> Numbers:
    """Distance left of the arc that touches a line at its foot, in a form that stays exact for
    large radii (mm).

    Args:
        left, x, y: of `from_foot` (mm).
        bend: one over the radius, positive to the left (1/mm).
    """
    square = x * x + y * y
    rest = np.sqrt(np.maximum(1.0 - 2.0 * bend * left + (bend * bend) * square, 0.0))
    away: Numbers = (2.0 * left - bend * square) / (1.0 + rest)
    return away


def square_from_segment(
    x_mm: Numbers, y_mm: Numbers, begin: tuple[float, float], end: tuple[float, float]
) -> Numbers:
    """Square of the distance of places from a segment (mm²). Its ends are plain numbers: with
    numpy's own, places in single precision would become double.

    Args:
        x_mm, y_mm: places (mm).
        begin, end: of the segment (mm).
    """
    dx, dy, x, y = end[0] - begin[0], end[1] - begin[1], x_mm - begin[0], y_mm - begin[1]
    share = np.clip((x * dx + y * dy) / max(dx * dx + dy * dy, 1e-18), 0.0, 1.0)
    square: Numbers = (x - share * dx) ** 2 + (y - share * dy) ** 2
    return square


def beside_arc(x: Numbers, y: Numbers, bend: Each, cos: Each, sin: Each) -> Numbers:
    """Direction of that arc beside each place (degrees)."""
    beside: Numbers = np.degrees(np.arctan2(bend * x + sin, cos - bend * y))
    return beside
