"""Interface of a compliant finger on its plate, with its rim in the plate's groove.

The printer's fit offsets the rim alone, on each side. It is measured on the fit test plate, which
is printed of the rigid filament, as the interface is. The groove is in a plate of flexible
filament, for which there is no measurement: it is drawn at its nominal width.
"""

import math
from dataclasses import replace

from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.outline import letter_on, most_letter_mm
from lumitip_fab.derive.finger.stack import (
    behind_mm,
    foot_half_mm,
    held_by,
    is_flex,
    least_standoff_mm,
)
from lumitip_fab.derive.finger.tip import wedge
from lumitip_fab.derive.making.fits import Drawn, refuse_touching
from lumitip_fab.design import Box, Finger, Interface, Outline, Point

LETTER_DEPTH_MM = 0.4
LETTER_GAP_MM = 1.5  # interface to the letter, and letter to the wedge
SIDE_STEP_MM = 0.5  # of a letter that gives way to a hole
COVERED_MM = 0.5  # board round a thread hole, which else lets silicone through


def derive_interfaces(
    config: Input, outline: Outline, finger: Finger, board: Box, faults: Diagnostics
) -> tuple[Interface, ...]:
    """The interface of each finger; none of a rigid one.

    Args:
        config: the parameters.
        outline: of the plate.
        finger: either of them: its wire notch is between the legs of the groove.
        board: its edge.
        faults: where to refuse.
    """
    p, flex = config.parameters, config.parameters.flex
    if not is_flex(p):
        return ()
    _refuse_heights(config, faults)
    _refuse_holes(config, finger, board, faults)
    half = foot_half_mm(config, finger.notch.x_max_mm)
    end_y = outline.end_y_mm
    groove = Box(-half, half, end_y, end_y + flex.interface_mm)
    line_mm = config.parts.printer.profile.line_mm
    letter_mm = most_letter_mm(line_mm)
    _refuse_length(config, outline, finger, letter_mm, faults)
    low = groove.y_max_mm + LETTER_GAP_MM - end_y
    back = p.stack.pcb_mm + p.stack.floor_mm
    letter = letter_on(low, low + letter_mm, LETTER_DEPTH_MM, back, line_mm)
    reach = flex.thread_hole_mm / 2 + p.printer.min_wall_mm
    holes = [(x, y - end_y) for x, y in finger.holes]
    letter = replace(letter, box=_between(holes, reach, letter.box, board.x_max_mm))
    return (
        Interface(
            groove,
            flex.groove_mm,
            flex.groove_depth_mm,
            flex.glue_mm,
            Drawn(p.printer.fit_mm).gap_mm(flex.glue_mm),
            flex.pad_mm,
            flex.thread_hole_mm,
            letter,
        ),
    )


def _between(holes: list[Point], reach_mm: float, box: Box, most_mm: float) -> Box:
    """A letter's box, moved to a side where a hole for thread is too near: as the plate is printed
    face down, to a place that is free on both sides."""
    room = math.floor((most_mm - box.x_max_mm) / SIDE_STEP_MM)
    for x in (SIDE_STEP_MM * n for n in range(room + 1)):
        moved = Box(box.x_min_mm + x, box.x_max_mm + x, box.y_min_mm, box.y_max_mm)
        clear = moved.grown(reach_mm), moved.mirrored().grown(reach_mm)
        if not any(
            each.x_min_mm < u < each.x_max_mm and each.y_min_mm < v < each.y_max_mm
            for u, v in holes
            for each in clear
        ):
            return moved
    return box


def _refuse_length(
    config: Input, outline: Outline, finger: Finger, letter_mm: float, faults: Diagnostics
) -> None:
    """Refuse an interface that ends before what it must hold, or too near the finger's letter."""
    p = config.parameters
    gripper = held_by(config)
    tilt = math.radians(45 - gripper.tilt_deg)
    ramp = (gripper.block_back_w_mm - behind_mm(p)) / math.tan(tilt)
    cells = next(zone.box for zone in finger.zones if zone.name == "cells")
    # Solder joints of a multiplexer break where the board bends, and tracks need vias before it.
    for_gripper = gripper.land_mm + ramp + p.backing.flare_mm
    for_parts = cells.y_min_mm - outline.end_y_mm
    least = max(for_gripper, for_parts)
    what = f"for land, ramp and flare of {p.coupling.gripper!r}"
    remedy = "Make the finger longer, or reduce tip.slant_start_mm or flex.standoff_mm."
    if for_parts > for_gripper:
        what = "to hold the multiplexers and the tracks before them"
        remedy = "Reduce tip.slant_start_mm, or choose a longer grid or fewer multiplexers."
    most = outline.length_mm - wedge(config)[0] - 2 * LETTER_GAP_MM - letter_mm
    needed, room = math.ceil(least * 10 - 1e-6) / 10, math.floor(most * 10) / 10
    limits = (
        f"at least {needed:g} is needed {what}, and at most {room:g} is allowed before the "
        "finger's letter and the wedge"
    )
    if most < least:
        limits = (
            f"{needed:g} mm is needed {what}, but only {max(room, 0.0):g} mm is available before "
            f"the finger's letter and the wedge. {remedy}"
        )
    faults.unless(least - 1e-6 <= p.flex.interface_mm <= most, "interface_length", limits=limits)


def _refuse_holes(config: Input, finger: Finger, board: Box, faults: Diagnostics) -> None:
    """Refuse holes for thread that the board does not cover."""
    wide = config.parameters.flex.thread_hole_mm
    to_edge = min(
        min(x - board.x_min_mm, board.x_max_mm - x, y - board.y_min_mm, board.y_max_mm - y)
        for x, y in finger.holes
    )
    most = 2 * (to_edge - COVERED_MM)
    faults.unless(wide <= most + 1e-9, "thread_hole_uncovered", most=most, to_edge=to_edge)


def _refuse_heights(config: Input, faults: Diagnostics) -> None:
    """Refuse what does not go into plate, pad and groove."""
    p, flex = config.parameters, config.parameters.flex
    line_mm = config.parts.printer.profile.line_mm
    left = p.stack.floor_mm - flex.groove_depth_mm
    gap, fit_mm = Drawn(p.printer.fit_mm).gap_mm(flex.glue_mm), p.printer.fit_mm
    rim = flex.groove_mm - 2 * gap
    fitted = f" and printer.fit_mm = {fit_mm:g}" if fit_mm else ""
    refuse_touching(config, "flex.glue_mm", flex.glue_mm, faults)
    least = p.printer.min_wall_mm - 1e-9
    faults.unless(left >= least, "groove_deep", left=left)
    faults.unless(rim >= 2 * line_mm - 1e-9, "rim_thin", rim=rim, fitted=fitted, line_mm=line_mm)
    high, lowest = flex.groove_depth_mm - flex.glue_mm, 2 * line_mm / 3
    faults.unless(high >= lowest, "rim_low", high=high, least=lowest)
    faults.unless(flex.pad_mm >= least, "pad_thin")
    faults.unless(p.backing.tail_mm <= p.stack.floor_mm, "tails_behind_plate")
    needed = least_standoff_mm(config)
    faults.unless(flex.standoff_mm >= needed - 1e-9, "before_nose", needed=needed)
