"""Line, corner and cable closest to the markers: closed forms over their moments.

    line                corner                  cable
    light               light                   light
    ---o----o---o---    ----o---o---.           ---o----o---o--- border
    dark                dark         o          dark             axis
                                      o         ---o----o---o--- border
                                       o light  light

Points are complex numbers x + iy (mm): the sum of squares about the mean, whose phase is twice the
direction of largest scatter, and the sum of squared distances give a line of total least squares.

The markers in the order in which they stand along the border are cut in two where the lines of
both parts leave the smallest sum of squares: two rays. Every cut is tried, from running sums.
"""

import math
from cmath import phase
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lumitip.grid import Integers
from lumitip.processing.contact import Cable, Corner, Line, Point

Points = NDArray[np.complex128]

_RAY_MARKERS = 3  # with two a ray fits any two markers exactly, and says nothing
_BORDER_MARKERS = 2
_CABLE_ROUNDS = 2  # the second changes which border a marker belongs to in few frames only


class Border:
    """The markers of one frame, and where the dark is."""

    __slots__ = ("dark", "light", "markers", "mean", "moments", "outward", "sums")

    def __init__(self, markers: Points, outward: Points, dark: complex, light: complex) -> None:
        """Take the moments that all fits need.

        Args:
            markers: shape `(k,)` (mm).
            outward: from the dark to the light cell of each marker, all of one length, `(k,)`.
            dark: mean of the dark cells' centres (mm).
            light: mean of the other cells' centres (mm).
        """
        self.outward, self.dark, self.light = outward, dark, light
        self.mean = complex(np.add.reduce(markers)) / max(markers.size, 1)
        self.markers: Points = markers - self.mean
        """Relative to their mean."""
        z = self.markers
        self.moments: Points = np.array((z, z * z, z * z.conj()))
        """Each marker, its square and its squared distance, shape `(3, k)`."""
        self.sums: list[complex] = np.add.reduce(self.moments, axis=1).tolist()


@dataclass(slots=True)
class _Scatter:
    """Points about their mean."""

    count: int
    mean: complex
    squares: complex
    """Sum of the squares as complex numbers (mm²)."""
    size: float
    """Sum of the squared distances (mm²)."""

    @classmethod
    def of(cls, count: int, total: complex, squares: complex, size: complex) -> "_Scatter":
        """From the sums of the moments of so many points."""
        mean = total / count
        about_mean = (size - total * mean.conjugate()).real
        return cls(count, mean, squares - total * mean, about_mean)

    def with_other(self, other: "_Scatter") -> "_Scatter":
        """Of both, each about its own mean."""
        squares, size = self.squares + other.squares, self.size + other.size
        return _Scatter(self.count + other.count, 0.0, squares, size)

    @property
    def angle(self) -> float:
        """Direction of largest scatter, in (−π/2, π/2] (rad)."""
        return phase(self.squares) / 2.0

    @property
    def across(self) -> float:
        """Sum of squared distances to the line of that direction through the mean (mm²)."""
        return max((self.size - abs(self.squares)) / 2.0, 0.0)


def point(at: complex) -> Point:
    """`(x, y)` of a point of the complex plane."""
    return at.real, at.imag


def fit_line(border: Border) -> Line | None:
    """The line of total least squares, `None` when the markers favour no direction."""
    count = border.markers.size
    if count < 2:
        return None
    scatter = _Scatter.of(count, *border.sums)
    if abs(scatter.squares) <= 1e-9 * scatter.size:
        return None
    rms_mm = math.sqrt(scatter.across / count)
    return Line(point(border.mean), _half_turn_deg(scatter.angle), rms_mm)


def fit_rays(border: Border) -> tuple[Corner | None, Cable | None]:
    """The two rays of least squares as a corner, and parallel with the dark between as a cable.

    Returns:
        The corner: `None` with fewer than three markers to a ray or with parallel rays. The
        cable: `None` without two borders of two markers each, facing away from the dark.
    """
    if border.markers.size < 2 * _RAY_MARKERS:
        return None, None
    first, second = _cut(border)
    return _corner(border, first, second), _cable(border, first, second)


def _cut(border: Border) -> tuple[_Scatter, _Scatter]:
    """The two parts of the markers whose lines leave the smallest sum of squares."""
    count = border.markers.size
    counts = _counts(count)
    running = np.add.accumulate(border.moments[:, _along(border)], axis=1)
    sums = np.empty((3, *counts.shape), dtype=np.complex128)
    sums[:, 0] = running[:, _RAY_MARKERS - 1 : count - _RAY_MARKERS]
    np.subtract(running[:, -1:], sums[:, 0], out=sums[:, 1])
    total, squares, size = sums
    mean = total / counts
    twice_across = (size - total * mean.conj()).real - np.abs(squares - total * mean)
    at = int((twice_across[0] + twice_across[1]).argmin())
    first, second = sums[:, :, at].T.tolist()
    before, behind = counts[:, at].tolist()
    return _Scatter.of(before, *first), _Scatter.of(behind, *second)


@lru_cache(maxsize=128)
def _counts(markers: int) -> Integers:
    """Sizes of both parts for every cut, shape `(2, cuts)`."""
    sizes = np.arange(_RAY_MARKERS, markers - _RAY_MARKERS + 1)
    counts = np.array((sizes, markers - sizes))
    counts.flags.writeable = False
    return counts


def _along(border: Border) -> Integers:
    """Indices of the markers in the order in which they stand along the border.

    They are sorted by their angle about the middle of whichever side is convex: seen from there
    a border of two rays is met once in each direction. They begin after the widest gap.
    """
    # Outward directions spread apart along a convex dark side, and close in on a hollow one.
    convex = np.vdot(border.markers, border.outward).real >= 0.0
    seen = border.markers - ((border.dark if convex else border.light) - border.mean)
    around = np.arctan2(seen.imag, seen.real)
    order = around.argsort()
    around = around[order]
    gaps = around[1:] - around[:-1]
    widest = int(gaps.argmax())
    if gaps[widest] > around[0] + 2.0 * math.pi - around[-1]:
        order = np.concatenate((order[widest + 1 :], order[: widest + 1]))
    return order


def _corner(border: Border, first: _Scatter, second: _Scatter) -> Corner | None:
    one, two = first.angle, second.angle
    crossing = math.sin(two - one)
    if abs(crossing) < 1e-9:
        return None
    apart = second.mean - first.mean
    far = (apart.real * math.sin(two) - apart.imag * math.cos(two)) / crossing
    vertex = first.mean + complex(far * math.cos(one), far * math.sin(one))
    one, two = phase(first.mean - vertex), phase(second.mean - vertex)
    turn = (two - one) % (2.0 * math.pi)
    if turn > math.pi:
        one, two, turn = two, one, 2.0 * math.pi - turn
    return Corner(
        vertex_mm=point(border.mean + vertex),
        directions_deg=(_whole_turn_deg(one), _whole_turn_deg(two)),
        opening_deg=math.degrees(turn),
        rms_mm=math.sqrt((first.across + second.across) / border.markers.size),
    )


def _cable(border: Border, first: _Scatter, second: _Scatter) -> Cable | None:
    """Parallel borders: their common direction from the scatter about the mean of each.

    The rays give the direction to begin with; then each marker belongs to the border that its
    light cell lies beyond.
    """
    count = border.markers.size
    pooled = first.with_other(second)
    for _ in range(_CABLE_ROUNDS):
        upper = (border.outward * _unit(-pooled.angle)).imag > 0.0
        above = int(np.count_nonzero(upper))
        if not _BORDER_MARKERS <= above <= count - _BORDER_MARKERS:
            return None
        sums = (border.moments @ upper).tolist()
        rest = [whole - part for whole, part in zip(border.sums, sums, strict=True)]
        first, second = _Scatter.of(above, *sums), _Scatter.of(count - above, *rest)
        pooled = first.with_other(second)
    turned = _unit(-pooled.angle)
    top, bottom = (first.mean * turned).imag, (second.mean * turned).imag
    if top <= bottom:
        return None
    return Cable(
        axis_point_mm=point(border.mean + (top + bottom) / 2.0 * 1j * _unit(pooled.angle)),
        angle_deg=_half_turn_deg(pooled.angle),
        width_mm=top - bottom,
        rms_mm=math.sqrt(pooled.across / count),
    )


def _unit(angle: float) -> complex:
    return complex(math.cos(angle), math.sin(angle))


def _half_turn_deg(angle: float) -> float:
    """The direction of a line, in (−90, 90]."""
    degrees = math.degrees(angle)
    return degrees + 180.0 if degrees <= -90.0 else degrees


def _whole_turn_deg(angle: float) -> float:
    """The direction of a ray, in (−180, 180]."""
    degrees = math.degrees(angle)
    return degrees + 360.0 if degrees <= -180.0 else degrees
