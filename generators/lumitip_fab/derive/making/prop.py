"""The prop that tilts a mould, as high as the lip of silicone on the back of the tip needs it."""

import math

from lumitip_fab.design import Box, Outline, Tip
from lumitip_fab.design.making import FOOT_CHAMFER_MM
from lumitip_fab.design.prop import Prop

REACH_MM = 5.0  # under the mould
BEHIND_MM = 0.2  # from the mould's end to the stop
STOP_MM = 2.0  # thick
STOP_HEIGHT_MM = 3.0
LEAST_HALF_MM = 6.0


def derive_prop(
    lip_mm: float,
    outline: Outline,
    tip: Tip,
    ends_mm: tuple[float, float, float],
    half_mm: float,
    layer_mm: float,
) -> Prop:
    """The prop of a mould.

    Args:
        lip_mm: silicone on the back of the plate where its edge is set back, at least.
        outline: of the plate.
        tip: its wedge, with slots.
        ends_mm: y of the weir's outer edge, of the mould's end there and of its end at the tip.
        half_mm: half its width, if that is more than the least.
        layer_mm: of the print.
    """
    weir_y, end_y, tip_y = ends_mm
    slot_y = outline.tip_y_mm - tip.slot_mm
    level = tip.edge_mm + tip.slot_mm * tip.slope + lip_mm
    inner_y = end_y + REACH_MM
    arm = tip_y - FOOT_CHAMFER_MM - inner_y
    layers = math.ceil(level / (slot_y - weir_y) * arm / layer_mm - 1e-9)
    height = round(layers * layer_mm, 6)
    half, behind = max(half_mm, LEAST_HALF_MM), end_y - BEHIND_MM
    return Prop(
        name="prop",
        plate=Box(-half, half, behind - STOP_MM, inner_y),
        height_mm=height,
        stop=Box(-half, half, behind - STOP_MM, behind),
        stop_mm=round(math.ceil(STOP_HEIGHT_MM / layer_mm - 1e-9) * layer_mm, 6),
        tilt_deg=math.degrees(math.atan2(height, arm)),
        lip_mm=lip_mm,
        weir_y_mm=weir_y,
    )
