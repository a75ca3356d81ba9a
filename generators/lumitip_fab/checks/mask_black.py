"""The black of a mask on a picture: its apertures and all that is between them against the design's
cells and outline."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from lumitip_fab.checks.mask_holes import Placed
from lumitip_fab.checks.readers.mask_page import Points
from lumitip_fab.checks.readers.pixels import Picture
from lumitip_fab.checks.result import Measure, Measurement, Subject
from lumitip_fab.design import Design, Finger
from lumitip_fab.design.making import FOLD_OFF_MM

Labels = NDArray[np.uint16]

MARK_MM = 0.01
SCALE = 0.001
PLACE_MM = 0.01
SIZE_MM = 0.02
WRONG_MM2 = 0.0005
"""Of black that lets light through, or of an opening that is not clear: a third of a pixel."""
_SOFT_MM = 0.14  # of grey pixels on each side of an edge; a web is wider than two
_FOLD_MM = 0.15  # from the middle of a fold's dashes to bare black
_FOLD_LIGHT = 0.6  # of their grey
_CLEAR = 0.02  # of black or of light that may be missing in a pixel
_SHARE = {"circle": math.pi / 4, "hexagon": math.sqrt(3) / 2}
"""Area of an aperture of unit size."""
_TURN = {"circle": np.arange(0, 360, 5), "hexagon": np.arange(0, 360, 60)}
_REACH = {"circle": 0.5, "hexagon": 1 / math.sqrt(3)}
_UNIT = {
    shape: reach * np.stack([np.cos(np.radians(_TURN[shape])), np.sin(np.radians(_TURN[shape]))], 1)
    for shape, reach in _REACH.items()
}
"""Its corners."""
_EDGE, _BLACK, _WINDOW, _FREE, _CELLS = 1, 2, 3, 4, 6
"""Regions: black with folds on it, bare black, bare window, a window's edge; from `_CELLS` on the
edge and the bare inside of each cell's aperture in turn."""


@dataclass(frozen=True, eq=False)
class Seen(Subject):
    """A mask's picture with its place."""

    picture: Picture
    """Of the black and what is round it."""
    placed: Placed
    scale: tuple[float, float]
    """That it should have."""
    finger: Finger
    design: Design

    @cached_property
    def regions(self) -> Labels:
        """The number of its region for each pixel: 0 where anything may be printed."""
        image = Image.new("I;16", self.picture.grey.shape[::-1])
        draw = ImageDraw.Draw(image)
        for shape, number in self._shapes():
            for part in shapely.get_parts(shape):
                # A pixel's middle is a whole number to what fills it.
                ring = self.pixels(shapely.get_coordinates(part)) - 0.5
                draw.polygon([tuple(point) for point in ring.tolist()], fill=number)
        return np.asarray(image)

    def pixels(self, points: Points) -> Points:
        """Columns and rows of points in the sensor frame."""
        across, up = self.placed.scale
        return self.picture.pixels(points * (-across, up) + self.placed.origin)

    def mm2(self, wrong: NDArray[np.bool_]) -> float:
        """Area of pixels."""
        return float(np.count_nonzero(wrong) * self.picture.pixel_mm.prod())

    def _shapes(self) -> Iterator[tuple[shapely.Geometry, int]]:
        """The regions in the sensor frame, each over those before it."""
        mask = self.design.mask
        outline = shapely.Polygon(self.design.outline.polygon(96)).buffer(mask.allowance_mm)
        yield outline.buffer(-_SOFT_MM), _EDGE
        yield outline.buffer(-FOLD_OFF_MM - _FOLD_MM), _BLACK
        window = shapely.box(*self.finger.window.bounds_mm)
        yield window.buffer(_SOFT_MM), _FREE
        yield window.buffer(-_SOFT_MM), _WINDOW
        holes = [
            shapely.Polygon(_UNIT[mask.hole_shape] * size + np.array(cell))
            for cell, size in zip(self.finger.cells, mask.holes_mm, strict=True)
        ]
        for by, first in ((_SOFT_MM, _CELLS), (-_SOFT_MM, _CELLS + 1)):
            for n, hole in enumerate(shapely.buffer(holes, by)):
                yield hole, first + 2 * n


def measure_marks(seen: Seen) -> Iterator[Measurement]:
    """Scale and squareness."""
    yield seen.figure("marks", seen.placed.residual_mm, 0, MARK_MM, note="worst of four")
    for axis, got, wanted in zip("xy", seen.placed.scale, seen.scale, strict=True):
        yield seen.near(f"scale_{axis}", got, wanted, SCALE, "by the marks", unit="")


def measure_apertures(seen: Seen) -> Iterator[Measurement]:
    """The light of each cell's aperture: its centroid and its area."""
    rows, columns = np.nonzero(seen.regions >= _CELLS)
    cell = (seen.regions[rows, columns] - _CELLS) // 2
    light = 1 - seen.picture.ink[rows, columns]
    total, right, down = (
        np.bincount(cell, light * weight, len(seen.finger.cells))
        for weight in (1.0, columns + 0.5, rows + 0.5)
    )
    total = np.where(total > 0, total, math.nan)
    middles = np.stack([right, down], axis=1) / total[:, None]
    centres = seen.placed.points(seen.picture.points(middles))
    off = np.hypot(*(centres - np.array(seen.finger.cells)).T)
    yield seen.figure("position", off.max(), 0, PLACE_MM, note="worst aperture by its light")
    mask = seen.design.mask
    mm2 = total * seen.picture.pixel_mm.prod() / math.prod(seen.placed.scale)
    size = np.sqrt(mm2 / _SHARE[mask.hole_shape])
    yield seen.near("size", size, np.array(mask.holes_mm), SIZE_MM, "by its light")


def measure_black(seen: Seen) -> Iterator[Measurement]:
    """Black wherever no aperture and no window is; folds are dashes of grey near the edge."""
    light = 1 - seen.picture.ink
    wrong = (seen.regions == _EDGE) & (light > _FOLD_LIGHT)
    wrong |= (seen.regions == _BLACK) & (light > _CLEAR)
    yield seen.figure("black", seen.mm2(wrong), 0, WRONG_MM2, "mm²", "that is not black")


def measure_open(seen: Seen) -> Iterator[Measurement]:
    """Nothing printed in the apertures and in the connector's window."""
    clear = (seen.regions >= _CELLS) & (seen.regions % 2 != _CELLS % 2)
    wrong = (clear | (seen.regions == _WINDOW)) & (seen.picture.ink > _CLEAR)
    yield seen.figure("open", seen.mm2(wrong), 0, WRONG_MM2, "mm²", "that is not clear")


def measure_mirrored(seen: Seen) -> Iterator[Measurement]:
    """The letter F reads right in the sensor frame: its ink lies to the left and up."""
    box = seen.design.mask.mark
    corners = np.array([(box.x_min_mm, box.y_min_mm), (box.x_max_mm, box.y_max_mm)])
    ends = seen.picture.points(seen.pixels(corners))
    part = seen.picture.part(ends.min(axis=0) - _SOFT_MM, ends.max(axis=0) + _SOFT_MM)
    at = seen.placed.points(part.ink_middle_mm[None])[0]
    left, up = (corners.mean(axis=0) - at) / (box.width_mm, -box.length_mm)
    for name, share in (("stem", left), ("arms", up)):
        yield seen.figure("mirrored", share, 0.03, 0.5, "", "of its box, by its ink", at=name)


MEASURES: tuple[Measure[Seen], ...] = (
    measure_marks,
    measure_apertures,
    measure_black,
    measure_open,
    measure_mirrored,
)
