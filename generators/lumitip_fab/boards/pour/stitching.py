"""Vias that join the pour of the two sides."""

import math
from collections.abc import Iterable

import numpy as np
import shapely
from shapely import Geometry

from lumitip_fab.boards.model import NetClass, Placement, Via
from lumitip_fab.boards.pour.room import MARGIN_MM
from lumitip_fab.boards.verify import DRILL_WALL_MM
from lumitip_fab.design import Point

LATTICE_MM = 0.5  # places tried
APART_MM = 6.0  # between stitching vias, where there is room


def candidates(placement: Placement, room: Geometry, front: Geometry, back: Geometry) -> list[Via]:
    """Vias that could join a piece of pour on the front with one on the back.

    Args:
        placement: the board.
        room: where the middle of a via may be.
        front: pour of one side.
        back: pour of the other.
    """
    both = shapely.intersection(shapely.intersection(front, back), room)
    places: list[Point] = []
    for part in shapely.get_parts(both):
        if part.area < 1e-6:
            continue
        inside = part.representative_point()
        places += _lattice(part) or [(round(inside.x, 3), round(inside.y, 3))]
    kind = _kind(placement)
    return [
        Via(placement.ground, x, y, kind.via_mm, kind.via_drill_mm)
        for x, y in spread(places, (), kind.via_drill_mm + DRILL_WALL_MM + MARGIN_MM)
    ]


def spread(places: Iterable[Point], taken: Iterable[Point], apart_mm: float) -> list[Point]:
    """Places in their order, without those too near to one before them or to a taken one."""
    grid: dict[tuple[int, int], list[Point]] = {}

    def cell(at: Point) -> tuple[int, int]:
        return math.floor(at[0] / apart_mm), math.floor(at[1] / apart_mm)

    for at in taken:
        grid.setdefault(cell(at), []).append(at)
    found = []
    for at in places:
        column, row = cell(at)
        near = (
            other
            for u in (column - 1, column, column + 1)
            for v in (row - 1, row, row + 1)
            for other in grid.get((u, v), ())
        )
        if all(math.dist(at, other) >= apart_mm for other in near):
            grid.setdefault((column, row), []).append(at)
            found.append(at)
    return found


def _kind(placement: Placement) -> NetClass:
    """The class whose vias are smallest."""
    return min(placement.classes, key=lambda c: c.via_mm)


def _lattice(part: Geometry) -> list[Point]:
    """Whole multiples of the lattice inside an area."""
    x_min, y_min, x_max, y_max = part.bounds
    x = np.arange(math.ceil(x_min / LATTICE_MM), math.floor(x_max / LATTICE_MM) + 1) * LATTICE_MM
    y = np.arange(math.ceil(y_min / LATTICE_MM), math.floor(y_max / LATTICE_MM) + 1) * LATTICE_MM
    if not (x.size and y.size):
        return []
    across, along = (a.ravel() for a in np.meshgrid(x, y))
    shapely.prepare(part)
    inside = shapely.contains_xy(part, across, along)
    return list(zip(across[inside].tolist(), along[inside].tolist(), strict=True))
