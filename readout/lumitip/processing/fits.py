"""Least-squares fits of line, corner and cable to the markers, in closed form from their moments.

    line                corner                  cable
    light               light                   light
    ---o----o---o---    ----o---o---.           ---o----o---o--- border
    dark                dark         o          dark             axis
                                      o         ---o----o---o--- border
                                       o light  light

Points are complex numbers x + iy (mm). The sum of their squares about the mean has twice the
direction of largest scatter as its phase; with the sum of squared distances it gives the line of
total least squares.

For two rays the markers are ordered along the border and cut in two where the lines of both parts
leave the smallest sum of squares. Every cut is tried, from running sums.
"""

import math
from cmath import phase
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lumitip.grid import Floats, Integers
from lumitip.processing.contact import Cable, Corner, Line, Point

Points = NDArray[np.complex128]

_RAY_MARKERS = 3  # a ray always fits two markers exactly
_BORDER_MARKERS = 2
_SAME_RAD = 1e-9  # rounding differences between two equal gaps are smaller
_CABLE_ROUNDS = 2  # the second moves markers to the other border in few frames only


class Border:
    """Markers of one frame, and the sides of the border."""

    __slots__ = ("dark", "light", "markers", "mean", "moments", "outward", "size", "squares")

    def __init__(self, markers: Points, outward: Points, dark: complex, light: complex) -> None:
        """Compute the moments that all fits need.

        Args:
            markers: shape `(k,)` (mm).
            outward: from the dark to the light cell of each marker, all of one length, `(k,)`.
            dark: mean of the dark cells (mm).
            light: mean of the other cells (mm).
        """
        self.outward, self.dark, self.light = outward, dark, light
        self.mean = complex(np.add.reduce(markers)) / max(markers.size, 1)
        self.moments: Points = np.empty((2, markers.size), dtype=np.complex128)
        """Each marker relative to their mean, and its square, shape `(2, k)`."""
        self.markers: Points = np.subtract(markers, self.mean, out=self.moments[0])
        np.multiply(self.markers, self.markers, out=self.moments[1])
        self.squares = complex(np.add.reduce(self.moments[1]))
        """Sum of the squares as complex numbers (mm²)."""
        self.size = float(np.vdot(self.markers, self.markers).real)
        """Sum of the squared distances from the mean (mm²)."""


class _Parts:
    """Moments of two parts of the markers, each about its own mean.

    The markers are relative to the mean of all, so the sums of both parts cancel.
    """

    __slots__ = ("counts", "means", "size", "squares")

    def __init__(self, border: Border, count: int, total: complex, squares: complex) -> None:
        """Take the number of markers of one part, their sum, and the sum of their squares."""
        rest = border.markers.size - count
        here, there = total / count, -total / rest
        self.counts = count, rest
        self.means = here, there
        self.squares = squares - total * here, border.squares - squares + total * there
        """Sum of the squares as complex numbers (mm²)."""
        self.size = border.size - (total * (here - there).conjugate()).real
        """Sum of the squared distances of all markers, each to the mean of its part (mm²)."""

    @property
    def together(self) -> complex:
        """Sum of the squares of all markers, each about the mean of its part (mm²)."""
        return self.squares[0] + self.squares[1]


def _along_scatter(squares: complex) -> float:
    """Direction of largest scatter, in (−π/2, π/2] (rad)."""
    return phase(squares) / 2.0


def _rms(size: float, along: float, count: int) -> float:
    """Root mean square distance of points to the lines along their largest scatter."""
    return math.sqrt(max(size - along, 0.0) / (2 * count))


def point(at: complex) -> Point:
    """`(x, y)` of a point of the complex plane."""
    return at.real, at.imag


def fit_line(border: Border) -> Line | None:
    """Line of total least squares; `None` if the markers have no main direction."""
    count, along = border.markers.size, abs(border.squares)
    if count < 2 or along <= 1e-9 * border.size:
        return None
    angle_deg = _half_turn_deg(_along_scatter(border.squares))
    return Line(point(border.mean), angle_deg, _rms(border.size, along, count))


def fit_rays(border: Border) -> tuple[Corner | None, Cable | None]:
    """Corner of two rays, and cable of two parallel borders, of least squares.

    Returns:
        The corner, `None` with fewer than three markers for each ray or with parallel rays; the
        cable, `None` without two borders of two markers each that face away from the dark cells.
    """
    if border.markers.size < 2 * _RAY_MARKERS:
        return None, None
    rays = _cut(border)
    return _corner(border, rays), _cable(border, rays)


def _cut(border: Border) -> _Parts:
    """Two parts of the markers whose lines leave the smallest sum of squares."""
    sizes = _sizes(border.markers.size)
    running = np.add.accumulate(border.moments[:, _along(border)], axis=1)
    totals, squares = running[:, _RAY_MARKERS - 1 : -_RAY_MARKERS]
    # The sum of squares is least where the scatter along both lines is largest.
    about = totals * totals / sizes
    along = np.abs(about)
    about[0] -= squares
    about[1] -= border.squares - squares
    along += np.abs(about)
    at = int((along[0] + along[1]).argmax())
    return _Parts(border, _RAY_MARKERS + at, complex(totals[at]), complex(squares[at]))


@lru_cache(maxsize=128)
def _sizes(markers: int) -> Floats:
    """Sizes of both parts for every cut, shape `(2, cuts)`."""
    before = np.arange(_RAY_MARKERS, markers - _RAY_MARKERS + 1, dtype=np.float64)
    sizes = np.array((before, markers - before))
    sizes.flags.writeable = False
    return sizes


def _along(border: Border) -> Integers:
    """Indices of the markers in their order along the border.

    They are sorted by their angle about the middle of the convex side, from which each direction
    meets a border of two rays once. They begin after the widest gap. Gaps are often equal, since
    markers lie on the lines between cells; then after the one whose markers are farthest apart.
    """
    # Outward directions diverge if the dark side is convex.
    convex = np.vdot(border.markers, border.outward).real >= 0.0
    seen = border.markers - ((border.dark if convex else border.light) - border.mean)
    around = np.arctan2(seen.imag, seen.real)
    order = around.argsort()
    around = around[order]
    gaps = np.empty_like(around)
    np.subtract(around[1:], around[:-1], out=gaps[:-1])
    gaps[-1] = around[0] + 2.0 * math.pi - around[-1]
    begin = (gaps > gaps.max() - _SAME_RAD).nonzero()[0] + 1
    if begin.size > 1:
        apart = np.abs(seen[order[begin % order.size]] - seen[order[begin - 1]])
        begin = begin[apart.argmax() :]
    return np.concatenate((order[begin[0] :], order[: begin[0]]))


def _corner(border: Border, rays: _Parts) -> Corner | None:
    one, two = _along_scatter(rays.squares[0]), _along_scatter(rays.squares[1])
    crossing = math.sin(two - one)
    if abs(crossing) < 1e-9:
        return None
    first, second = rays.means
    apart = second - first
    far = (apart.real * math.sin(two) - apart.imag * math.cos(two)) / crossing
    vertex = first + far * _unit(one)
    one, two = phase(first - vertex), phase(second - vertex)
    turn = (two - one) % (2.0 * math.pi)
    if turn > math.pi:
        one, two, turn = two, one, 2.0 * math.pi - turn
    along = abs(rays.squares[0]) + abs(rays.squares[1])
    return Corner(
        vertex_mm=point(border.mean + vertex),
        directions_deg=(_whole_turn_deg(one), _whole_turn_deg(two)),
        opening_deg=math.degrees(turn),
        rms_mm=_rms(rays.size, along, border.markers.size),
    )


def _cable(border: Border, rays: _Parts) -> Cable | None:
    """Parallel borders; their common direction comes from the scatter about the mean of each.

    The rays give the initial direction. Then each marker belongs to the border on the side of its
    light cell.
    """
    count, borders = border.markers.size, rays
    for _ in range(_CABLE_ROUNDS):
        upper = (border.outward * _unit(-_along_scatter(borders.together))).imag > 0.0
        above = int(np.count_nonzero(upper))
        if not _BORDER_MARKERS <= above <= count - _BORDER_MARKERS:
            return None
        borders = _Parts(border, above, *border.moments.dot(upper).tolist())
    angle = _along_scatter(borders.together)
    turned = _unit(-angle)
    top, bottom = (borders.means[0] * turned).imag, (borders.means[1] * turned).imag
    if top <= bottom:
        return None
    return Cable(
        axis_point_mm=point(border.mean + (top + bottom) / 2.0 * 1j * _unit(angle)),
        angle_deg=_half_turn_deg(angle),
        width_mm=top - bottom,
        rms_mm=_rms(borders.size, abs(borders.together), count),
    )


def _unit(angle: float) -> complex:
    return complex(math.cos(angle), math.sin(angle))


def _half_turn_deg(angle: float) -> float:
    """Direction of a line, in (−90, 90]."""
    degrees = math.degrees(angle)
    return degrees + 180.0 if degrees <= -90.0 else degrees


def _whole_turn_deg(angle: float) -> float:
    """Direction of a ray, in (−180, 180]."""
    degrees = math.degrees(angle)
    return degrees + 360.0 if degrees <= -180.0 else degrees
