"""The flaps: trapezoids on the folds, as long as the finger's back has room for."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely

from lumitip_fab.design import Mask, Point
from lumitip_fab.mask.outline import Finished, Points, fold_corners, folded

TAPER_DEG = 10.0
WIDEST_TAPER = 0.2  # of the fold, on each side, so that narrow flaps keep a useful end
LEAST_END = 0.2  # of the fold that a flap's end keeps
CONCAVE_GAP_DEG = 1.0  # on each side of the slit between flaps that converge
LEAST_REACH_MM = 2.0  # onto the back, before the windows behind parts are left out
START_GAP_MM = 0.1  # first fold to what it must keep clear of
BAND_MM = 0.5  # black beyond the back's edge
CLEAR_END_MM = 3.2  # left unprinted: bonds better, and takes the number
LEAST_CLEAR_MM = 2.0  # of a flap so short that its side would not be black otherwise
LAP_MM = 0.2  # of black past the side of such a flap
UNDER_MM = 0.6  # how far a band runs under the black, past any sagitta


@dataclass(frozen=True)
class Flap:
    """A flap in the sensor frame, flat."""

    number: int
    """Place in the order of folding, from 1."""
    corners: tuple[Point, Point, Point, Point]
    """Fold start, outer corner, outer corner, fold end; outward is to the right of the fold."""
    length_mm: float
    reach_mm: float
    """How far it lies onto the back when taut."""
    band: tuple[Point, Point, Point, Point]
    """The part that is printed black: what covers the finger's side."""
    label: Point
    """Where its number goes."""

    @property
    def fold(self) -> tuple[Point, Point]:
        """The fold line."""
        return self.corners[0], self.corners[3]

    @property
    def width_mm(self) -> float:
        """Length of the fold."""
        return math.dist(*self.fold)

    def on_back(self, allowance_mm: float) -> list[Point]:
        """Corners of the part that lies on the back, seen through the finger from its front."""
        side_mm = self.length_mm + allowance_mm - self.reach_mm
        lying = folded(self.corners, allowance_mm, side_mm)
        return [_point(np.array(corner)) for corner in lying.exterior.coords[:-1]]


def make_flaps(finished: Finished, mask: Mask) -> tuple[Flap, ...]:
    """All flaps, counter-clockwise from the right leg of the gripper end."""
    start_x = finished.free_from_x_mm() + START_GAP_MM
    ends = fold_corners(finished.outline, mask.allowance_mm, start_x)
    numbers = _order(ends)
    leans = _leans(ends)
    return tuple(
        _flap(finished, mask, number, ends[i], ends[i + 1], leans[i])
        for i, number in enumerate(numbers)
    )


def _order(ends: Points) -> list[int]:
    """Tip, gripper end, then opposite sides in turn from wide to narrow, so that the film is
    first taut lengthwise, then across, and corners lap over their neighbours."""
    count = len(ends) - 1
    tip = count // 2
    widths = np.hypot(*(ends[1:] - ends[:-1]).T)
    sides = sorted(range(1, tip), key=lambda i: -round(float(widths[i]), 3))
    sequence = [tip]
    for i in [0, *sides]:
        sequence += [i, count - 1 - i]
    return [sequence.index(i) + 1 for i in range(count)]


def _leans(ends: Points) -> list[tuple[float, float]]:
    """Least lean of each flap's two sides (tangent): past the bisector where flaps converge."""
    steps = np.diff(ends, axis=0)
    heading = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    at_corner = [0.0]
    for turn in np.diff(heading).tolist():
        inward = -turn / 2 + math.radians(CONCAVE_GAP_DEG)
        at_corner.append(math.tan(inward) if inward > 0 else 0.0)
    at_corner.append(0.0)
    return list(pairwise(at_corner))


def _flap(
    finished: Finished, mask: Mask, number: int, a: Points, b: Points, leans: tuple[float, float]
) -> Flap:
    sides = [finished.side_mm(y) for y in np.linspace(a[1], b[1], 9).tolist()]
    lowest, highest = min(sides), max(sides)

    def trapezoid(length_mm: float) -> tuple[Point, Point, Point, Point]:
        return _trapezoid(a, b, length_mm, leans)

    def clear(length_mm: float, areas: tuple[shapely.Geometry, ...]) -> bool:
        lying = folded(trapezoid(length_mm), mask.allowance_mm, lowest)
        return not any(area.intersects(lying) for area in areas)

    must = finished.kept_clear()
    least = lowest - mask.allowance_mm + LEAST_REACH_MM
    ought = must + finished.better_clear()
    areas = ought if clear(least, ought) else must
    length = _longest(
        min(mask.flap_mm, _before_it_is_narrow(a, b, leans)), lambda value: clear(value, areas)
    )
    corners = trapezoid(length)
    middle, outward = (a + b) / 2, _outward(a, b)
    band = max(
        min(highest + mask.allowance_mm + BAND_MM, length - CLEAR_END_MM),
        min(highest - mask.allowance_mm + LAP_MM, length - LEAST_CLEAR_MM),
        0.0,
    )
    label = middle + outward * (length - min(length - band, CLEAR_END_MM) / 2)
    return Flap(
        number=number,
        corners=corners,
        length_mm=length,
        reach_mm=length + mask.allowance_mm - lowest,
        band=_band(a, b, corners, length, band),
        label=(float(label[0]), float(label[1])),
    )


def _before_it_is_narrow(a: Points, b: Points, leans: tuple[float, float]) -> float:
    """Length at which sides that lean away from both neighbours leave the least end."""
    return (1 - LEAST_END) * math.dist(a, b) / sum(leans) if sum(leans) else math.inf


def _longest(most_mm: float, allowed: Callable[[float], bool]) -> float:
    """The greatest length that is allowed, to 0.05 mm."""
    if allowed(most_mm):
        return most_mm
    low, high = 0.05, most_mm
    while high - low > 0.05:
        middle = (low + high) / 2
        low, high = (middle, high) if allowed(middle) else (low, middle)
    return low


def _trapezoid(
    a: Points, b: Points, length_mm: float, leans: tuple[float, float]
) -> tuple[Point, Point, Point, Point]:
    width = float(np.hypot(*(b - a)))
    along, outward = (b - a) / width, _outward(a, b)
    usual = min(length_mm * math.tan(math.radians(TAPER_DEG)), WIDEST_TAPER * width)
    needed = [length_mm * lean for lean in leans]
    more = [max(usual - least, 0.0) for least in needed]
    room = max((1 - LEAST_END) * width - sum(needed), 0.0)
    share = min(1.0, room / sum(more)) if sum(more) else 0.0
    first, second = (least + share * extra for least, extra in zip(needed, more, strict=True))
    c = a + outward * length_mm + along * first
    d = b + outward * length_mm - along * second
    return _point(a), _point(c), _point(d), _point(b)


def _band(
    a: Points, b: Points, corners: tuple[Point, Point, Point, Point], length: float, band: float
) -> tuple[Point, Point, Point, Point]:
    """The flap cut off `band` from its fold; its sides run on under the black."""
    share, under = band / length, UNDER_MM / length
    left, right = np.array(corners[1]) - a, np.array(corners[2]) - b
    ends = (a - left * under, a + left * share, b + right * share, b - right * under)
    first, second, third, fourth = map(_point, ends)
    return first, second, third, fourth


def _outward(a: Points, b: Points) -> Points:
    along = (b - a) / np.hypot(*(b - a))
    return np.array([along[1], -along[0]])


def _point(p: Points) -> Point:
    return float(p[0]), float(p[1])
