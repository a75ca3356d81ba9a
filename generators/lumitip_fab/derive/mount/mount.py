"""The gripper coupling, from its catalogue entry, and how the two fingers meet."""

import math
from dataclasses import replace

from lumitip_fab.catalogue.grippers import Gripper
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.boards import Plan
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.outline import (
    DEPTH_MM,
    LEAST_DEPTH_MM,
    WIDTH,
    least_letter_mm,
    letter_on,
)
from lumitip_fab.derive.finger.stack import held_by, is_flex
from lumitip_fab.derive.making.fits import derive_fits
from lumitip_fab.derive.mount.fasteners import bolt_length_mm
from lumitip_fab.derive.mount.rules import refuse_block, refuse_nose, refuse_place
from lumitip_fab.derive.mount.tie_lugs import finger_lugs
from lumitip_fab.derive.mount.unsure import unsure_figures
from lumitip_fab.derive.wiring.section import emitter_section_mm2
from lumitip_fab.design import Closing, Letter, Mould, Mount, Outline, Stack
from lumitip_fab.design.cabling import THREAD_MM, outer_mm

LETTER_MARGIN_MM = 0.6  # or a printed line, to the bed, and to where the ramp begins


def derive_mount(config: Input, outline: Outline, plan: Plan, faults: Diagnostics) -> Mount:
    """The coupling, refused where finger and gripper do not go together."""
    p = config.parameters
    gripper = held_by(config)
    refuse_place(config, gripper, outline, plan, faults)
    refuse_block(config, gripper, faults)
    nose, fits = gripper.nose, derive_fits(config, p.printer.fit_mm)
    field, value = "backing.tail_mm", p.backing.tail_mm
    if is_flex(p):
        field, value = "flex.pad_mm", p.flex.pad_mm
    before = p.stack.pcb_mm + (p.stack.floor_mm if is_flex(p) else 0.0)
    front = max(before + value, nose.front_w_mm if nose else 0.0)
    most = gripper.bolt_w_mm - gripper.counterbore_mm / 2 - p.printer.min_wall_mm
    if not is_flex(p):
        tied = outer_mm(emitter_section_mm2(config)) + THREAD_MM
        front = max(front, min(p.stack.pcb_mm + tied, most))
    faults.unless(
        front <= most, "no_wall_before_bolt", field=field, value=value, most=most - before
    )
    refuse_nose(gripper, front, faults)
    pins = gripper.pins
    mount = Mount(
        gripper=p.coupling.gripper,
        title=config.title("coupling.gripper"),
        origin_y_mm=outline.end_y_mm,
        tilt_deg=gripper.tilt_deg,
        block_width_mm=gripper.block_width_mm,
        block_corner_mm=gripper.block_corner_mm,
        block_front_w_mm=front,
        block_back_w_mm=gripper.block_back_w_mm,
        bolt=gripper.bolt,
        bolt_length_mm=bolt_length_mm(
            gripper.land_mm, config.catalogue.fasteners[gripper.bolt].thread_mm
        ),
        bolt_u_mm=_side_by_side(gripper.bolt_spacing_mm) or (0.0,),
        bolt_w_mm=gripper.bolt_w_mm,
        bolt_hole_mm=fits.bolt_hole_mm,
        counterbore_mm=gripper.counterbore_mm,
        land_mm=gripper.land_mm,
        pin_mm=fits.gripper_pin_mm,
        pin_u_mm=_side_by_side(pins.spacing_mm if pins else None),
        pin_depth_mm=pins.depth_mm if pins else 0.0,
        seat_width_mm=gripper.seat_width_mm,
        seat_back_w_mm=gripper.seat_back_w_mm or gripper.block_back_w_mm,
        nose=fits.nose,
        stroke_mm=gripper.stroke_mm,
        pad_w_mm=gripper.pad_w_mm,
        flare_mm=p.backing.flare_mm,
        flare_depth_mm=p.backing.flare_depth_mm,
        letter=_letter(config, gripper, faults),
        lugs=(),
        force_n=gripper.force_n or 0.0,
        supply_a=gripper.supply_a or 0.0,
        unsure=unsure_figures(gripper),
    )
    return replace(mount, lugs=finger_lugs(config, mount, outline))


def _side_by_side(spacing_mm: float | None) -> tuple[float, ...]:
    return () if spacing_mm is None else (-spacing_mm / 2, spacing_mm / 2)


def _letter(config: Input, gripper: Gripper, faults: Diagnostics) -> Letter:
    """On the back of the block, between its rounded corners and below the ramp."""
    p = config.parameters
    hole = max(gripper.bolt_hole_mm, gripper.pins.hole_mm if gripper.pins else 0.0)
    behind = gripper.block_back_w_mm - gripper.bolt_w_mm - hole / 2 - p.printer.fit_mm
    deep = behind - p.printer.min_wall_mm
    wide = gripper.block_width_mm - 2 * gripper.block_corner_mm
    line_mm = config.parts.printer.profile.line_mm
    least, margin = least_letter_mm(line_mm), max(LETTER_MARGIN_MM, line_mm)
    low, high = margin, gripper.land_mm - margin
    faults.unless(
        min(high - low, wide / WIDTH) >= least and deep >= LEAST_DEPTH_MM,
        "letter_no_room",
        wide=wide,
        gripper=gripper,
        behind=behind,
        least=WIDTH * least,
        land_mm=least + 2 * margin,
        wall_mm=p.printer.min_wall_mm + LEAST_DEPTH_MM,
    )
    middle, half = (low + high) / 2, min(high - low, wide / WIDTH) / 2
    depth, back = min(deep, DEPTH_MM), gripper.block_back_w_mm
    return letter_on(middle - half, middle + half, depth, back, line_mm)


CONTACT_MM = 4.0


def derive_closing(
    outline: Outline, stack: Stack, mount: Mount, mould: Mould, faults: Diagnostics
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
    faults.unless(
        outline.tip_y_mm - y <= CONTACT_MM,
        "touches_behind_tip",
        mount=mount,
        contact_mm=CONTACT_MM,
        from_tip_mm=outline.tip_y_mm - y,
    )
    faults.unless(opening >= 10, "opens_little", mount=mount, opening=opening)
    faults.unless(
        opening <= mount.stroke_mm, "stays_open", mount=mount, apart_mm=opening - mount.stroke_mm
    )
    return Closing(y, CONTACT_MM, reach, opening)
