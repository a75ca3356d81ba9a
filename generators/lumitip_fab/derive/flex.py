"""A compliant finger: how its interface lies on the plate, and what that does to the coupling."""

import math

from lumitip_fab.derive.faults import Faults
from lumitip_fab.derive.letter import MOST_MM, letter_on
from lumitip_fab.design import Box, Finger, Interface, Outline
from lumitip_fab.gripper_entry import Gripper
from lumitip_fab.load import Input
from lumitip_fab.parameters import Parameters

LETTER_DEPTH_MM = 0.4
CARRIER_MM = 1.6  # of boards that are not flexible, where those of the fingers are
LETTER_GAP_MM = 1.5  # interface to the letter, and letter to the wedge
COVERED_MM = 0.5  # board round a thread hole, which else lets silicone through
FLARE_MM = 2.2  # of the interface beyond land and ramp: where the ramp flares into the pad


def is_flex(p: Parameters) -> bool:
    """Whether the plate bends."""
    return p.backing.variant == "flex"


def held_by(given: Input) -> Gripper:
    """The gripper as this finger meets it: a compliant one leans farther in, and is farther from
    the bolts, because the interface's pad lies behind its plate."""
    p = given.parameters
    gripper = given.catalogue.grippers[p.coupling.gripper]
    if not is_flex(p):
        return gripper
    back, nose = p.flex.standoff_mm, gripper.nose
    moved = {
        "tilt_deg": gripper.tilt_deg + p.flex.lean_deg,
        "bolt_w_mm": gripper.bolt_w_mm + back,
        "block_back_w_mm": gripper.block_back_w_mm + back,
        "nose": nose and nose.model_copy(update={"front_w_mm": nose.front_w_mm + back}),
    }
    return gripper.model_copy(update=moved)


def behind_mm(p: Parameters) -> float:
    """From the board's front to where the coupling's block begins."""
    return p.stack.pcb_mm + p.stack.floor_mm + (p.flex.pad_mm if is_flex(p) else 0.0)


def stiff_mm(p: Parameters) -> float:
    """Thickness of the boards outside the fingers."""
    return CARRIER_MM if is_flex(p) else p.stack.pcb_mm


def foot_half_mm(given: Input, notch_half_mm: float) -> float:
    """Half the width of what stands on the plate's back: the groove of an interface, whose legs
    run beside the notch, or else the coupling's block."""
    p = given.parameters
    if is_flex(p):
        return notch_half_mm + p.printer.min_wall_mm + p.flex.groove_mm
    return given.catalogue.grippers[p.coupling.gripper].block_width_mm / 2


def derive_interfaces(
    given: Input, outline: Outline, finger: Finger, board: Box, faults: Faults
) -> tuple[Interface, ...]:
    """The interface of each finger; none of a rigid one.

    Args:
        given: the parameters.
        outline: of the plate.
        finger: either of them: its wire notch is between the legs of the groove.
        board: its edge.
        faults: where to refuse.
    """
    p, flex = given.parameters, given.parameters.flex
    if not is_flex(p):
        return ()
    _refuse_heights(given, faults)
    _refuse_holes(given, finger, board, faults)
    half = foot_half_mm(given, finger.notch.x_max_mm)
    end_y = outline.end_y_mm
    groove = Box(-half, half, end_y, end_y + flex.interface_mm)
    gripper = held_by(given)
    tilt = math.radians(45 - gripper.tilt_deg)
    ramp = (gripper.block_back_w_mm - behind_mm(p)) / math.tan(tilt)
    least = gripper.land_mm + ramp + FLARE_MM
    most = outline.length_mm - p.tip.slant_start_mm - 2 * LETTER_GAP_MM - MOST_MM
    faults.refuse_unless(
        least <= flex.interface_mm <= most,
        "flex.interface_mm",
        f"{flex.interface_mm:g} given, at least {least:.1f} is needed for the land and ramp of "
        f"{p.coupling.gripper!r}, and at most {most:.1f} is allowed: then come the finger's "
        "letter and the wedge",
    )
    low = groove.y_max_mm + LETTER_GAP_MM - end_y
    back = p.stack.pcb_mm + p.stack.floor_mm
    letter = letter_on(low, low + MOST_MM, LETTER_DEPTH_MM, back)
    return (
        Interface(
            groove, flex.groove_mm, flex.groove_depth_mm, flex.glue_mm, flex.pad_mm,
            flex.thread_hole_mm, letter,
        ),
    )  # fmt: skip


def _refuse_holes(given: Input, finger: Finger, board: Box, faults: Faults) -> None:
    """Refuse holes for thread that the board does not cover."""
    wide = given.parameters.flex.thread_hole_mm
    to_edge = min(
        min(x - board.x_min_mm, board.x_max_mm - x, y - board.y_min_mm, board.y_max_mm - y)
        for x, y in finger.holes
    )
    most = 2 * (to_edge - COVERED_MM)
    faults.refuse_unless(
        wide <= most + 1e-9,
        "flex.thread_hole_mm",
        f"{wide:g} given, the board's edge is {to_edge:.2f} mm from the middle of such a hole: at "
        f"most {most:.2f} is allowed, so that no silicone runs past the board",
    )


def _refuse_heights(given: Input, faults: Faults) -> None:
    """Refuse what does not go into plate, pad and groove."""
    p, flex = given.parameters, given.parameters.flex
    line_mm = given.catalogue.printers[p.printer.profile].line_mm
    nose = given.catalogue.grippers[p.coupling.gripper].nose
    left = p.stack.floor_mm - flex.groove_depth_mm
    rim = flex.groove_mm - 2 * flex.glue_mm
    reach = behind_mm(p) - flex.standoff_mm
    for holds, field, message in (
        (left >= p.printer.min_wall_mm - 1e-9, "flex.groove_depth_mm",
         f"{flex.groove_depth_mm:g} given, which leaves {left:.2f} mm of plate before the groove; "
         f"at least {p.printer.min_wall_mm:g} is needed"),
        (rim >= 2 * line_mm - 1e-9, "flex.groove_mm",
         f"{flex.groove_mm:g} given, which leaves a rim of {rim:.2f} mm between gaps of "
         f"{flex.glue_mm:g}; at least two printed lines of {line_mm:g} are needed"),
        (flex.groove_depth_mm - flex.glue_mm >= 2 * line_mm / 3, "flex.groove_depth_mm",
         f"{flex.groove_depth_mm:g} given, which leaves a rim "
         f"{flex.groove_depth_mm - flex.glue_mm:.2f} mm high; at least {2 * line_mm / 3:g} is "
         "needed"),
        (flex.pad_mm >= p.printer.min_wall_mm - 1e-9, "flex.pad_mm",
         f"{flex.pad_mm:g} given, at least printer.min_wall_mm = {p.printer.min_wall_mm:g} is "
         "needed"),
        (p.backing.tail_mm <= p.stack.floor_mm, "backing.tail_mm",
         f"{p.backing.tail_mm:g} given, at most stack.floor_mm = {p.stack.floor_mm:g} is allowed: "
         "behind a bendable plate lies the interface"),
        (nose is None or reach <= nose.front_w_mm + 1e-9, "flex.standoff_mm",
         f"{flex.standoff_mm:g} given, at least "
         f"{behind_mm(p) - (nose.front_w_mm if nose else 0.0):g} is needed: board, plate and pad "
         f"must end before the nose of {p.coupling.gripper!r}"),
    ):  # fmt: skip
        faults.refuse_unless(holds, field, message)
