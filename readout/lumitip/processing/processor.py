"""`Processor`: from the values of one frame, or of many, to what is between the fingers."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumitip import arguments
from lumitip.errors import LumitipError
from lumitip.grid import Floats, Integers, collinear
from lumitip.layout import Layout
from lumitip.processing.batch import Batch, Grid, process
from lumitip.processing.contact import Cable, Contact, Corner, Line
from lumitip.processing.fits import Border, Points, fit_line, point
from lumitip.processing.shape import fit_others, shape_of
from lumitip.processing.threshold import darkness, threshold
from lumitip.processing.threshold import usable as counted

MIN_CONTRAST = 20.0
COVERED_BELOW = 128.0


class ValuesError(LumitipError, ValueError):
    """Values that are not those of a frame of this layout."""


class Processor:
    """`contact = Processor(layout)(values)`: the published method, on any grid.

    Holds constants alone, so one processor may serve several threads.
    """

    def __init__(
        self,
        layout: Layout,
        min_contrast: float = MIN_CONTRAST,
        covered_below: float = COVERED_BELOW,
    ) -> None:
        """Prepare for the grid of a layout.

        Args:
            layout: where the cells are, and which are neighbours.
            min_contrast: smallest difference between the means of light and dark cells that is a
                contact (counts of 255). Twenty lies above the noise of an empty grasp, and below
                the 32 counts that a clear plastic bag takes away.
            covered_below: without contrast, a middle value below this is a covered finger.

        Raises:
            LayoutError: if it is no layout.
            ArgumentError: if another argument is no number, or below 0.
        """
        self.layout = arguments.layout(layout)
        self.min_contrast = arguments.number(min_contrast, "min_contrast", 0.0)
        self.covered_below = arguments.number(covered_below, "covered_below", 0.0)
        cells: Points = layout.x_mm + 1j * layout.y_mm
        begin, end = np.ascontiguousarray(layout.neighbours.T)
        self._grid = Grid(cells, begin, end, cells[end] - cells[begin])
        self._sum = complex(cells.sum())
        self._rim = _rim(layout)
        self._collinear = collinear(layout.x_mm, layout.y_mm)
        self._reach_mm = (
            float(layout.x_mm.min()),
            float(layout.y_mm.min()),
            float(layout.x_mm.max()),
            float(layout.y_mm.max()),
        )

    def __call__(self, values: ArrayLike) -> Contact:
        """The contact in one frame.

        Args:
            values: 0–255 (255 is full light), shape `(cells,)`, whole or not.
                Cells whose value is not finite, or beyond a billion, are left out, together with
                their markers.

        Raises:
            ValuesError: if the shape is another, or they are no numbers.
        """
        frame = arguments.numbers(values, "values", ValuesError)
        if frame.shape != self._grid.cells.shape:
            raise ValuesError(
                f"values has shape {frame.shape}; a frame of this layout has "
                f"{self._grid.cells.shape}; `batch` takes several frames"
            )
        finite = counted(frame)
        usable = None if np.count_nonzero(finite) == frame.size else finite
        seen = frame if usable is None else frame[finite]
        if seen.size < 2:
            return self.without_contrast(seen)
        level, contrast = threshold(seen)
        if not contrast >= self.min_contrast or contrast <= 0.0:
            return self.without_contrast(seen)
        return self._contact(frame, usable, level, contrast)

    def batch(self, values: ArrayLike) -> Batch:
        """Thresholds, centres and markers of many frames, each as for one frame.

        Args:
            values: 0–255 (255 is full light), shape `(n, cells)`, whole or not.

        Raises:
            ValuesError: if the shape is another, or they are no numbers.
        """
        frames = arguments.numbers(values, "values", ValuesError)
        if frames.ndim != 2 or frames.shape[1:] != self._grid.cells.shape:
            raise ValuesError(
                f"values has shape {frames.shape}; frames of this layout have "
                f"(n, {self._grid.cells.size})"
            )
        return process(frames, self._grid, self.min_contrast)

    def without_contrast(self, values: Floats) -> Contact:
        """The contact of a frame without contrast: nothing between the fingers, or all covered.

        Args:
            values: the finite ones of the frame.
        """
        middle = float(np.median(values)) if values.size else math.inf
        return Contact("covered" if middle < self.covered_below else "none")

    def _fits(
        self, border: Border, is_dark: NDArray[np.bool_]
    ) -> tuple[Line | None, Corner | None, Cable | None]:
        """Line, corner and cable through the markers; none where all cells lie on one line, as
        the direction of a border is then unknown."""
        if self._collinear:
            return None, None, None
        line = fit_line(border)
        at_rim = is_dark[self._rim]
        closed = not 0 < np.count_nonzero(at_rim) < at_rim.size
        return line, *fit_others(border, line, closed, self.layout.pitch_mm, self._reach_mm)

    def _contact(
        self, values: Floats, usable: NDArray[np.bool_] | None, level: float, contrast: float
    ) -> Contact:
        grid, everything, count = self._grid, self._sum, values.size
        is_dark = values < level
        if usable is not None:
            is_dark &= usable
            grid = grid.between(usable)
            everything = complex(grid.cells[usable].sum())
            count = int(np.count_nonzero(usable))
        begins_dark = is_dark[grid.begin]
        crossed = begins_dark != is_dark[grid.end]
        dark = grid.cells[is_dark]
        dark_sum = complex(np.add.reduce(dark))
        dark_mean = dark_sum / dark.size

        pairs = crossed.nonzero()[0]
        begin, steps = grid.begin[pairs], grid.steps[pairs]
        first = values[begin]
        markers = grid.cells[begin] + (level - first) / (values[grid.end[pairs]] - first) * steps
        border = Border(
            markers=markers,
            outward=np.where(begins_dark[pairs], steps, -steps),
            dark=dark_mean,
            light=(everything - dark_sum) / (count - dark.size),
        )
        line, corner, cable = self._fits(border, is_dark)
        markers_mm = markers.view(np.float64).reshape(-1, 2)
        markers_mm.flags.writeable = False
        return Contact(
            shape=shape_of(corner, cable),
            threshold=level,
            contrast=contrast,
            centre_mm=point(_centre(dark, values[is_dark], dark_mean)),
            markers_mm=markers_mm,
            line=line,
            corner=corner,
            cable=cable,
        )


def _rim(layout: Layout) -> Integers:
    """Cells with fewer neighbours than others have, or all if there are none."""
    neighbours = np.bincount(layout.neighbours.ravel(), minlength=len(layout))
    rim = np.flatnonzero(neighbours < neighbours.max())
    return rim if rim.size else np.arange(len(layout))


def _centre(dark: Points, values: Floats, mean: complex) -> complex:
    """Mean of dark cells, each weighted with `darkness`; equal weights if all of them are 0."""
    weights = darkness(values)
    total = float(np.add.reduce(weights))
    return complex(dark.dot(weights)) / total if total > 0.0 else mean
