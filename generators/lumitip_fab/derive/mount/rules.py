"""Rules of coupling, holder and flange: refuse what does not fit or would break."""

import math
from collections.abc import Iterator

from lumitip_fab.catalogue.grippers import Gripper, ToolCoupling
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.boards import HOLE_TO_EDGE_MM, Plan
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.stack import behind_mm
from lumitip_fab.derive.finger.tip import wedge
from lumitip_fab.derive.making.fits import refuse_touching
from lumitip_fab.design import AuxiliaryBoard, Flange, Holder, Outline, Point

MOST_STRAIN = 0.01  # of the arms while they clip on; PETG yields at some 4 %
MOST_LASTING_STRAIN = 0.005  # of the arms on the body: more creeps away (assumed)
DRILLED_MM = 0.1  # beyond a screw's thread, of the board's holes, truer than printed ones
LEAST_FLARE_MM, LEAST_DEPTH_MM = 1.0, 0.5  # that a parameter file allows
UNDER_COUNTERBORE_MM = 0.4  # flare to the outer edge of the counterbores, past which it leans
RING_MM = 0.4  # of the board, at least, that a screw's head presses on
LEAST_GRIP_MM = 0.3  # each arm's end inside the body's widest place


def refuse_place(
    config: Input, gripper: Gripper, outline: Outline, plan: Plan, faults: Diagnostics
) -> None:
    """Refuse a block that does not stand on this finger's back."""
    p = config.parameters
    plate = behind_mm(p)
    ramp = gripper.block_back_w_mm - plate
    opening = plan.receiver.notch.y_max_mm - outline.end_y_mm
    length = gripper.land_mm + ramp
    before_wedge = outline.length_mm - wedge(config)[0]
    most = before_wedge - length
    faults.unless(
        p.backing.flare_mm <= most + 1e-9 or most <= LEAST_FLARE_MM,
        "flare_long",
        most_mm=math.floor(most * 10) / 10,
    )
    deepest = deepest_flare_mm(gripper, plate)
    faults.unless(p.backing.flare_depth_mm <= deepest + 1e-9, "flare_deep", most_mm=deepest)
    faults.unless(
        length <= before_wedge and opening < length,
        "block_long",
        length=length,
        opening=opening,
        outline=outline,
    )
    waist = outline.half_width_at(outline.end_y_mm + length)
    faults.unless(
        waist >= gripper.block_width_mm / 2 + HOLE_TO_EDGE_MM,
        "block_wide",
        gripper=gripper,
        hole_to_edge_mm=HOLE_TO_EDGE_MM,
        wide_mm=2 * waist,
    )
    faults.unless(ramp > 0, "block_behind_plate", plate=plate, gripper=gripper)


def deepest_flare_mm(gripper: Gripper, plate_mm: float) -> float:
    """Most depth of a flare behind a plate: it ends below the ramp, and where the counterbores open
    into the ramp, for along a flat flare their edge would be a thin skin."""
    open_w = gripper.bolt_w_mm + gripper.counterbore_mm / 2 - UNDER_COUNTERBORE_MM
    deepest = min(gripper.block_back_w_mm - LEAST_FLARE_MM, open_w) - plate_mm
    return max(math.floor(10 * deepest + 1e-6) / 10, LEAST_DEPTH_MM)


def refuse_block(config: Input, gripper: Gripper, faults: Diagnostics) -> None:
    """Refuse holes that leave too little of the block between them and round them."""
    p, pins = config.parameters, gripper.pins
    head, hole = gripper.counterbore_mm / 2, gripper.bolt_hole_mm / 2 + p.printer.fit_mm
    apart = gripper.bolt_spacing_mm
    line_mm = config.parts.printer.profile.line_mm
    walls = (
        ("behind its counterbores", gripper.block_back_w_mm - gripper.bolt_w_mm - head, None),
        ("beside its counterbores", gripper.block_width_mm / 2 - (apart or 0.0) / 2 - head, None),
        ("between its counterbores", apart - 2 * head if apart else math.inf, None),
        ("at its corners", _corner_wall_mm(gripper, head), None),
        ("round the bolts under their heads", head - hole, line_mm),
        ("over the pins", gripper.land_mm - (pins.depth_mm if pins else 0.0), None),
        ("between bolts and pins", _to_pins_mm(gripper, p.printer.fit_mm), line_mm),
        *_beside_pins(gripper, p.printer.fit_mm),
    )
    for place, wall, printed in walls:
        least = p.printer.min_wall_mm if printed is None else printed
        faults.unless(wall >= least - 1e-9, "block_wall", wall=wall, place=place, least=least)

    sleeves = pins is not None and pins.spacing_mm == apart
    faults.unless(
        not sleeves or pins is None or pins.hole_mm > gripper.bolt_hole_mm,
        "sleeves_narrow",
        gripper=gripper,
    )


def refuse_nose(gripper: Gripper, front_w_mm: float, faults: Diagnostics) -> None:
    """Refuse flanks that leave the block's front, at this w, as wide as the rest of it."""
    nose = gripper.nose
    if nose is None:
        return
    slope = 2 * math.tan(math.radians(nose.half_angle_deg))
    front = nose.front_width_mm + slope * (front_w_mm - nose.front_w_mm)
    faults.unless(
        front < gripper.block_width_mm, "nose_wide", gripper=gripper, nose=nose, front=front
    )


def _beside_pins(gripper: Gripper, fit_mm: float) -> Iterator[tuple[str, float, None]]:
    """Walls of the holes for pins to each other and to the sides of the block."""
    if gripper.pins is None:
        return
    hole, apart = gripper.pins.hole_mm + 2 * fit_mm, gripper.pins.spacing_mm
    yield "beside its pins", (gripper.block_width_mm - apart - hole) / 2, None
    yield "between its pins", apart - hole, None


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


def shoulder_deg(x_mm: float, radius_mm: float) -> float:
    """Angle at which the tray's side meets the arm, from the middle of the tray."""
    return math.degrees(math.asin(min(x_mm / radius_mm, 1.0)))


def refuse_holder(config: Input, of: AuxiliaryBoard, holder: Holder, faults: Diagnostics) -> None:
    """Refuse a tray wider than its cradle, arms that break or do not hold, bosses under tails."""
    _refuse_board_holes(config, of, faults)
    _refuse_nuts(config, holder, faults)
    p, outer = config.parameters.holder, holder.cradle_mm + holder.wall_mm
    beyond = holder.outer.x_max_mm - outer
    if beyond > 0:
        value = f"{holder.body_mm:g}"
        if p.body_mm == "gripper":
            value = f"'gripper', whose entry has {value} mm"
        faults.add(
            "tray_wide",
            value=value,
            holder=holder,
            least=math.ceil((holder.body_mm + 2 * beyond) * 10) / 10,
        )
        return
    refuse_touching(config, "holder.clearance_mm", p.clearance_mm, faults)
    _refuse_straps(config, holder, faults)
    made_mm = holder.inward_mm - config.parameters.printer.fit_mm  # as it is printed
    grip = holder.body_mm / 2 - made_mm
    faults.unless(grip >= LEAST_GRIP_MM, "arms_grip", grip=grip, least_grip_mm=LEAST_GRIP_MM)
    free_deg = holder.wrap_deg - shoulder_deg(holder.outer.x_max_mm, outer)
    length = outer * math.radians(free_deg)
    per_mm = 3 * holder.wall_mm / (2 * length**2)  # a beam that is bent at its end
    strain, lasting = per_mm * max(grip, 0.0), per_mm * holder.preload_mm
    faults.unless(
        strain <= MOST_STRAIN,
        "arms_strain",
        strain_percent=100 * strain,
        most_strain_percent=100 * MOST_STRAIN,
    )
    faults.unless(lasting <= MOST_LASTING_STRAIN, "arms_preload", most=MOST_LASTING_STRAIN / per_mm)
    half_x, half_y = holder.boss_mm[0] / 2, holder.boss_mm[2] / 2
    tails = [
        abs(device.y_mm + land.y_mm) - land.height_mm / 2
        for device in of.components
        for land in device.footprint.pads
        for x, _ in of.holes
        if land.drill_mm and abs(device.x_mm + land.x_mm - x) < half_x + land.width_mm / 2
    ]
    faults.unless(
        min(tails, default=math.inf) >= half_y,
        "bosses_wide",
        most=min(tails, default=0.0) - holder.boss_mm[1] / 2,
        wide_mm=2 * half_y,
    )


def _refuse_board_holes(config: Input, of: AuxiliaryBoard, faults: Diagnostics) -> None:
    """Refuse holes of the board that its screws do not go through, or whose heads do."""
    thread = config.parameters.holder.screw
    screw = config.catalogue.fasteners[thread]
    least, most = screw.thread_mm + DRILLED_MM, screw.cap_head_mm - 2 * RING_MM
    faults.unless(
        least - 1e-9 <= of.hole_mm <= most + 1e-9,
        "board_hole",
        of=of,
        least=least,
        most=most,
        screw=screw,
    )


def _refuse_nuts(config: Input, holder: Holder, faults: Diagnostics) -> None:
    """Refuse screws that reach the gripper behind their seat, with their nuts or their ends."""
    screw = config.catalogue.fasteners[holder.screw]
    beyond = holder.screw_length_mm - (holder.top_z_mm - holder.seat_z_mm)
    middle = min(abs(x) for x, _ in holder.holes)
    for what, inner, needed in (
        ("nuts", middle - screw.nut_mm / math.sqrt(3), screw.nut_height_mm),
        (f"ends of {holder.screw_length_mm:g} mm", middle - screw.thread_mm / 2, beyond),
    ):
        body = math.sqrt(max((holder.body_mm / 2) ** 2 - max(inner, 0.0) ** 2, 0.0))
        faults.unless(
            holder.cradle_mm - body >= needed,
            "nuts_reach_gripper",
            holder=holder,
            what=what,
            needed=needed,
            away_mm=holder.cradle_mm - body,
        )


def _refuse_straps(config: Input, holder: Holder, faults: Diagnostics) -> None:
    """Refuse holes through the arms that leave too little wall to each other or to an arm's end."""
    p, wall = config.parameters.holder, config.parameters.printer.min_wall_mm
    least = p.strap_hole_mm + wall
    most = 2 * (holder.outer.y_max_mm - wall) - p.strap_hole_mm
    room = f"{least:g} to {most:g} is allowed" if least <= most else "a narrower hole is needed"
    faults.unless(
        least - 1e-9 <= p.strap_spacing_mm <= most + 1e-9, "straps_close", room=room, holder=holder
    )
    reach = math.radians(holder.wrap_deg - holder.strap_deg) * holder.cradle_mm
    faults.unless(
        reach - p.strap_hole_mm / 2 >= wall, "strap_near_end", reach=reach, most=2 * (reach - wall)
    )


def refuse_flange(config: Input, flange: Flange, faults: Diagnostics) -> None:
    """Refuse floors and walls thinner than the printer's, and what does not fit the coupling."""
    p, least = config.parameters.flange, config.parameters.printer.min_wall_mm
    coupling = config.parts.flange.coupling
    floor = flange.board_z_mm - flange.tail_mm - flange.seat_z_mm
    faults.unless(floor >= least - 1e-9, "flange_floor", flange=flange, floor=floor)
    faults.unless(p.web_mm >= least, "flange_web")
    room = flange.socket_z_mm - least - flange.seat_z_mm
    faults.unless(flange.pin_depth_mm <= room + 1e-9, "flange_pin", flange=flange, room=room)
    rim = (flange.face_mm - flange.recess_mm) / 2
    faults.unless(rim >= least - 1e-9, "flange_rim", rim=rim, flange=flange)
    refuse_touching(config, "flange.clearance_mm", p.clearance_mm, faults)
    _refuse_walls(config, flange, coupling, faults)


def _refuse_walls(
    config: Input, flange: Flange, coupling: ToolCoupling, faults: Diagnostics
) -> None:
    """Refuse holes that come near the board's pocket, and whatever reaches beyond the spigot."""
    printer = config.parameters.printer
    least_mm = printer.min_wall_mm
    fitted = f", with printer.fit_mm = {printer.fit_mm:g}" if printer.fit_mm else ""
    radius = min(flange.spigot_mm / 2, flange.face_mm / 2 - least_mm)
    for what, places, hole_mm in (
        ("a bolt", flange.bolts, flange.bolt_hole_mm),
        ("the locating pin", (flange.pin_at,), flange.socket_mm),
        ("the peg", (flange.peg_at,), flange.peg_hole_mm),
    ):
        inside = min(_to_pocket(flange, at) for at in places) - hole_mm / 2
        outside = radius - max(math.hypot(*at) for at in places) - hole_mm / 2
        faults.unless(
            min(inside, outside) >= least_mm,
            "flange_wall",
            what=what,
            inside=inside,
            outside=outside,
            fitted=fitted,
            least_mm=least_mm,
        )
    box, corner = flange.pocket, flange.pocket_corner_mm
    reach = max(
        math.hypot(abs(x) - corner, abs(y) - corner) + corner
        for x in (box.x_min_mm, box.x_max_mm)
        for y in (box.y_min_mm, box.y_max_mm)
    )
    faults.unless(
        reach <= radius - least_mm,
        "recess_small",
        coupling=coupling,
        fitted=fitted,
        least=coupling.recess_mm + 2 * (reach + least_mm - radius),
    )


def _to_pocket(flange: Flange, at: Point) -> float:
    """Distance of a point from the pocket, a rectangle with round corners."""
    box, corner = flange.pocket, flange.pocket_corner_mm
    across = max(box.x_min_mm + corner - at[0], at[0] - box.x_max_mm + corner, 0.0)
    along = max(box.y_min_mm + corner - at[1], at[1] - box.y_max_mm + corner, 0.0)
    return math.hypot(across, along) - corner
