"""The gripper coupling, from its catalogue entry, and how the two fingers meet."""

import math

from lumitip_fab.catalogue.grippers import Gripper
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.boards import HOLE_TO_EDGE_MM, Plan
from lumitip_fab.derive.faults import Faults
from lumitip_fab.derive.finger.flex import behind_mm, held_by, is_flex
from lumitip_fab.derive.finger.outline import (
    DEPTH_MM,
    LEAST_DEPTH_MM,
    WIDTH,
    least_letter_mm,
    letter_on,
)
from lumitip_fab.derive.making.fits import derive_fits
from lumitip_fab.design import Closing, Letter, Mould, Mount, Outline, Stack

LETTER_MARGIN_MM = 0.6  # or a printed line, to the bed, and to where the ramp begins


def derive_mount(config: Input, outline: Outline, plan: Plan, faults: Faults) -> Mount:
    """The coupling, refused where finger and gripper do not go together."""
    p = config.parameters
    gripper = held_by(config)
    _refuse_place(config, gripper, outline, plan, faults)
    _refuse_holes(config, gripper, faults)
    nose, fits = gripper.nose, derive_fits(config, p.printer.fit_mm)
    field, value = "backing.tail_mm", p.backing.tail_mm
    if is_flex(p):
        field, value = "flex.pad_mm", p.flex.pad_mm
    before = p.stack.pcb_mm + (p.stack.floor_mm if is_flex(p) else 0.0)
    front = max(before + value, nose.front_w_mm if nose else 0.0)
    most = gripper.bolt_w_mm - gripper.counterbore_mm / 2 - p.printer.min_wall_mm
    faults.refuse_unless(
        front <= most,
        field,
        f"is {value:g}, which leaves no wall before the counterbore of the bolt; at "
        f"most {most - before:.2f} is allowed",
    )
    pins = gripper.pins
    return Mount(
        gripper=p.coupling.gripper,
        title=config.title("coupling.gripper"),
        origin_y_mm=outline.end_y_mm,
        tilt_deg=gripper.tilt_deg,
        block_width_mm=gripper.block_width_mm,
        block_corner_mm=gripper.block_corner_mm,
        block_front_w_mm=front,
        block_back_w_mm=gripper.block_back_w_mm,
        bolt=gripper.bolt,
        bolt_u_mm=_side_by_side(gripper.bolt_spacing_mm) or (0.0,),
        bolt_w_mm=gripper.bolt_w_mm,
        bolt_hole_mm=fits.bolt_hole_mm,
        counterbore_mm=gripper.counterbore_mm,
        land_mm=gripper.land_mm,
        pin_mm=fits.gripper_pin_mm,
        pin_u_mm=_side_by_side(pins.spacing_mm if pins else None),
        pin_depth_mm=pins.depth_mm if pins else 0.0,
        seat_width_mm=gripper.seat_width_mm,
        nose=fits.nose,
        stroke_mm=gripper.stroke_mm,
        pad_w_mm=gripper.pad_w_mm,
        letter=_letter(config, gripper, faults),
        unsure=gripper.unsure,
    )


def _side_by_side(spacing_mm: float | None) -> tuple[float, ...]:
    return () if spacing_mm is None else (-spacing_mm / 2, spacing_mm / 2)


def _refuse_place(
    config: Input, gripper: Gripper, outline: Outline, plan: Plan, faults: Faults
) -> None:
    """Refuse a block that does not stand on this finger's back."""
    p = config.parameters
    plate = behind_mm(p)
    ramp = gripper.block_back_w_mm - plate
    opening = plan.receiver.notch.y_max_mm - outline.end_y_mm
    length = gripper.land_mm + ramp
    faults.refuse_unless(
        length <= outline.length_mm - p.tip.slant_start_mm and opening < length,
        "coupling.gripper",
        f"is {p.coupling.gripper!r}; its block and 45° ramp need {length:.1f} mm of finger "
        f"beyond a wire notch of {opening:.1f} mm; the finger is {outline.length_mm:.1f} mm long",
    )
    waist = outline.half_width_at(outline.end_y_mm + length)
    faults.refuse_unless(
        waist >= gripper.block_width_mm / 2 + HOLE_TO_EDGE_MM,
        "coupling.gripper",
        f"is {p.coupling.gripper!r}; its block is {gripper.block_width_mm:g} mm wide, the finger "
        f"only {2 * waist:.1f} mm; {HOLE_TO_EDGE_MM:g} mm on each side is needed",
    )
    faults.refuse_unless(
        ramp > 0,
        "stack.floor_mm",
        f"is {p.stack.floor_mm:g}, which makes a plate of {plate:g} mm; less than the "
        f"{gripper.block_back_w_mm:g} mm of the block of {p.coupling.gripper!r} is allowed",
    )


def _refuse_holes(config: Input, gripper: Gripper, faults: Faults) -> None:
    """Refuse holes that leave too little of the block between them and round them."""
    p, pins = config.parameters, gripper.pins
    head, hole = gripper.counterbore_mm / 2, gripper.bolt_hole_mm / 2 + p.printer.fit_mm
    apart = gripper.bolt_spacing_mm
    line_mm = config.catalogue.printers[p.printer.profile].line_mm
    walls = (
        ("behind its counterbores", gripper.block_back_w_mm - gripper.bolt_w_mm - head, None),
        ("beside its counterbores", gripper.block_width_mm / 2 - (apart or 0.0) / 2 - head, None),
        ("between its counterbores", apart - 2 * head if apart else math.inf, None),
        ("at its corners", _corner_wall_mm(gripper, head), None),
        ("round the bolts under their heads", head - hole, line_mm),
        ("over the pins", gripper.land_mm - (pins.depth_mm if pins else 0.0), None),
        ("between bolts and pins", _to_pins_mm(gripper, p.printer.fit_mm), line_mm),
    )
    for place, wall, printed in walls:
        least = p.printer.min_wall_mm if printed is None else printed
        faults.refuse_unless(
            wall >= least - 1e-9,
            "coupling.gripper",
            f"is {p.coupling.gripper!r}, whose block has {wall:.2f} mm of wall {place}; at "
            f"least {least:g} mm is needed",
        )


def _to_pins_mm(gripper: Gripper, fit_mm: float) -> float:
    """Wall between a bolt's hole and a pin's beside it; none where the pins are sleeves."""
    pins, bolts = gripper.pins, gripper.bolt_spacing_mm or 0.0
    if pins is None or pins.spacing_mm == bolts:
        return math.inf
    return abs(pins.spacing_mm - bolts) / 2 - (pins.hole_mm + gripper.bolt_hole_mm) / 2 - 2 * fit_mm


def _corner_wall_mm(gripper: Gripper, head_mm: float) -> float:
    """Wall between a counterbore and the rounded corner of the block's back."""
    radius = gripper.block_corner_mm
    across = (gripper.bolt_spacing_mm or 0.0) / 2 - (gripper.block_width_mm / 2 - radius)
    back = gripper.bolt_w_mm - (gripper.block_back_w_mm - radius)
    if across <= 0 or back <= 0:
        return math.inf  # the straight sides are nearer
    return radius - math.hypot(across, back) - head_mm


def _letter(config: Input, gripper: Gripper, faults: Faults) -> Letter:
    """On the back of the block, between its rounded corners and below the ramp."""
    p = config.parameters
    hole = max(gripper.bolt_hole_mm, gripper.pins.hole_mm if gripper.pins else 0.0)
    behind = gripper.block_back_w_mm - gripper.bolt_w_mm - hole / 2 - p.printer.fit_mm
    deep = behind - p.printer.min_wall_mm
    wide = gripper.block_width_mm - 2 * gripper.block_corner_mm
    line_mm = config.catalogue.printers[p.printer.profile].line_mm
    least, margin = least_letter_mm(line_mm), max(LETTER_MARGIN_MM, line_mm)
    low, high = margin, gripper.land_mm - margin
    faults.refuse_unless(
        min(high - low, wide / WIDTH) >= least and deep >= LEAST_DEPTH_MM,
        "coupling.gripper",
        f"is {p.coupling.gripper!r}, whose block has no room on its back for the letter that "
        f"marks the finger: {wide:.1f} mm between its corners, {gripper.land_mm:g} mm of "
        f"land and {behind:.1f} mm of wall behind the bolt; at least {WIDTH * least:.1f}, "
        f"{least + 2 * margin:g} and {p.printer.min_wall_mm + LEAST_DEPTH_MM:g} "
        "are needed",
    )
    middle, half = (low + high) / 2, min(high - low, wide / WIDTH) / 2
    depth, back = min(deep, DEPTH_MM), gripper.block_back_w_mm
    return letter_on(middle - half, middle + half, depth, back, line_mm)


CONTACT_MM = 4.0


def derive_closing(
    outline: Outline, stack: Stack, mount: Mount, mould: Mould, faults: Faults
) -> Closing:
    """First contact and largest opening, with the lean of the mount applied.

    A point (y, z) of the sensor frame stands `y sin(tilt) + z cos(tilt)` towards the other
    finger. The gripper's opening is between its own pads, `pad_w_mm` before the bolt axis.
    """
    sine, cosine = math.sin(math.radians(mount.tilt_deg)), math.cos(math.radians(mount.tilt_deg))
    thinnest = mould.tip_silicone_mm - stack.cover_mm
    profile = (
        (outline.tip_y_mm, thinnest),
        (outline.tip_y_mm - mould.taper_length_mm, 0.0),
        (outline.end_y_mm + mould.end_round_mm, 0.0),
    )
    reach, y = max((y * sine + z * cosine, y) for y, z in profile)
    bolt = mount.origin_y_mm * sine + stack.rim_z_mm * cosine - mount.bolt_w_mm
    opening = mount.stroke_mm + 2 * (mount.pad_w_mm - (reach - bolt))
    faults.refuse_unless(
        outline.tip_y_mm - y <= CONTACT_MM,
        "coupling.gripper",
        f"is {mount.gripper!r}, whose tilt of {mount.tilt_deg:g}° makes the fingers touch first "
        f"{outline.tip_y_mm - y:.1f} mm from the tip; at most {CONTACT_MM:g} mm is allowed. Use a "
        "tilt of 0° or more.",
    )
    faults.refuse_unless(
        opening >= 10,
        "coupling.gripper",
        f"is {mount.gripper!r}, in which these fingers open to {opening:.1f} mm; at least 10 mm "
        "is needed",
    )
    faults.refuse_unless(
        opening <= mount.stroke_mm,
        "coupling.gripper",
        f"is {mount.gripper!r}, in which these fingers stay {opening - mount.stroke_mm:.1f} mm "
        "apart when it is closed. Increase bolt_w_mm - pad_w_mm of its entry by half of that.",
    )
    return Closing(y, reach, opening)
