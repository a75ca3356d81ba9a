"""The outlines of the cells: a hexagon round each, flats to the tip, edges shared."""

import math
from collections.abc import Sequence

from shapely import LineString

from lumitip_fab.design import Point


def cell_edges(cells: Sequence[Point], pitch_mm: float) -> list[LineString]:
    """Every edge of the hexagons once, in the order of the cells."""
    around = [
        (pitch_mm / math.sqrt(3) * math.cos(math.radians(60 * k)),
         pitch_mm / math.sqrt(3) * math.sin(math.radians(60 * k)))
        for k in range(6)
    ]  # fmt: skip
    found: dict[Point, LineString] = {}
    for x, y in cells:
        corners = [(x + dx, y + dy) for dx, dy in around]
        for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
            middle = (
                round((start[0] + end[0]) / 2, 3) + 0.0,
                round((start[1] + end[1]) / 2, 3) + 0.0,
            )
            found.setdefault(middle, LineString([start, end]))
    return list(found.values())
