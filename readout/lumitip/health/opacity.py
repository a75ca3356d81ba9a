"""Whether a mask is opaque to the light of the LEDs, measured by the sensor itself.

Many black plastics and inks let infrared pass. Three states are compared cell by cell: nothing
between the fingers, sheet metal, and a coupon of the mask's material without holes.
"""

import math
from dataclasses import dataclass

import numpy as np

from lumitip import arguments
from lumitip.errors import ArgumentError
from lumitip.frame import Values
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.values import one_line

MOST_LEAK = 0.05
"""Most light that may pass beside the holes, as a share of the light through them."""
_LEAST_LIGHT = 50.0  # counts of 255 from metal to nothing, of which a share can be measured
_SIGMAS = 2.0  # standard errors that are counted against the coupon
_ROUNDING = 0.5  # of whole codes, which does not average out where light ends at 0 (counts)


@dataclass(frozen=True, eq=False)
class Opacity:
    """Light through a coupon, as a share of the light without it."""

    transmission: Values
    """Of each cell, shape `(cells,)`; NaN where a cell has too little light to tell."""
    error: Values
    """Standard error of each, shape `(cells,)`."""
    most: float
    """Limit of the transmission."""

    @property
    def judged(self) -> bool:
        """Whether any cell has enough light to tell."""
        return bool(np.isfinite(self.transmission).any())

    @property
    def worst(self) -> int:
        """The cell with the largest transmission, counted with its error.

        Raises:
            ArgumentError: if no cell has enough light.
        """
        if not self.judged:
            raise ArgumentError("no cell has enough light to tell")
        return int(np.nanargmax(self._highest))

    @property
    def opaque(self) -> bool:
        """Whether every cell that can tell is below the limit, by two standard errors."""
        return self.judged and bool(self._highest[self.worst] <= self.most)

    @property
    def _highest(self) -> Values:
        return self.transmission + np.float32(_SIGMAS) * self.error

    def __repr__(self) -> str:
        return one_line(self)


def most_transmission(layout: Layout) -> float:
    """The transmission of the mask's material at which light beside the holes is `MOST_LEAK` of
    that through them: the material has the rest of the hexagon round each cell.

    Raises:
        LayoutError: if `layout` is not a layout.
    """
    arguments.layout(layout)
    circle = layout.optics.hole_shape == "circle"
    # The smallest hole is the one beside which the least light may pass.
    hole_mm2 = float(layout.hole_mm.min()) ** 2 * (math.pi / 4 if circle else math.sqrt(3) / 2)
    cell_mm2 = layout.pitch_mm**2 * math.sqrt(3) / 2
    return MOST_LEAK * hole_mm2 / (cell_mm2 - hole_mm2)


def opacity(clear: Values, metal: Values, coupon: Values, layout: Layout) -> Opacity:
    """Compare three states.

    Args:
        clear: frames with nothing between the fingers, not calibrated, 255 is full light, shape
            `(n, cells)`, at least two.
        metal: frames with sheet metal over all cells, alike.
        coupon: frames with the coupon in its place, alike.
        layout: the cells.

    A cell that is saturated in `clear` makes the transmission look larger than it is.

    Raises:
        LayoutError: if `layout` is not a layout.
        ArgumentError: if frames are not of this shape.
    """
    most = most_transmission(layout)
    light, light_error = _state(clear, "clear", len(layout))
    dark, dark_error = _state(metal, "metal", len(layout))
    behind, behind_error = _state(coupon, "coupon", len(layout))
    span = np.where(light - dark >= _LEAST_LIGHT, light - dark, np.nan)
    transmission = (behind - dark) / span
    # Of the quotient: numerator and denominator share the error of `metal`.
    parts = [behind_error, (1 - transmission) * dark_error, transmission * light_error]
    error = np.linalg.norm(parts, axis=0) / span
    return Opacity(transmission.astype(np.float32), error.astype(np.float32), most)


def _state(light: Values, name: str, cells: int) -> tuple[Floats, Floats]:
    """Mean of each cell and its standard error (counts)."""
    frames = arguments.numbers(light, name)
    if frames.ndim != 2 or len(frames) < 2 or frames.shape[1] != cells:
        raise ArgumentError(f"{name} has shape {frames.shape}; (2 or more, {cells}) is needed")
    noise = frames.std(axis=0, ddof=1) / math.sqrt(len(light))
    return frames.mean(axis=0), np.hypot(noise, _ROUNDING)
