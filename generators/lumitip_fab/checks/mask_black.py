"""The black of a mask on a picture: its apertures and all that is between them against the design's
cells and outline."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from lumitip_fab.checks.mask_holes import Placed
from lumitip_fab.checks.readers.mask_page import Points
from lumitip_fab.checks.readers.pixels import Picture
from lumitip_fab.checks.result import Measure, Measurement, Subject
from lumitip_fab.design import Box, Design, Finger
from lumitip_fab.design.making import FOLD_OFF_MM

Labels = NDArray[np.uint16]

MARK_MM = 0.01
SCALE = 0.001
PLACE_MM = 0.01
SIZE_MM = 0.02
WRONG_MM2 = 0.0005
"""Of black that lets light through, or of an opening that is not clear: a third of a pixel."""
_SOFT_MM = 0.11  # of grey pixels on each side of an edge
_ROUND_MM = 0.15  # whose light is that of an aperture; webs are wider than two
_FOLD_MM = 0.15  # from the middle of a fold's dashes to bare black
_FOLD_LIGHT = 0.6  # of their grey
_CLEAR = 0.02  # of black or of light that may be missing in a pixel
_SHARE = {"circle": math.pi / 4, "hexagon": math.sqrt(3) / 2}
"""Area of an aperture of unit size."""


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

    def pixels(self, shape: shapely.Geometry) -> list[Points]:
        """Rings of a shape in the sensor frame as columns and rows of the picture."""
        scale = np.array(self.placed.scale) * (-1, 1)
        rings = [p.exterior.coords for p in shapely.get_parts(shape)]
        return [self.picture.pixels(np.array(r) * scale + self.placed.origin) for r in rings]

    def labels(self, shapes: list[tuple[shapely.Geometry, int]]) -> Labels:
        """The picture with shapes of the sensor frame filled with numbers, one over another."""
        image = Image.new("I;16", self.picture.grey.shape[::-1])
        draw = ImageDraw.Draw(image)
        for shape, number in shapes:
            for ring in self.pixels(shape):
                # A pixel's middle is a whole number to what fills it.
                draw.polygon([tuple(p) for p in (ring - 0.5).tolist()], fill=number)
        return np.asarray(image)

    def mm2(self, wrong: NDArray[np.bool_]) -> float:
        """Area of pixels."""
        return float(np.count_nonzero(wrong) * self.picture.pixel_mm.prod())


def measure_marks(seen: Seen) -> Iterator[Measurement]:
    """Scale and squareness."""
    yield seen.figure("marks", seen.placed.residual_mm, 0, MARK_MM, note="worst of four")
    for axis, got, wanted in zip("xy", seen.placed.scale, seen.scale, strict=True):
        yield seen.near(f"scale_{axis}", got, wanted, SCALE, "by the marks", unit="")


def measure_apertures(seen: Seen) -> Iterator[Measurement]:
    """The light in and round each cell's aperture: its centroid and its area."""
    holes = _apertures(seen)
    labels = seen.labels([(h, n) for n, h in enumerate(shapely.buffer(holes, _ROUND_MM), 1)])
    rows, columns = np.nonzero(labels)
    light = 1 - seen.picture.ink[rows, columns]
    total, right, down = (
        np.bincount(labels[rows, columns], light * weight, len(holes) + 1)[1:]
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
    outline = shapely.Polygon(seen.design.outline.polygon(96)).buffer(seen.design.mask.allowance_mm)
    near, inside = (outline.buffer(-by) for by in (_SOFT_MM, FOLD_OFF_MM + _FOLD_MM))
    openings = shapely.buffer([*_apertures(seen), _area(seen.finger.window)], _SOFT_MM)
    labels = seen.labels([(near, 1), (inside, 2), *((o, 0) for o in openings)])
    light = 1 - seen.picture.ink
    wrong = ((labels == 1) & (light > _FOLD_LIGHT)) | ((labels == 2) & (light > _CLEAR))
    yield seen.figure("black", seen.mm2(wrong), 0, WRONG_MM2, "mm²", "that is not black")


def measure_open(seen: Seen) -> Iterator[Measurement]:
    """Nothing printed in the apertures and in the connector's window."""
    shapes = shapely.buffer([*_apertures(seen), _area(seen.finger.window)], -_SOFT_MM)
    wrong = (seen.labels([(s, 1) for s in shapes]) == 1) & (seen.picture.ink > _CLEAR)
    yield seen.figure("open", seen.mm2(wrong), 0, WRONG_MM2, "mm²", "that is not clear")


def measure_mirrored(seen: Seen) -> Iterator[Measurement]:
    """The letter F reads right in the sensor frame: its ink lies to the left and up."""
    box = seen.design.mask.mark
    labels = seen.labels([(_area(box).buffer(_ROUND_MM), 1)])
    ink = seen.picture.ink * (labels == 1)
    rows, columns = np.nonzero(ink > _CLEAR)
    middle = [np.average(at + 0.5, weights=ink[rows, columns]) for at in (columns, rows)]
    at = seen.placed.points(seen.picture.points(np.array([middle])))[0]
    left, up = (_middle(box) - at) / (box.width_mm, -box.length_mm)
    for name, share in (("stem", left), ("arms", up)):
        yield seen.figure("mirrored", share, 0.03, 0.5, "", "of its box, by its ink", at=name)


MEASURES: tuple[Measure[Seen], ...] = (
    measure_marks,
    measure_apertures,
    measure_black,
    measure_open,
    measure_mirrored,
)


def _apertures(seen: Seen) -> list[shapely.Polygon]:
    """The apertures by the design, in the sensor frame."""
    mask = seen.design.mask
    corners, grow = (64, 1.0) if mask.hole_shape == "circle" else (6, 2 / math.sqrt(3))
    turn = 2 * math.pi / corners * np.arange(corners)
    unit = np.stack([np.cos(turn), np.sin(turn)], axis=1) * grow / 2
    return [
        shapely.Polygon(unit * size + np.array(at))
        for at, size in zip(seen.finger.cells, mask.holes_mm, strict=True)
    ]


def _middle(box: Box) -> Points:
    return np.array([box.x_min_mm + box.x_max_mm, box.y_min_mm + box.y_max_mm]) / 2


def _area(box: Box) -> shapely.Polygon:
    return shapely.box(*box.bounds_mm)
