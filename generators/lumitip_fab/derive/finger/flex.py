"""A compliant finger: what an interface behind its plate does to coupling and boards."""

from lumitip_fab.catalogue.grippers import Gripper
from lumitip_fab.config.load import Input
from lumitip_fab.config.parameters import Parameters

CARRIER_MM = 1.6  # of boards that are not flexible, where those of the fingers are


def is_flex(p: Parameters) -> bool:
    """Whether the plate bends."""
    return p.backing.variant == "flex"


def held_by(config: Input) -> Gripper:
    """The gripper as this finger meets it: a compliant one leans farther in, and is farther from
    the bolts, because the interface's pad lies behind its plate."""
    p = config.parameters
    gripper = config.catalogue.grippers[p.coupling.gripper]
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


def foot_half_mm(config: Input, notch_half_mm: float) -> float:
    """Half the width of what stands on the plate's back: the groove of an interface, whose legs
    run beside the notch, or else the coupling's block."""
    p = config.parameters
    if is_flex(p):
        return notch_half_mm + p.printer.min_wall_mm + p.flex.groove_mm
    return config.catalogue.grippers[p.coupling.gripper].block_width_mm / 2
