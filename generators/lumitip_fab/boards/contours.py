"""Areas with holes as single closed lines, as KiCad's files and Gerber regions want them."""

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import LinearRing, Polygon
from shapely.geometry.polygon import orient

from lumitip_fab.design import Point

Corners = NDArray[np.float64]
_NM = 6  # decimals: everything is rounded to 1 nm before it is cut, so that cuts coincide


def fractured(area: Polygon) -> tuple[Point, ...]:
    """The corners of one closed line round an area, clockwise, the first not repeated.

    Each hole is joined by a cut of no width, along x, from its leftmost corner to what lies left
    of it. In KiCad 6, a fill that winds the other way connects nothing.
    """
    area = orient(area, -1.0)
    line = _corners(area.exterior)
    holes = [_from_leftmost(_corners(ring)) for ring in area.interiors]
    for hole in sorted(holes, key=lambda corners: tuple(corners[0])):
        line = _joined(line, hole)
    return tuple((float(x), float(y)) for x, y in line)


def _corners(ring: LinearRing) -> Corners:
    """Rounded corners of shape `(n, 2)`, those that fall together told once."""
    rounded = np.round(shapely.get_coordinates(ring)[:-1], _NM) + 0.0
    return np.asarray(rounded[(rounded != np.roll(rounded, 1, axis=0)).any(axis=1)])


def _from_leftmost(corners: Corners) -> Corners:
    return np.roll(corners, -int(np.lexsort((corners[:, 1], corners[:, 0]))[0]), axis=0)


def _joined(line: Corners, hole: Corners) -> Corners:
    """The line with a way to the hole, round it, and back."""
    x, y = hole[0]
    a, b = line, np.roll(line, -1, axis=0)
    level = a[:, 1] == b[:, 1]
    share = (y - a[:, 1]) / np.where(level, 1.0, b[:, 1] - a[:, 1])
    at = np.round(a[:, 0] + (b[:, 0] - a[:, 0]) * share, _NM)
    met = ~level & (share >= 0) & (share <= 1) & (at <= x)
    before = int(np.where(met, at, -np.inf).argmax())
    foot = np.array([(at[before], y)])
    way_in = foot if (foot[0] != a[before]).any() else foot[:0]
    way_out = foot if (foot[0] != b[before]).any() else foot[:0]
    return np.concatenate([line[: before + 1], way_in, hole, hole[:1], way_out, line[before + 1 :]])
