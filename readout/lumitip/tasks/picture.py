"""`Picture`: the cells of a frame as an image, with the true line on them."""

import math

import numpy as np
from numpy.typing import NDArray

from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.view.drawn import ESTIMATE, MISSING

Image = NDArray[np.uint8]
_PIXELS_PER_MM = 8.0
_MARGIN_MM = 1.0
_LINE_MM = 0.25  # half the width of the line as it is drawn
_GROUND = (190, 196, 202)


class Picture:
    """Draws frames of one layout."""

    def __init__(self, layout: Layout) -> None:
        """The image of a layout, `shape` high and wide."""
        reach_mm = layout.pitch_mm / 2.0 + _MARGIN_MM
        left, right = layout.x_mm.min() - reach_mm, layout.x_mm.max() + reach_mm
        low, high = layout.y_mm.min() - reach_mm, layout.y_mm.max() + reach_mm
        step = 1.0 / _PIXELS_PER_MM
        self._x_mm = np.arange(left + step / 2.0, right, step)[None, :]
        self._y_mm = np.arange(high - step / 2.0, low, -step)[:, None]
        away = np.hypot(self._x_mm[..., None] - layout.x_mm, self._y_mm[..., None] - layout.y_mm)
        self._cell = away.argmin(axis=-1)
        self._outside = away.min(axis=-1) > 0.46 * layout.pitch_mm
        self.shape = self._cell.shape

    def __call__(self, values: Floats, height_mm: float, angle: float) -> Image:
        """The image, shape `(*shape, 3)`.

        Args:
            values: of the cells, 0 to 255; NaN is drawn red.
            height_mm: of the line above the origin.
            angle: of the line (rad).
        """
        seen = np.isfinite(values)
        grey = np.repeat(np.where(seen, values, 0.0).astype(np.uint8)[:, None], 3, axis=1)
        grey[~seen] = MISSING
        image: Image = grey[self._cell]
        image[self._outside] = _GROUND
        left_mm = (self._y_mm - height_mm) * math.cos(angle) - self._x_mm * math.sin(angle)
        image[np.abs(left_mm) < _LINE_MM] = ESTIMATE
        return image
