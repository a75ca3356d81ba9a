"""Swapped cells, found while the straight edge of a sheet moves over all cells.

In each frame the edge is estimated from all cells. The light that is expected at each place is then
compared with each channel: a swapped channel fits the place of the other cell.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lumitip.estimation import PoseEstimator
from lumitip.grid import Floats
from lumitip.health.swaps import Mask
from lumitip.layout import Layout
from lumitip.twin import Twin

MOST_FRAMES = 100
_LEAST_FRAMES = 20
_MOVED, _LEAST_SHARE = 15.0, 0.8
"""Standard deviation of a cell that the sheet passes (counts), and share of the cells."""
_AGAIN = "Move its edge over all cells, in all directions"
_LEAST_GAIN = 5.0
"""Least improvement of two cells in each other's places, of a frame on average (counts of 255)."""
_LEAST_RATIO = 0.5  # of their misfit in their own places, which the change takes away
_SUSPECT = 3.0  # times the median misfit of cells in their own places
_MOST_SWAPS = 8
_MOST_MISFIT = 40.0  # of a frame that an edge explains, swapped cells included (counts)


@dataclass(frozen=True, eq=False)
class Seen:
    """The result of `Places`."""

    swapped: tuple[tuple[int, int], ...]
    """Pairs of cells, the clearest first."""
    misfit: Floats | None
    """Mean difference of each channel from the light at its place (counts of 255)."""
    unseen: str | None
    """Why swapped cells cannot be found; `None` if they can."""


class Places:
    """Finds swapped cells of a layout."""

    def __init__(self, layout: Layout, gap_mm: float) -> None:
        """Prepare estimator and tables.

        Args:
            layout: the cells.
            gap_mm: between the skins.
        """
        self.estimate = PoseEstimator(layout, gap_mm=gap_mm).prepare("edge")
        """Of the edge of the sheet."""
        self._twin = Twin(layout, self.estimate.model)

    def __call__(self, values: Floats, usable: Mask) -> "Seen":
        """Compare each channel with the light at each place.

        Args:
            values: calibrated, of the sheet that moves, shape `(n, cells)`.
            usable: cells without another fault, shape `(cells,)`.
        """
        share = float((values.std(axis=0) > _MOVED)[usable].mean()) if usable.any() else 0.0
        if share < _LEAST_SHARE:
            return Seen((), None, f"the sheet moved over {share:.0%} of the cells. {_AGAIN}")
        misfit = self._misfit(values, usable)
        if misfit is not None:
            own = np.diag(misfit)
            # Cells in other places bend the edge; without them the others show it as it is.
            trusted = usable & (own < _SUSPECT * np.median(own[usable]))
            if (trusted != usable).any():
                misfit = self._misfit(values, trusted)
        if misfit is None:
            return Seen((), None, f"too few frames show the straight edge of a sheet. {_AGAIN}")
        return Seen(tuple(_exchanges(misfit, usable)), np.diag(misfit), None)

    def _misfit(self, values: Floats, trusted: Mask) -> Floats | None:
        """Mean difference of channel a from the light at place i, shape `(a, i)`; None if too few
        frames show an edge.

        Args:
            values: of the moving sheet.
            trusted: cells by which the edge is estimated.
        """
        rows = list(self._explained(values, trusted))
        if len(rows) < _LEAST_FRAMES:
            return None
        measured, expected = (np.array(part) for part in zip(*rows, strict=True))
        return np.asarray(np.abs(measured[:, :, None] - expected[:, None, :]).mean(axis=0))

    def _explained(self, values: Floats, trusted: Mask) -> Iterator[tuple[Floats, Floats]]:
        """Frames with an edge, and the light that is expected of it."""
        every = max(1, len(values) // MOST_FRAMES)
        for row in values[::every]:
            found = self.estimate(np.where(trusted, row, np.nan), "edge")
            if not np.isfinite(found.offset_mm):
                continue
            sides = self._twin.edges(
                [found.offset_mm, -found.offset_mm], [found.angle_deg, found.angle_deg + 180.0]
            )
            off = np.abs(sides - row)[:, trusted].mean(axis=1)
            if off.min() < _MOST_MISFIT:
                yield row, sides[int(off.argmin())]


def _exchanges(misfit: Floats, usable: Mask) -> Iterator[tuple[int, int]]:
    own = np.diag(misfit)
    before = own[:, None] + own
    gain = before - misfit - misfit.T
    gain[~usable] = gain[:, ~usable] = 0.0
    clear = (gain > 2.0 * _LEAST_GAIN) & (gain > _LEAST_RATIO * before)
    gain[~clear] = 0.0
    for _ in range(_MOST_SWAPS):
        one, two = np.unravel_index(int(gain.argmax()), gain.shape)
        if gain[one, two] <= 0.0:
            return
        yield (min(int(one), int(two)), max(int(one), int(two)))
        gain[[one, two]] = gain[:, [one, two]] = 0.0
