"""`Processor`: from the values of one frame, or of many, to the object between the fingers.

A contact gets its shape by this rule; `pitch` is that of the grid.

1. No contrast: `"covered"` if the median value is below the level of a covered finger, else
   `"none"`.
2. `"edge"`: one line leaves at most 0.2 pitch rms; or it leaves more than a fifth of the sum of
   squares about the mean, and no dark cell or no light cell is at the rim of the grid: the border
   is round and closed. Then neither corner nor cable applies.
3. `"cable"`: there is light on both sides of the dark cells, and two parallel borders leave at most
   0.5 pitch rms and no more than two rays do, unless these open less than 25°.
4. `"corner"`: two rays leave at most 0.5 pitch rms, open 15° to 165°, and meet over the cells or
   within half a pitch of them.
5. `"edge"`: every other contact.

The limits come from 600 random poses of each shape on two grids, with light edges 1.3 to 4.5 mm
wide and two counts of noise. One straight border leaves up to 0.20 pitch, since markers lie on the
segments between cells: the bias of the method. The right fit leaves up to 0.39 pitch of a cable and
0.18 of a corner; markers of cells that are dark by chance leave 0.54 and more.
"""

import numpy as np
from numpy.typing import ArrayLike

from lumitip import arguments
from lumitip.errors import LumitipError
from lumitip.grid import Floats, Integers, collinear
from lumitip.layout import Layout
from lumitip.processing.batch import (
    Batch,
    Flags,
    Grid,
    darkness,
    process,
    threshold,
    usable_cells,
)
from lumitip.processing.contact import Cable, Contact, Corner, Line
from lumitip.processing.fits import Border, Points, fit_line, fit_rays, point

MIN_CONTRAST = 20.0
COVERED_BELOW = 128.0
Rectangle = tuple[float, float, float, float]
_LINE_RMS = 0.2
_OTHER_RMS = 0.5
_ROUND = 0.2
_OPENING_DEG = (15.0, 165.0)
_PARALLEL_DEG = 25.0
_TIE = 1e-9  # relative, and mm: rounding differences between two exact fits are smaller


class ValuesError(LumitipError, ValueError):
    """Wrong number of values for this layout, or no numbers."""


class Processor:
    """`contact = Processor(layout)(values)`: the published method, on any grid. Thread-safe."""

    def __init__(
        self,
        layout: Layout,
        min_contrast: float = MIN_CONTRAST,
        covered_below: float = COVERED_BELOW,
    ) -> None:
        """Prepare for the grid of a layout.

        Args:
            layout: cells and neighbours.
            min_contrast: smallest difference between the means of light and dark cells that is a
                contact (counts of 255). Twenty is above the noise of an empty grasp, and below
                the 32 counts that a clear plastic bag takes away.
            covered_below: without contrast, a median value below this is a covered finger.

        Raises:
            LayoutError: if `layout` is no layout.
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

    def __repr__(self) -> str:
        return f"<Processor of {self.layout!r}, min_contrast {self.min_contrast:g}>"

    def __call__(self, values: ArrayLike) -> Contact:
        """Process one frame.

        Args:
            values: 0–255 (255 is full light), integers or floats, shape `(cells,)`. Cells whose
                value is not finite, or beyond a billion, are ignored, together with their markers.

        Raises:
            ValuesError: if there is another number of values, or they are no numbers.
        """
        frame = frame_values(values, self.layout)
        finite = usable_cells(frame)
        usable = None if np.count_nonzero(finite) == frame.size else finite
        known = frame if usable is None else frame[finite]
        if known.size < 2:
            return self.without_contrast(known)
        level, contrast = threshold(known)
        if not contrast >= self.min_contrast or contrast <= 0.0:
            return self.without_contrast(known)
        return self._contact(frame, usable, level, contrast)

    def batch(self, values: ArrayLike) -> Batch:
        """Thresholds, centres and markers of many frames, each as for one frame.

        Args:
            values: 0–255 (255 is full light), integers or floats, shape `(n, cells)`.

        Raises:
            ValuesError: if there is another number of values, or they are no numbers.
        """
        return process(batch_values(values, self.layout), self._grid, self.min_contrast)

    def without_contrast(self, values: Floats) -> Contact:
        """The contact of a frame without contrast, from its finite values: none, or covered."""
        return Contact("covered" if is_covered(values, self.covered_below) else "none")

    def _fits(
        self, border: Border, is_dark: Flags
    ) -> tuple[Line | None, Corner | None, Cable | None]:
        """The fits that apply; none if all cells lie on one line, which all markers then do too."""
        if self._collinear:
            return None, None, None
        line = fit_line(border)
        at_rim = is_dark[self._rim]
        closed = not 0 < np.count_nonzero(at_rim) < at_rim.size
        return line, *_fit_others(border, line, closed, self.layout.pitch_mm, self._reach_mm)

    def _contact(
        self, values: Floats, usable: Flags | None, level: float, contrast: float
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
            shape=_shape_of(corner, cable),
            threshold=level,
            contrast=contrast,
            centre_mm=point(_centre(dark, values[is_dark], dark_mean)),
            markers_mm=markers_mm,
            line=line,
            corner=corner,
            cable=cable,
        )


def frame_values(values: ArrayLike, layout: Layout) -> Floats:
    """Values of one frame as floats, shape `(cells,)`.

    Raises:
        ValuesError: if there is another number of values, or they are no numbers.
    """
    frame = arguments.numbers(values, "values", ValuesError)
    if frame.shape != (len(layout),):
        remedy = ". Pass one frame, or use `Processor.batch`." if frame.ndim == 2 else ""
        raise ValuesError(
            f"values has shape {frame.shape}; a frame of this layout has ({len(layout)},){remedy}"
        )
    return frame


def batch_values(values: ArrayLike, layout: Layout) -> Floats:
    """Values of many frames as floats, shape `(n, cells)`.

    Raises:
        ValuesError: if there is another number of values, or they are no numbers.
    """
    frames = arguments.numbers(values, "values", ValuesError)
    if frames.ndim != 2 or frames.shape[1] != len(layout):
        raise ValuesError(
            f"values has shape {frames.shape}; frames of this layout have (n, {len(layout)})"
        )
    return frames


def is_covered(values: Floats, below: float = COVERED_BELOW) -> bool:
    """Whether the finite values of a frame without contrast are those of a covered finger."""
    return values.size > 0 and float(np.median(values)) < below


def _rim(layout: Layout) -> Integers:
    """Cells with fewer neighbours than others have; all cells if there are none."""
    neighbours = np.bincount(layout.neighbours.ravel(), minlength=len(layout))
    rim = np.flatnonzero(neighbours < neighbours.max())
    return rim if rim.size else np.arange(len(layout))


def _centre(dark: Points, values: Floats, mean: complex) -> complex:
    """Mean of dark cells, each weighted with `darkness`; equal weights if all of them are 0."""
    weights = darkness(values)
    total = float(np.add.reduce(weights))
    return complex(dark.dot(weights)) / total if total > 0.0 else mean


def _fit_others(
    border: Border, line: Line | None, closed: bool, pitch_mm: float, reach_mm: Rectangle
) -> tuple[Corner | None, Cable | None]:
    """Corner and cable if they fit the markers, else `None`.

    Args:
        border: the markers.
        line: through all markers, or `None`.
        closed: whether all dark cells, or all light cells, lie within the grid.
        pitch_mm: of the grid.
        reach_mm: rectangle of the cells, `(left, bottom, right, top)`.
    """
    if line is not None and line.rms_mm <= _LINE_RMS * pitch_mm:
        return None, None
    if closed and (line is None or line.rms_mm**2 * border.markers.size > _ROUND * border.size):
        return None, None
    corner, cable = fit_rays(border)
    if cable is not None and cable.rms_mm > _OTHER_RMS * pitch_mm:
        cable = None
    if corner is not None and not _is_corner(corner, pitch_mm, reach_mm):
        corner = None
    return corner, cable


def _shape_of(corner: Corner | None, cable: Cable | None) -> str:
    """`"edge"`, `"corner"` or `"cable"`, from the fits that apply."""
    if cable is not None and (
        corner is None
        or cable.rms_mm <= corner.rms_mm * (1 + _TIE) + _TIE
        or corner.opening_deg < _PARALLEL_DEG
    ):
        return "cable"
    return "edge" if corner is None else "corner"


def _is_corner(corner: Corner, pitch_mm: float, reach_mm: Rectangle) -> bool:
    (x_mm, y_mm), (left, bottom, right, top) = corner.vertex_mm, reach_mm
    margin = pitch_mm / 2.0
    return (
        left - margin < x_mm < right + margin
        and bottom - margin < y_mm < top + margin
        and _OPENING_DEG[0] < corner.opening_deg < _OPENING_DEG[1]
        and corner.rms_mm <= _OTHER_RMS * pitch_mm
    )
