"""Distances of rectangles, for the tests of what must not collide."""

import math

from lumitip_fab.design import Box, Point


def gap_mm(a: Box, b: Box) -> float:
    """Distance between two boxes; below zero where they overlap."""
    dx = max(a.x_min_mm - b.x_max_mm, b.x_min_mm - a.x_max_mm)
    dy = max(a.y_min_mm - b.y_max_mm, b.y_min_mm - a.y_max_mm)
    return math.hypot(max(dx, 0), max(dy, 0)) if max(dx, dy) > 0 else max(dx, dy)


def inside_mm(inner: Box, outer: Box) -> float:
    """Least distance from a box to the sides of the one around it; below zero outside."""
    return min(
        inner.x_min_mm - outer.x_min_mm,
        outer.x_max_mm - inner.x_max_mm,
        inner.y_min_mm - outer.y_min_mm,
        outer.y_max_mm - inner.y_max_mm,
    )


def round_box(at: Point, across_mm: float) -> Box:
    return Box(at[0], at[0], at[1], at[1]).grown(across_mm / 2)


def from_point_mm(box: Box, at: Point) -> float:
    return gap_mm(box, Box(at[0], at[0], at[1], at[1]))
