"""Areas of a board as paths of an SVG, in mm with y down."""

from collections.abc import Iterable

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

ROUND = 16  # chords of a quarter circle


def disc(x_mm: float, y_mm: float, diameter_mm: float, chords: int = ROUND) -> Polygon:
    """A round area, of so many chords in each quarter."""
    return shapely.Point(x_mm, y_mm).buffer(diameter_mm / 2, quad_segs=chords)


def mirrored(area: BaseGeometry) -> BaseGeometry:
    """An area as it is seen from the back."""
    return shapely.transform(area, lambda at: at * (-1, 1))


def polygons(area: BaseGeometry) -> list[Polygon]:
    """The pieces of an area."""
    return [piece for piece in shapely.get_parts(area) if piece.geom_type == "Polygon"]


def rings(polygon: Polygon) -> list[NDArray[np.float64]]:
    """Corners of the outer ring and of those inside, each shape `(n, 2)`, the first again last."""
    return [shapely.get_coordinates(ring) for ring in (polygon.exterior, *polygon.interiors)]


def path_of(area: BaseGeometry, decimals: int) -> str:
    """All rings of an area."""
    return "".join(_closed(ring, decimals) for piece in polygons(area) for ring in rings(piece))


def corners(points: Iterable[tuple[float, float]], decimals: int) -> str:
    """A line from point to point."""
    return "M" + "L".join(f"{short(x, decimals)} {short(-y, decimals)}" for x, y in points)


def short(value: float, decimals: int) -> str:
    """A rounded number, never `-0`."""
    return f"{round(value, decimals) + 0.0:g}"


def _closed(ring: NDArray[np.float64], decimals: int) -> str:
    return corners(((x, y) for x, y in ring[:-1]), decimals) + "Z"
