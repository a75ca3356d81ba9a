"""The printed parts of the flange round its board, and heights from the robot to the fingers."""

from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.stack import held_by, stiff_mm
from lumitip_fab.derive.making.fits import Drawn
from lumitip_fab.derive.mount.fasteners import BOARD_SCREW
from lumitip_fab.derive.mount.rules import refuse_flange
from lumitip_fab.derive.mount.unsure import unsure_figures
from lumitip_fab.design import (
    AuxiliaryBoard,
    Box,
    Component,
    Flange,
    Holder,
    Point,
    System,
    ToolContact,
)

HEADROOM_MM = 0.3  # over the highest part
AROUND_MM = 0.5  # round headers, contacts and solder tails
PIN_LENGTHS_MM = (12.0, 10.0, 8.0)
PIN_PLAY_MM = 0.1  # of a hole into which a pin is glued
SOCKET_PLAY_MM = 0.2  # of the hole for the gripper's pin
SOCKET_SPARE_MM = 0.5  # below the end of the gripper's pin
PEG_MM = 5.0
PEG_PLAY_MM = 0.5  # both are printed: at the tightest fit 0.1 is left
PEG_SHARE = 0.75  # of the web's thickness
SCREW_PLAY_MM = 0.2  # holes in the floor beyond the board's
SINK_PLAY_MM = 0.4  # of a countersunk head, which then lies below the face


def derive_flange_body(
    config: Input, auxiliary_boards: tuple[AuxiliaryBoard, ...], faults: Diagnostics
) -> tuple[Flange, ...]:
    """Both printed parts; none without the flange's board."""
    if not auxiliary_boards:
        return ()
    (auxiliary,) = auxiliary_boards
    p, pcb_mm = config.parameters.flange, stiff_mm(config.parameters)
    drawn = Drawn(config.parameters.printer.fit_mm)
    screw = config.catalogue.fasteners[BOARD_SCREW]
    coupling, pogo = config.parts.flange.coupling, config.parts.flange.contacts
    # Towards the robot, and so on the board's back, are the contacts alone.
    (contacts,) = (device for device in auxiliary.components if device.side == "back")
    front = [device for device in auxiliary.components if device is not contacts]
    headers = [device for device in front if device.kind in ("header", "wires")]
    board_at = (
        coupling.contacts_at_mm[0] - contacts.x_mm,
        coupling.contacts_at_mm[1] - contacts.y_mm,
    )
    board_z = pogo.height_mm - pogo.stroke_mm / 2 - coupling.contacts_depth_mm
    split_z = board_z + pcb_mm + max(d.footprint.height_mm for d in front) + HEADROOM_MM
    socket_z = min(split_z, split_z + p.web_mm - coupling.pin_depth_mm - SOCKET_SPARE_MM)
    room = socket_z - config.parameters.printer.min_wall_mm + coupling.recess_depth_mm
    pin = next((n for n in PIN_LENGTHS_MM if n - coupling.pin_depth_mm <= room), PIN_LENGTHS_MM[-1])
    flange = Flange(
        name="flange",
        auxiliary=auxiliary.name,
        coupling=p.coupling,
        iso=coupling.iso,
        face_mm=coupling.face_mm,
        centring_mm=coupling.recess_mm,
        clearance_mm=p.clearance_mm,
        spigot_mm=drawn.peg_mm(coupling.recess_mm - 2 * p.clearance_mm),
        seat_z_mm=-coupling.recess_depth_mm,
        recess_mm=drawn.hole_mm(coupling.recess_mm + 2 * p.clearance_mm),
        recess_depth_mm=coupling.recess_depth_mm,
        bolt=coupling.bolt,
        bolts=coupling.bolts_mm,
        bolt_hole_mm=drawn.hole_mm(coupling.bolt_hole_mm),
        pin_at=coupling.pin_at_mm,
        pin_mm=coupling.pin_mm,
        pin_play_mm=PIN_PLAY_MM,
        pin_hole_mm=drawn.hole_mm(coupling.pin_mm + PIN_PLAY_MM),
        pin_length_mm=pin,
        pin_depth_mm=pin - coupling.pin_depth_mm,
        socket_play_mm=SOCKET_PLAY_MM,
        socket_mm=drawn.hole_mm(coupling.pin_mm + SOCKET_PLAY_MM),
        socket_z_mm=socket_z,
        peg_at=(-coupling.pin_at_mm[0], -coupling.pin_at_mm[1]),
        peg_mm=drawn.peg_mm(PEG_MM),
        peg_hole_mm=drawn.hole_mm(PEG_MM + PEG_PLAY_MM),
        peg_height_mm=PEG_SHARE * p.web_mm,
        board_at=board_at,
        board_z_mm=board_z,
        pocket=_moved(auxiliary.box, board_at).grown(drawn.gap_mm(p.clearance_mm)),
        pocket_corner_mm=auxiliary.corner_mm + drawn.gap_mm(p.clearance_mm),
        reliefs=tuple(_room(header, board_at) for header in headers),
        tail_mm=p.tail_mm,
        window=_room(contacts, board_at),
        contacts=tuple(
            ToolContact(str(number), contact.at_mm, contact.carries, contact.kind)
            for number, contact in enumerate(coupling.contacts, start=1)
        ),
        contacts_z_mm=-coupling.contacts_depth_mm,
        contacts_mm=pogo.height_mm,
        stroke_mm=pogo.stroke_mm,
        contact_a=pogo.contact_a,
        openings=_openings(headers, board_at, coupling.face_mm / 2),
        screws=tuple((x + board_at[0], y + board_at[1]) for x, y in auxiliary.holes),
        screw=BOARD_SCREW,
        screw_mm=drawn.hole_mm(auxiliary.hole_mm + SCREW_PLAY_MM),
        screw_head_mm=screw.countersunk_mm + SINK_PLAY_MM,
        split_z_mm=split_z,
        web_mm=p.web_mm,
        unsure=unsure_figures(coupling),
    )
    refuse_flange(config, flange, faults)
    return (flange,)


def _moved(box: Box, by: Point) -> Box:
    return Box(
        box.x_min_mm + by[0], box.x_max_mm + by[0], box.y_min_mm + by[1], box.y_max_mm + by[1]
    )


def _room(device: Component, board_at: Point, body: Box | None = None) -> Box:
    """Room round a part's body, or its shroud: more than a fit of the printer is."""
    at = (device.x_mm + board_at[0], device.y_mm + board_at[1])
    return _moved(body or device.footprint.body, at).grown(AROUND_MM)


def _openings(headers: list[Component], board_at: Point, radius_mm: float) -> tuple[Box, ...]:
    """One on each side: from the middles of its headers and wire pads out through the wall, as wide
    as they and the headers' shrouds."""
    openings = []
    for side in (-1, 1):
        here = [d for d in headers if side * (d.y_mm + board_at[1]) > 0]
        rooms = [_room(header, board_at) for header in here]
        rooms += [
            _room(header, board_at, header.footprint.shroud.box)
            for header in here
            if header.footprint.shroud
        ]
        if not here:
            continue
        start = min(side * (header.y_mm + board_at[1]) for header in here)
        low, high = sorted((side * start, side * radius_mm))
        left, right = min(r.x_min_mm for r in rooms), max(r.x_max_mm for r in rooms)
        openings.append(Box(left, right, low, high))
    return tuple(openings)


ROUND_MM = 2.0  # of a body's sides from the diameter that a holder is made for


def derive_system(
    config: Input, flanges: tuple[Flange, ...], holders: tuple[Holder, ...]
) -> System:
    """The stack; without the printed flange it begins at the gripper."""
    body = held_by(config).envelope
    couplings = [config.catalogue.couplings[flange.coupling] for flange in flanges]
    gripper_z = sum(c.height_mm + f.top_z_mm for c, f in zip(couplings, flanges, strict=True))
    sides = (body.width_mm, body.depth_mm, 2 * body.corner_mm)
    return System(
        robot_mm=sum(coupling.robot_mm for coupling in couplings),
        coupling_mm=sum(coupling.height_mm for coupling in couplings),
        gripper_z_mm=gripper_z,
        width_mm=body.width_mm,
        depth_mm=body.depth_mm,
        corner_mm=body.corner_mm,
        length_mm=body.length_mm,
        reach_mm=body.reach_mm,
        load_kg=body.mass_kg + body.payload_kg,
        confidence=body.confidence,
        holders=tuple(
            holder.name
            for holder in holders
            if all(abs(side - holder.body_mm) <= ROUND_MM for side in sides)
        ),
        holder_z_mm=gripper_z + body.length_mm / 2,
    )
