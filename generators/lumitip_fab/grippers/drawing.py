"""The drawing of the page that shows the gripper's body."""

import math

import numpy as np
import shapely

from lumitip_fab.catalogue.grippers import Gripper
from lumitip_fab.scenes.coupling_view import CUT, GAP_MM, PAPER
from lumitip_fab.scenes.dimensions import dimension_rows, line, pointers, rectangle, write
from lumitip_fab.scenes.drawing import Sheet

BODY_MM = 110.0  # length of a gripper on the page, or its width if that is more
_TIP_MM = 18.0  # length of the gripper's own fingertip on that page
_FINGER_MM = 12.0  # thickness of a finger in the drawing of the body


def body_drawing(gripper: Gripper) -> str:
    """The gripper's body from its end and from its side, as SVG."""
    body, sheet = gripper.envelope, Sheet()
    sizes = np.array(
        [body.width_mm, body.depth_mm, body.corner_mm, body.length_mm, gripper.stroke_mm]
    )
    scale = BODY_MM / max(body.reach_mm, body.width_mm)
    width, depth, corner, length, opening = (sizes * scale).tolist()
    reach, thick = scale * body.reach_mm, scale * _FINGER_MM
    inner = shapely.box(corner, corner - width / 2, depth - corner, width / 2 - corner)
    end = np.array(inner.buffer(corner, quad_segs=18).exterior.coords)
    left, tip = depth + 52.0, depth + 52.0 + reach + _TIP_MM
    sheet.area([end], "area", PAPER)
    sheet.area([rectangle((left, left + length), (-width / 2, width / 2))], "area", PAPER)
    for side in (-1, 1):
        pad = side * opening / 2
        finger = rectangle((left + length, left + reach), (pad, pad + side * thick))
        sheet.area([finger], "area", CUT)
        sheet.area([rectangle((left + reach, tip), (pad, pad + side * thick))], "area", PAPER)
        sheet.lines([rectangle((left + length, tip), (0.0, side * thick))], "axis")
    low = -max(width / 2, opening / 2 + thick)
    sheet.lines([line((-6.0, 0.0), (tip + 8.0, 0.0))], "axis")
    along = [
        ("envelope.length_mm", (left, -width / 2), (left + length, -width / 2)),
        ("envelope.reach_mm (closed)", (left, -width / 2), (left + reach, low)),
    ]
    dimension_rows(sheet, along, low - GAP_MM, -1)
    across = [("envelope.depth_mm", (0.0, -width / 2), (depth, -width / 2))]
    dimension_rows(sheet, across, low - GAP_MM, -1)
    up = [("envelope.width_mm", (0.0, -width / 2), (0.0, width / 2))]
    dimension_rows(sheet, up, -GAP_MM, -1, upright=True)
    open_ = [("stroke_mm", (tip, -opening / 2), (tip, opening / 2))]
    dimension_rows(sheet, open_, tip + GAP_MM, 1, upright=True)
    inset = corner * (1 - math.sqrt(0.5))
    corner_at = (depth - inset, width / 2 - inset)
    pointers(sheet, [("envelope.corner_mm", corner_at)], depth + 10.0, -low)
    sheet.lines([line((left - 4.0, 6.0), (left, 6.0))], "leader")
    sheet.dot(left, 6.0)
    write(sheet, (left - 38.0, 5.0), "face on the robot")
    own = [("its own fingertip", (tip, opening / 2 + thick / 2))]
    pointers(sheet, own, tip + GAP_MM + 8.0, -low)
    return sheet.svg({})
