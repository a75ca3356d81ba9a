"""The fit test plate on the bed: what is tried on each coupon, and where its value is."""

import numpy as np

from lumitip_fab.design import FitPlate
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.drawing import Points, Sheet, View, silhouette, view, visible_lines
from lumitip_fab.scenes.glb import tints

AZIMUTH_DEG, ELEVATION_DEG = -8.0, 46.0
SCALE = 1.5
_WORDS_MM = 50.0
_IN_MM = 4.0  # from a corner's side to where a label points at
_VALUE_DOWN_MM = 7.0  # of a value below its coupon's front edge


def plate_view(printed: Mesh, plate: FitPlate) -> str:
    """The coupons from in front and above, each with its value below it.

    Args:
        printed: the plate in the frame of its bed.
        plate: for its steps and their places.
    """
    sheet, eye = Sheet(), view(AZIMUTH_DEG, ELEVATION_DEG).enlarged(SCALE)
    sheet.area(silhouette(printed, eye), "body", tints()["backing"])
    sheet.lines(visible_lines([printed], eye)[0], "line")
    for step in range(len(plate.steps)):
        x, y = _at(eye, step * plate.pitch_mm + plate.width_mm / 2, 0.0, 0.0)
        sheet.words(x, y - _VALUE_DOWN_MM, plate.label_of(step), "number", "middle")
    sheet.cover(float(sheet.low[0]), float(sheet.low[1]) - _VALUE_DOWN_MM)
    last = len(plate.steps) - 1
    x_mm, label, part = last * plate.pitch_mm, plate.label, plate.slice
    value = label.centre_mm[0] + x_mm, label.centre_mm[1], plate.thickness_mm
    side = plate.slice_at[0] - part.x_min_mm + x_mm, plate.slice_at[1] - part.centre_mm[1]
    labels = [
        (("Value", "of the coupon, in 0.01 mm"), _at(eye, *value)),
        (
            ("Slice", "for a finger bolt and the gripper's pins"),
            _at(eye, *side, plate.thickness_mm),
        ),
    ]
    for corner in plate.corners:
        face = corner.x_max_mm + x_mm - _IN_MM, corner.origin_mm[1], corner.height_mm / 2
        labels.append((("Corner", "a board goes in here, its tip up"), _at(eye, *face)))
    sheet.leaders_beside(labels, _WORDS_MM)
    return sheet.svg({"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": ELEVATION_DEG})


def _at(eye: View, x_mm: float, y_mm: float, z_mm: float) -> Points:
    """A place of the bed on the page."""
    return np.asarray(eye.seen(np.array([[x_mm, y_mm, z_mm]]))[0, :2])
