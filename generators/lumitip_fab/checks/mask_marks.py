"""Registration marks and rulers, found on the picture of a mask."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from PIL import Image
from scipy import ndimage

from lumitip_fab.checks.readers.mask_page import Points
from lumitip_fab.checks.readers.pixels import Picture

_COARSE = 4  # pixels in one, to find things quickly
_INK = 0.1  # a hairline between two coarse pixels covers more of each
_ARMS_MM = 2.0  # from the middle of a mark to the ends of its cross
_MARK_MM2 = (0.9, 2.2)  # ink of a mark; letters as large have more, or are no square
_LONG_MM = (80.0, 125.0)  # of rulers, before their length is taken
_TICKS_MM = (2.4, 4.4)  # the longest of a ruler's ticks
_TICK_MM = 0.8  # half of the shortest
_ODD_MM = 0.6  # of a mark that is not square
_PAST_MM = 0.15  # of bare paper round a part


Part = tuple[Points, Points]
"""Lower left and upper right corner of the box round it (mm)."""


@dataclass(frozen=True, eq=False)
class Ruler:
    """A ruler on a page."""

    along: int
    """0 if it lies along x, 1 along y."""
    ticks_mm: Points
    """Places of its ticks along it."""
    across_mm: float
    """Place of its middle across."""


def parts_on(picture: Picture) -> tuple[Part, ...]:
    """The boxes round all that stands by itself (mm)."""
    coarse = np.asarray(Image.fromarray(picture.grey).reduce(_COARSE))
    labels, _ = ndimage.label(coarse < 255 * (1 - _INK), np.ones((3, 3)))
    found = []
    for down, across in ndimage.find_objects(labels):
        ends = [(across.start, down.stop), (across.stop, down.start)]
        low, high = picture.points(np.array(ends) * _COARSE)
        found.append((low, high))
    return tuple(found)


def marks_on(picture: Picture, parts: tuple[Part, ...], wide_mm: float) -> Points:
    """Centres of the registration marks (mm), shape `(n, 2)`: crosses in rings, as far to the left
    and to the right of the page's middle as they have to be.

    Args:
        picture: of the whole page.
        parts: of it.
        wide_mm: from a left to a right mark.
    """
    middle = picture.corner_mm[0] + picture.size_mm[0] / 2
    found = []
    for low, high in parts:
        off = abs(abs((low[0] + high[0]) / 2 - middle) - wide_mm / 2)
        if off < _ARMS_MM and np.abs(high - low - 2 * _ARMS_MM).max() < _ODD_MM:
            part = picture.part(low - _PAST_MM, high + _PAST_MM)
            if _MARK_MM2[0] < part.ink.sum() * part.pixel_mm.prod() < _MARK_MM2[1]:
                found.append(part.ink_middle_mm)
    return np.array(found).reshape(-1, 2)


def rulers_on(picture: Picture, parts: tuple[Part, ...]) -> Iterator[Ruler]:
    """The rulers of a page: long parts as wide as their ticks."""
    for low, high in parts:
        size = high - low
        if _between(size.max(), _LONG_MM) and _between(size.min(), _TICKS_MM):
            along = int(size.argmax())
            ticks = _ticks(picture.part(low - _PAST_MM, high + _PAST_MM), along)
            yield Ruler(along, ticks, float((low + high)[1 - along]) / 2)


def _ticks(part: Picture, along: int) -> Points:
    """Places of the ticks: where there is more ink across the ruler than its base line has."""
    ink_mm = part.ink.sum(axis=along) * part.pixel_mm[1 - along]
    labels, count = ndimage.label(ink_mm > _TICK_MM)
    at = ndimage.center_of_mass(ink_mm, labels, range(1, count + 1))
    ends = np.zeros((count, 2))
    ends[:, along] = np.array(at).reshape(-1) + 0.5
    return np.sort(part.points(ends)[:, along])


def _between(value: float, ends: tuple[float, float]) -> bool:
    return ends[0] < value < ends[1]
