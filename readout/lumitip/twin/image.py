"""`Image`: an object that is drawn, pixel by pixel."""

import math
from copy import copy
from dataclasses import dataclass, field

import numpy as np

from lumitip import arguments
from lumitip.twin.optics import TwinError
from lumitip.twin.scene import PIXEL_MM, Numbers, Singles, Thing


@dataclass(frozen=True, eq=False)
class Image(Thing):
    """A drawn object: coverage 0 to 1 in rows, the first nearest the tip, shape `(rows, columns)`;
    its middle at `(x_mm, y_mm)`, turned by `angle_deg`. Outside of it nothing is covered."""

    pixels: Numbers
    pixel_mm: float = PIXEL_MM
    x_mm: float = 0.0
    y_mm: float = 0.0
    angle_deg: float = 0.0
    _framed: Singles = field(init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        pixels = arguments.numbers(self.pixels, "pixels", TwinError)
        if pixels.ndim != 2 or not pixels.size or not (0.0 <= pixels.min() <= pixels.max() <= 1.0):
            raise TwinError(
                f"pixels has shape {pixels.shape}; rows of coverage from 0 to 1 are needed"
            )
        if not self.pixel_mm > 0.0:
            raise TwinError(f"pixel_mm is {self.pixel_mm}; it must be above 0")
        # A frame of nothing around it, so that a place outside finds nothing without a test.
        object.__setattr__(self, "_framed", np.pad(pixels.astype(np.float32), 1))

    @classmethod
    def of(cls, thing: Thing, size_mm: float = 80.0, pixel_mm: float = 0.1) -> "Image":
        """An object drawn once, a square around the origin, so that it can be moved cheaply."""
        size_mm = arguments.number(size_mm, "size_mm", above=0.0, error=TwinError)
        pixel_mm = arguments.number(pixel_mm, "pixel_mm", above=0.0, error=TwinError)
        half = int(np.ceil(size_mm / 2.0 / pixel_mm))
        line = np.arange(-half, half + 1) * pixel_mm
        pixels = thing.coverage(line[None, :], -line[:, None]).astype(np.float32)
        return cls(pixels, pixel_mm, clear=thing.clear, diffuse=thing.diffuse, height=thing.height)

    def coverage(self, x_mm: Numbers, y_mm: Numbers, pixel_mm: float = PIXEL_MM) -> Numbers:  # noqa: ARG002
        """See `Thing`: the pixel that each place falls on."""
        angle, scale = math.radians(self.angle_deg), 1.0 / self.pixel_mm
        cos, sin = math.cos(angle) * scale, math.sin(angle) * scale
        rows, columns = self._framed.shape
        right = 0.5 * columns - self.x_mm * cos - self.y_mm * sin
        down = 0.5 * rows + self.y_mm * cos - self.x_mm * sin
        column = np.clip(x_mm * cos + y_mm * sin + right, 0.0, columns - 1.0).astype(np.int32)
        row = np.clip(x_mm * sin - y_mm * cos + down, 0.0, rows - 1.0).astype(np.int32)
        found: Numbers = self._framed.ravel()[row * np.int32(columns) + column]
        return found

    def at(self, x_mm: float, y_mm: float, angle_deg: float) -> "Image":
        """The same elsewhere (mm, degrees), without a copy of the pixels."""
        moved = copy(self)
        for name, value in (("x_mm", x_mm), ("y_mm", y_mm), ("angle_deg", angle_deg)):
            object.__setattr__(moved, name, value)
        arguments.finite_fields(moved, TwinError)
        return moved
