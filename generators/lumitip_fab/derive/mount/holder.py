"""The holder that clips the breakout board to the gripper."""

import math

from lumitip_fab.config.load import Input
from lumitip_fab.derive.faults import Faults
from lumitip_fab.derive.finger.flex import held_by, stiff_mm
from lumitip_fab.derive.making.fits import Drawn, refuse_touching
from lumitip_fab.derive.mount.fasteners import screw_length_mm
from lumitip_fab.design import Box, Carrier, Holder

NUT_PLAY_MM = 0.2  # nut pockets beyond the nuts
BOSS_RIM_MM = 1.2  # of a boss round its screw
BOSS_LENGTH_MM = 7.0
MOST_STRAIN = 0.01  # of the arms while they clip on; PETG yields at some 4 %
DRILLED_MM = 0.1  # beyond a screw's thread, of the board's holes, truer than printed ones
RING_MM = 0.4  # of the board, at least, that a screw's head presses on
LEAST_GRIP_MM = 0.3  # each arm's end inside the body's widest place


def derive_holder(
    config: Input, carriers: tuple[Carrier, ...], faults: Faults
) -> tuple[Holder, ...]:
    """The holder of the breakout board; none without that board, or without a round body."""
    p, body = config.parameters, held_by(config).envelope
    of = next((carrier for carrier in carriers if carrier.name == "breakout"), None)
    source, body_from = p.holder.body_mm, "holder.body_mm"
    if source == "gripper":
        body_from = f"{config.title('coupling.gripper')}, {body.confidence}"
    body_mm = body.round_mm if source == "gripper" else source
    if of is None or body_mm is None:
        return ()
    drawn, screw = Drawn(p.printer.fit_mm), config.catalogue.fasteners[p.holder.screw]
    wall, play = p.holder.wall_mm, drawn.gap_mm(p.holder.clearance_mm)
    tray = Box(of.box.x_min_mm - play, of.box.x_max_mm + play, of.box.y_min_mm, of.box.y_max_mm)
    floor_z = -p.holder.standoff_mm
    radius = body_mm / 2 + play
    screw_mm = drawn.hole_mm(screw.hole_mm[0])
    width = screw_mm + 2 * BOSS_RIM_MM
    through = stiff_mm(p) - floor_z + wall
    spacing = p.holder.strap_spacing_mm / 2
    holder = Holder(
        name="holder",
        carrier=of.name,
        tray=tray,
        outer=Box(tray.x_min_mm - wall, tray.x_max_mm + wall, tray.y_min_mm, tray.y_max_mm),
        top_z_mm=stiff_mm(p),
        floor_z_mm=floor_z,
        seat_z_mm=floor_z - wall,
        axis_z_mm=floor_z - wall - radius,
        body_mm=body_mm,
        body_from=body_from,
        clearance_mm=p.holder.clearance_mm,
        cradle_mm=radius,
        wall_mm=wall,
        wrap_deg=p.holder.wrap_deg,
        holes=of.holes,
        screw=p.holder.screw,
        screw_mm=screw_mm,
        screw_length_mm=screw_length_mm(through, screw),
        nut_mm=drawn.hole_mm(screw.nut_mm + NUT_PLAY_MM),
        boss_mm=(BOSS_LENGTH_MM, width, width + 2 * p.holder.standoff_mm),  # 45°, to print
        strap_deg=(p.holder.wrap_deg + _shoulder_deg(tray.x_max_mm + wall, radius + wall)) / 2,
        strap_y_mm=(-spacing, spacing),
        strap_hole_mm=p.holder.strap_hole_mm,
    )
    _refuse_holes(config, of, faults)
    _refuse(config, of, holder, faults)
    _refuse_nuts(config, holder, faults)
    return (holder,)


def _shoulder_deg(x_mm: float, radius_mm: float) -> float:
    """Angle at which the tray's side meets the arm, from the middle of the tray."""
    return math.degrees(math.asin(min(x_mm / radius_mm, 1.0)))


def _refuse(config: Input, of: Carrier, holder: Holder, faults: Faults) -> None:
    """Refuse a tray wider than its cradle, arms that break or do not hold, bosses under tails."""
    p, outer = config.parameters.holder, holder.cradle_mm + holder.wall_mm
    beyond = holder.outer.x_max_mm - outer
    if beyond > 0:
        value = f"{holder.body_mm:g}"
        if p.body_mm == "gripper":
            value = f"'gripper', whose entry has {value} mm"
        faults.refuse(
            "holder.body_mm",
            f"is {value}; the tray is {holder.outer.width_mm:.1f} mm wide: at least "
            f"{math.ceil((holder.body_mm + 2 * beyond) * 10) / 10:g} is needed",
        )
        return
    refuse_touching(config, "holder.clearance_mm", p.clearance_mm, faults)
    _refuse_straps(config, holder, faults)
    printed_mm = holder.cradle_mm - config.parameters.printer.fit_mm  # what is made of it
    grip = holder.body_mm / 2 - printed_mm * math.sin(math.radians(holder.wrap_deg))
    faults.refuse_unless(
        grip >= LEAST_GRIP_MM,
        "holder.wrap_deg",
        f"is {p.wrap_deg:g}, with the arms' ends {grip:.2f} mm inside the body's widest place; at "
        f"least {LEAST_GRIP_MM:g} mm is needed. Increase it or reduce holder.clearance_mm.",
    )
    free_deg = holder.wrap_deg - _shoulder_deg(holder.outer.x_max_mm, outer)
    length = outer * math.radians(free_deg)
    strain = 3 * holder.wall_mm * max(grip, 0.0) / (2 * length**2)
    faults.refuse_unless(
        strain <= MOST_STRAIN,
        "holder.wrap_deg",
        f"is {p.wrap_deg:g}; clipping on strains the arms by {100 * strain:.1f} %; at most "
        f"{100 * MOST_STRAIN:g} % is allowed. Reduce it or holder.wall_mm.",
    )
    half_x, half_y = holder.boss_mm[0] / 2, holder.boss_mm[2] / 2
    tails = [
        abs(device.y_mm + land.y_mm) - land.height_mm / 2
        for device in of.devices
        for land in device.pattern.lands
        for x, _ in of.holes
        if land.drill_mm and abs(device.x_mm + land.x_mm - x) < half_x + land.width_mm / 2
    ]
    faults.refuse_unless(
        min(tails, default=math.inf) >= half_y,
        "holder.standoff_mm",
        f"is {p.standoff_mm:g}; the bosses under the screws would be {2 * half_y:.1f} mm wide "
        f"and reach solder tails; at most {min(tails, default=0.0) - holder.boss_mm[1] / 2:.2f} is "
        "allowed",
    )


def _refuse_holes(config: Input, of: Carrier, faults: Faults) -> None:
    """Refuse holes of the board that its screws do not go through, or whose heads do."""
    thread = config.parameters.holder.screw
    screw = config.catalogue.fasteners[thread]
    least, most = screw.thread_mm + DRILLED_MM, screw.cap_head_mm - 2 * RING_MM
    faults.refuse_unless(
        least - 1e-9 <= of.hole_mm <= most + 1e-9,
        "breakout.hole_mm",
        f"is {of.hole_mm:g}; {least:g} to {most:g} is allowed for an {thread} (holder.screw) "
        f"and its head of {screw.cap_head_mm:g} mm",
    )


def _refuse_nuts(config: Input, holder: Holder, faults: Faults) -> None:
    """Refuse screws that reach the gripper behind their seat, with their nuts or their ends."""
    screw = config.catalogue.fasteners[holder.screw]
    beyond = holder.screw_length_mm - (holder.top_z_mm - holder.seat_z_mm)
    middle = min(abs(x) for x, _ in holder.holes)
    for what, inner, needed in (
        ("nuts", middle - screw.nut_mm / math.sqrt(3), screw.nut_height_mm),
        (f"ends of {holder.screw_length_mm:g} mm", middle - screw.thread_mm / 2, beyond),
    ):
        body = math.sqrt(max((holder.body_mm / 2) ** 2 - max(inner, 0.0) ** 2, 0.0))
        faults.refuse_unless(
            holder.cradle_mm - body >= needed,
            "holder.screw",
            f"is {holder.screw!r}, whose {what} reach {needed:.2f} mm under their seat; the "
            f"gripper is {holder.cradle_mm - body:.2f} mm away. Choose thinner screws or increase "
            "breakout.hole_spacing_mm.",
        )


def _refuse_straps(config: Input, holder: Holder, faults: Faults) -> None:
    """Refuse holes through the arms that leave too little wall to each other or to an arm's end."""
    p, wall = config.parameters.holder, config.parameters.printer.min_wall_mm
    least = p.strap_hole_mm + wall
    most = 2 * (holder.outer.y_max_mm - wall) - p.strap_hole_mm
    room = f"{least:g} to {most:g} is allowed" if least <= most else "a narrower hole is needed"
    faults.refuse_unless(
        least - 1e-9 <= p.strap_spacing_mm <= most + 1e-9,
        "holder.strap_spacing_mm",
        f"is {p.strap_spacing_mm:g}; {room} for holes of {p.strap_hole_mm:g} mm in arms "
        f"{holder.outer.length_mm:g} mm wide, with walls of {wall:g} mm beside them",
    )
    reach = math.radians(holder.wrap_deg - holder.strap_deg) * holder.cradle_mm
    faults.refuse_unless(
        reach - p.strap_hole_mm / 2 >= wall,
        "holder.strap_hole_mm",
        f"is {p.strap_hole_mm:g}; the arms end {reach:.1f} mm from the centre of their holes; at "
        f"most {2 * (reach - wall):.1f} is allowed. Reduce it or increase holder.wrap_deg.",
    )
