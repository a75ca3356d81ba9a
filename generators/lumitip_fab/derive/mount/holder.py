"""The holder that clips the breakout board to the gripper."""

from dataclasses import replace

from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.stack import held_by, stiff_mm
from lumitip_fab.derive.making.fits import Drawn
from lumitip_fab.derive.mount.fasteners import screw_length_mm
from lumitip_fab.derive.mount.rules import refuse_holder, shoulder_deg
from lumitip_fab.derive.mount.tie_lugs import arm_lugs, holder_lugs
from lumitip_fab.design import AuxiliaryBoard, Box, Holder

NUT_PLAY_MM = 0.2  # nut pockets beyond the nuts
BOSS_RIM_MM = 1.2  # of a boss round its screw
BOSS_LENGTH_MM = 7.0


def derive_holder(
    config: Input, auxiliary_boards: tuple[AuxiliaryBoard, ...], faults: Diagnostics
) -> tuple[Holder, ...]:
    """The holder of the breakout board; none without that board, or without a round body."""
    p, body = config.parameters, held_by(config).envelope
    of = next((auxiliary for auxiliary in auxiliary_boards if auxiliary.name == "breakout"), None)
    source, body_from = p.holder.body_mm, "holder.body_mm"
    if source == "gripper":
        body_from = f"{config.title('coupling.gripper')}, {body.confidence}"
    body_mm = body.round_mm if source == "gripper" else source
    if of is None or body_mm is None:
        return ()
    drawn, screw = Drawn(p.printer.fit_mm), config.parts.holder.screw
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
        auxiliary=of.name,
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
        preload_mm=p.holder.preload_mm,
        holes=of.holes,
        screw=p.holder.screw,
        screw_mm=screw_mm,
        screw_length_mm=screw_length_mm(through, screw),
        nut_mm=drawn.hole_mm(screw.nut_mm + NUT_PLAY_MM),
        boss_mm=(BOSS_LENGTH_MM, width, width + 2 * p.holder.standoff_mm),  # 45°, to print
        strap_deg=(p.holder.wrap_deg + shoulder_deg(tray.x_max_mm + wall, radius + wall)) / 2,
        strap_y_mm=(-spacing, spacing),
        strap_hole_mm=p.holder.strap_hole_mm,
        lugs=(),
        arm_lugs=(),
    )
    refuse_holder(config, of, holder, faults)
    lugs, on_arms = holder_lugs(config, holder, of), arm_lugs(config, holder)
    return (replace(holder, lugs=lugs, arm_lugs=on_arms),)
