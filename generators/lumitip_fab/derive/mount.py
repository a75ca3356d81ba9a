"""The gripper coupling, from its catalogue entry."""

from lumitip_fab.catalogue import Gripper
from lumitip_fab.derive.boards import HOLE_TO_EDGE_MM, Plan
from lumitip_fab.derive.faults import Faults
from lumitip_fab.derive.letter import DEPTH_MM, LEAST_DEPTH_MM, LEAST_MM, WIDTH, letter_on
from lumitip_fab.derive.outline import half_width_at
from lumitip_fab.design import Letter, Mount, Nose, Outline
from lumitip_fab.load import Input

LETTER_MARGIN_MM = 0.6  # to the bed, and to where the ramp begins


def derive_mount(given: Input, outline: Outline, plan: Plan, faults: Faults) -> Mount:
    """The coupling, refused where finger and gripper do not go together."""
    p = given.parameters
    gripper = given.catalogue.grippers[p.coupling.gripper]
    plate = p.stack.floor_mm + p.stack.pcb_mm
    notch = plan.receiver.notch
    ramp = gripper.block_back_w_mm - plate
    opening = notch.y_max_mm - outline.end_y_mm
    length = gripper.land_mm + ramp
    faults.refuse_unless(
        length <= outline.length_mm - p.tip.slant_start_mm and opening < length,
        "coupling.gripper",
        f"{p.coupling.gripper!r} given, its block and 45° ramp need {length:.1f} mm of finger "
        f"beyond a wire notch of {opening:.1f} mm; the finger is {outline.length_mm:.1f} mm long",
    )
    waist = half_width_at(outline, outline.end_y_mm + length)
    faults.refuse_unless(
        waist >= gripper.block_width_mm / 2 + HOLE_TO_EDGE_MM,
        "coupling.gripper",
        f"{p.coupling.gripper!r} given, its block is {gripper.block_width_mm:g} mm wide and the "
        f"finger {2 * waist:.1f} mm",
    )
    faults.refuse_unless(
        ramp > 0,
        "stack.floor_mm",
        f"{p.stack.floor_mm:g} given, which makes a plate of {plate:g} mm; less than the "
        f"{gripper.block_back_w_mm:g} mm of the block of {p.coupling.gripper!r} is allowed",
    )
    nose = gripper.nose
    front = max(p.stack.pcb_mm + p.backing.tail_mm, nose.front_w_mm if nose else 0.0)
    most = gripper.bolt_w_mm - gripper.counterbore_mm / 2 - p.printer.min_wall_mm
    faults.refuse_unless(
        front <= most,
        "backing.tail_mm",
        f"{p.backing.tail_mm:g} given, which leaves no wall before the bolt's counterbore; at "
        f"most {most - p.stack.pcb_mm:.2f} is allowed",
    )
    return Mount(
        gripper=p.coupling.gripper,
        origin_y_mm=outline.end_y_mm,
        tilt_deg=gripper.tilt_deg,
        block_width_mm=gripper.block_width_mm,
        block_corner_mm=gripper.block_corner_mm,
        block_front_w_mm=front,
        block_back_w_mm=gripper.block_back_w_mm,
        bolt_w_mm=gripper.bolt_w_mm,
        bolt_hole_mm=gripper.bolt_hole_mm,
        counterbore_mm=gripper.counterbore_mm,
        land_mm=gripper.land_mm,
        pin_mm=gripper.pin_mm,
        pin_u_mm=(-gripper.pin_spacing_mm / 2, gripper.pin_spacing_mm / 2),
        pin_depth_mm=gripper.pin_depth_mm,
        seat_width_mm=gripper.seat_width_mm,
        nose=Nose(nose.front_width_mm, nose.front_w_mm, nose.half_angle_deg, nose.height_mm)
        if nose
        else None,
        stroke_mm=gripper.stroke_mm,
        pad_w_mm=gripper.pad_w_mm,
        letter=_letter(given, gripper, faults),
    )


def _letter(given: Input, gripper: Gripper, faults: Faults) -> Letter:
    """On the back of the block, between its rounded corners and below the ramp."""
    p = given.parameters
    behind = gripper.block_back_w_mm - gripper.bolt_w_mm - gripper.bolt_hole_mm / 2
    deep = behind - p.printer.min_wall_mm
    wide = gripper.block_width_mm - 2 * gripper.block_corner_mm
    low, high = LETTER_MARGIN_MM, gripper.land_mm - LETTER_MARGIN_MM
    faults.refuse_unless(
        min(high - low, wide / WIDTH) >= LEAST_MM and deep >= LEAST_DEPTH_MM,
        "coupling.gripper",
        f"{p.coupling.gripper!r} given, whose block has no room on its back for the letter that "
        f"tells the fingers apart: {wide:.1f} mm between its corners, {gripper.land_mm:g} mm of "
        f"land and {behind:.1f} mm of wall behind the bolt; at least {WIDTH * LEAST_MM:.1f}, "
        f"{LEAST_MM + 2 * LETTER_MARGIN_MM:g} and {p.printer.min_wall_mm + LEAST_DEPTH_MM:g} "
        "are needed",
    )
    middle, half = (low + high) / 2, min(high - low, wide / WIDTH) / 2
    return letter_on(middle - half, middle + half, min(deep, DEPTH_MM), gripper.block_back_w_mm)
