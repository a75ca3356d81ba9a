"""The corner of the pocket on the fit test plate: where it is cut out of the backing."""

import math
from dataclasses import dataclass

import numpy as np

from lumitip_fab.derive.boards.boards import Plan
from lumitip_fab.design import Box, Fits, Mount, PocketCorner, Stack
from lumitip_fab.design.frames import applied, mount_to_sensor

SEAT_MM = 1.0  # of the pocket's floor beside its pin
BEHIND_MM = 2.5  # of a foot behind the plate
GUSSET = 0.8  # of the corner's height


@dataclass(frozen=True)
class Sizes:
    """What the printer and the coupling ask of a corner."""

    wall_mm: float
    lead_mm: float
    """Chamfer at the bed."""
    foot_mm: float
    """From the plate's back to the slice, at least: the head of a bolt goes there."""


def derive_corner(
    plan: Plan, stack: Stack, mount: Mount, steps: tuple[Fits, ...], sizes: Sizes
) -> PocketCorner:
    """The corner of the first coupon, with its left side at x = 0 and its front at y = 0.

    Args:
        plan: the boards; the receiver's hole at the tip, farthest to the left, has the pin.
        stack: heights of plate and pocket.
        mount: how the backing stands.
        steps: tightest first.
        sizes: of wall, chamfer and foot.
    """
    gap, reach = steps[-1].pocket_gap_mm, steps[0].pin_mm / 2 + SEAT_MM
    board = plan.board
    hole = min(plan.receiver.holes, key=lambda at: (-at[1], at[0]))
    inverse = np.asarray(np.linalg.inv(mount_to_sensor(mount, stack)), dtype=np.float64)
    tip_y = board.box.y_max_mm + gap + board.roof_mm
    marks = [(0.0, hole[1], stack.rim_z_mm), (0.0, tip_y, stack.rim_z_mm)]
    pin_h, roof_h = (float(h) for h in applied(inverse, np.array(marks))[:, 2])
    low = pin_h - reach - sizes.lead_mm
    left = board.box.x_min_mm - gap - sizes.wall_mm
    high = roof_h + sizes.wall_mm
    tilt = math.radians(mount.tilt_deg)
    thick = stack.plate_mm / math.cos(tilt)
    forward = (high - low) * math.tan(tilt)
    x_max = hole[0] + reach - left
    return PocketCorner(
        origin_mm=(-left, high * math.tan(tilt), -low),
        x_min_mm=0.0,
        x_max_mm=x_max,
        wall_mm=sizes.wall_mm,
        height_mm=high - low,
        foot=Box(0.0, x_max, forward, forward + thick + max(BEHIND_MM, sizes.foot_mm)),
        gusset_mm=(BEHIND_MM, GUSSET * (high - low)),
        lead_mm=sizes.lead_mm,
        pin=hole,
    )


def corner_mm3(corner: PocketCorner, fits: Fits, stack: Stack, board: Box, foot_mm: float) -> float:
    """Volume of a corner without chamfers.

    Args:
        corner: the corner.
        fits: its gap and pin.
        stack: heights of plate and pocket.
        board: the board in the pocket.
        foot_mm: thickness of the foot.
    """
    width, high = corner.x_max_mm - corner.x_min_mm, corner.height_mm
    plate = width * high * stack.plate_mm
    inner = corner.origin_mm[0] + board.x_min_mm - fits.pocket_gap_mm
    open_mm = corner.height_mm - corner.wall_mm - stack.pcb_mm / 2
    pocket = (corner.x_max_mm - inner) * open_mm * stack.pcb_mm
    pin = math.pi / 4 * fits.pin_mm**2 * stack.pcb_mm
    behind = corner.foot.length_mm - stack.plate_mm
    reach, up = corner.gusset_mm
    gussets = corner.wall_mm * reach * (up - foot_mm)  # two triangles
    return plate - pocket + pin + behind * width * foot_mm + gussets
