"""Layout of the fit test plate."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.boards import Plan
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.making.fit_corner import Sizes, corner_mm3, derive_corner
from lumitip_fab.derive.making.fits import derive_fits
from lumitip_fab.design import Box, FitPlate, Fits, Mount, PocketCorner, Stack

STEPS_MM = (-0.1, -0.05, 0.0, 0.05, 0.1)
LAYERS = 4  # height of a foot and a slice
LEAD_LAYERS = 2  # of a corner's chamfer at the bed
SLEEVE_LAYERS = 4  # of a sleeve, and as many of the bolt's hole above it
LINES = 2  # of walls
FLANK_MM = 3.0  # of a nose's flanks, at least, along w
CHARACTERS = 3  # of a value
LABEL_MM = 3.0  # its height
LABEL_LAYERS = 2  # its depth
DIGIT_WIDTH = 0.6  # of the height
DIGIT_PITCH = 0.85
LABEL_WIDE_MM = ((CHARACTERS - 1) * DIGIT_PITCH + DIGIT_WIDTH) * LABEL_MM
MARGIN_MM = 0.6
ROW_MM = LABEL_MM + 2 * MARGIN_MM
APART_MM = 0.8  # between coupons


def derive_fit_plate(
    config: Input, plan: Plan, stack: Stack, mount: Mount, faults: Diagnostics
) -> FitPlate:
    """The plate; refused where it is larger than the bed."""
    printer = config.parts.printer.profile
    wall, layers_mm = LINES * printer.line_mm, LAYERS * printer.layer_mm
    sleeve_mm = SLEEVE_LAYERS * printer.layer_mm
    steps = tuple(derive_fits(config, step) for step in STEPS_MM)
    part, label_w = _slice(mount, steps[-1], wall)
    head_mm = mount.bolt_w_mm + mount.counterbore_mm / 2 - part.y_max_mm
    sizes = Sizes(
        max(wall, config.parameters.printer.min_wall_mm), LEAD_LAYERS * printer.layer_mm, head_mm
    )
    corners: tuple[PocketCorner, ...] = (
        (derive_corner(plan, stack, mount, steps, sizes),) if stack.sunk else ()
    )
    width = max(part.width_mm, *(corner.x_max_mm for corner in corners), 0.0)
    corners = tuple(_centred(corner, width) for corner in corners)
    front_y = sum(corner.foot.y_max_mm for corner in corners)
    at = (width / 2 + part.centre_mm[0], front_y + part.y_max_mm)
    middle, low = width / 2, at[1] - label_w - LABEL_MM
    plate = FitPlate(
        steps=steps,
        pitch_mm=width + APART_MM,
        width_mm=width,
        corners=corners,
        label=Box(middle - LABEL_WIDE_MM / 2, middle + LABEL_WIDE_MM / 2, low, low + LABEL_MM),
        label_mm=LABEL_LAYERS * printer.layer_mm,
        slice=part,
        slice_at=at,
        thickness_mm=2 * sleeve_mm if mount.sleeved else layers_mm,
        pin_depth_mm=sleeve_mm if mount.sleeved else layers_mm,
        volume_ml=0.0,
    )
    wide, deep, _ = plate.size_mm
    bed = printer.bed_mm
    faults.unless(
        wide <= bed[0] and deep <= bed[1],
        "fit_plate_beyond_bed",
        width=wide,
        depth=deep,
        bed_x=bed[0],
        bed_y=bed[1],
    )
    return replace(plate, volume_ml=_volume_mm3(plate, stack, mount, plan.board.box) / 1000)


def _centred(corner: PocketCorner, width_mm: float) -> PocketCorner:
    """A corner in the middle of its coupon."""
    by, (x, y, z) = (width_mm - corner.x_max_mm) / 2, corner.origin_mm
    foot = replace(
        corner.foot, x_min_mm=corner.foot.x_min_mm + by, x_max_mm=corner.foot.x_max_mm + by
    )
    return replace(
        corner,
        origin_mm=(x + by, y, z),
        x_min_mm=corner.x_min_mm + by,
        x_max_mm=corner.x_max_mm + by,
        foot=foot,
    )


def _slice(mount: Mount, loosest: Fits, wall_mm: float) -> tuple[Box, float]:
    """The part of the coupling that each step shows, and the w at which its value begins: before
    the holes where there is room, else behind them.

    All bolts and pins where there is a seat or pins beside the bolt, else what is round one bolt.
    """
    hole = max(loosest.bolt_hole_mm, loosest.gripper_pin_mm) / 2
    before, behind = mount.bolt_w_mm - hole, mount.bolt_w_mm + hole
    if mount.nose is None and (mount.sleeved or not mount.pin_u_mm):
        u, half = mount.bolt_u_mm[-1], max(hole + wall_mm, LABEL_WIDE_MM / 2 + MARGIN_MM)
        return Box(
            u - half, u + half, before - ROW_MM, behind + wall_mm
        ), before - ROW_MM + MARGIN_MM
    half = mount.block_width_mm / 2
    front = min(before - ROW_MM, _flanks_end_w(mount) - FLANK_MM)
    if front >= mount.block_front_w_mm and _is_wide(mount, front + MARGIN_MM):
        return Box(-half, half, front, behind + wall_mm), front + MARGIN_MM
    front = max(mount.block_front_w_mm, min(before - wall_mm, _flanks_end_w(mount) - FLANK_MM))
    return Box(-half, half, front, behind + ROW_MM), behind + MARGIN_MM


def _flanks_end_w(mount: Mount) -> float:
    """The w at which the nose is as wide as the block."""
    if mount.nose is None:
        return math.inf
    wider = mount.block_width_mm - mount.nose.front_width_mm
    return mount.nose.front_w_mm + wider / 2 / math.tan(math.radians(mount.nose.half_angle_deg))


def _is_wide(mount: Mount, w_mm: float) -> bool:
    """Whether the coupling has room for a value from w on."""
    return float(_width_mm(mount, np.array([w_mm]))[0]) >= LABEL_WIDE_MM + 2 * MARGIN_MM


def _width_mm(mount: Mount, w_mm: NDArray[np.float64]) -> NDArray[np.float64]:
    """Width of the block and its nose at w."""
    wide = np.full(len(w_mm), mount.block_width_mm)
    if mount.nose:
        spread = (
            2 * (w_mm - mount.nose.front_w_mm) * math.tan(math.radians(mount.nose.half_angle_deg))
        )
        wide = np.minimum(wide, mount.nose.front_width_mm + spread)
    return wide


def _volume_mm3(plate: FitPlate, stack: Stack, mount: Mount, board: Box) -> float:
    """Corners and slices, without engraving and chamfers."""
    slices = sum(_slice_mm3(plate, fits.of(mount)) for fits in plate.steps)
    return slices + sum(
        corner_mm3(corner, fits, stack, board, plate.thickness_mm)
        for fits in plate.steps
        for corner in plate.corners
    )


def _slice_mm3(plate: FitPlate, drawn: Mount) -> float:
    """A slice of the coupling less its holes."""
    box, quarter, thick = plate.slice, math.pi / 4, plate.thickness_mm
    w = np.linspace(box.y_min_mm, box.y_max_mm, 200)
    flat = float(np.minimum(_width_mm(drawn, w), box.width_mm).mean()) * box.length_mm
    bolts = sum(box.x_min_mm < u < box.x_max_mm for u in drawn.bolt_u_mm)
    deep = plate.pin_depth_mm if drawn.sleeved else 0.0
    bolt = quarter * (drawn.bolt_hole_mm**2 * (thick - deep) + drawn.pin_mm**2 * deep)
    pins = 0 if drawn.sleeved else len(drawn.pin_u_mm)
    return flat * thick - bolts * bolt - pins * quarter * drawn.pin_mm**2 * thick
