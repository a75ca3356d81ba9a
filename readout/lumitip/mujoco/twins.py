"""`Twins`: the twin at any gap, and objects at any height in it, between computed ones."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Model, Twin

GAPS_MM = np.concatenate([np.arange(0.5, 4.0, 0.5), np.arange(4.0, 10.0), np.arange(10.0, 21.0, 2)])
"""Gaps of the computed twins (mm). Linear interpolation between them is within 1 count."""
_HEIGHT_MM = 0.4  # between the heights that are computed
_LEAST = 0.01  # weight of a twin that is left out
Read = Callable[[Twin, float], Floats]


class Twins:
    """Twins of one layout, each computed when it is first needed (0.3 s, and its tables)."""

    def __init__(self, layout: Layout, optics: Model) -> None:
        self._layout, self._optics = layout, optics
        self._twins: dict[int, Twin] = {}

    def values(self, gap_mm: float, z_mm: float, read: Read) -> Floats:
        """Values at a gap and a height, shape `(cells,)`.

        Args:
            gap_mm: between the fingers (mm).
            z_mm: of the object above the receiver (mm).
            read: gives the values of a twin with the object at a height of 0 to 1.
        """
        height = height_in(gap_mm, z_mm)
        total = np.zeros(len(self._layout))
        for twin, share in self.around(gap_mm):
            steps = _steps(twin)
            for place, part in _between(height * steps):
                total += share * part * read(twin, place / steps)
        return total

    def around(self, gap_mm: float) -> Iterator[tuple[Twin, float]]:
        """The twins next to a gap (mm), and the weight of each."""
        place = float(np.interp(gap_mm, GAPS_MM, np.arange(len(GAPS_MM))))
        for number, share in _between(place):
            if number not in self._twins:
                optics = replace(self._optics, gap_mm=float(GAPS_MM[number]))
                self._twins[number] = Twin(self._layout, optics)
            yield self._twins[number], share


def height_in(gap_mm: float, z_mm: float) -> float:
    """Height in a gap, 0 to 1, of a place above the receiver."""
    return min(max(z_mm / max(gap_mm, 1e-9), 0.0), 1.0)


def nearest_height(twin: Twin, height: float) -> float:
    """The nearest height that is computed."""
    return round(height * _steps(twin)) / _steps(twin)


def _steps(twin: Twin) -> int:
    return max(2, 2 * round(twin.model.gap_mm / (2.0 * _HEIGHT_MM)))


def _between(place: float) -> list[tuple[int, float]]:
    """The whole numbers around a place, and their weights; one alone if it is near."""
    low = int(np.floor(place))
    share = place - low
    if share < _LEAST:
        return [(low, 1.0)]
    if share > 1.0 - _LEAST:
        return [(low + 1, 1.0)]
    return [(low, 1.0 - share), (low + 1, share)]
