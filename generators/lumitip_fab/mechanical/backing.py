"""The backing: a plate with a pocket for the board, and the gripper coupling."""

import numpy as np
from build123d import Solid

from lumitip_fab.artefact import Artefact
from lumitip_fab.design import Board, Box, Finger, Interface, Mount, Outline, Point, Stack, Tip
from lumitip_fab.frames import Matrix, backing_bed_to_sensor, mount_to_sensor
from lumitip_fab.mechanical import coupling, export, flex
from lumitip_fab.mechanical.letters import letter_cutter
from lumitip_fab.mechanical.shapes import (
    box_solid,
    cylinder,
    one_solid,
    outline_face,
    placed,
    prism,
    side_prism,
)

BEYOND_MM = 1.0  # how far a cutter reaches past what it cuts
PIN_LEAD_MM = 0.25  # chamfer that leads the board onto a pin


def backing(
    finger: Finger,
    stack: Stack,
    outline: Outline,
    tip: Tip,
    board: Board,
    mount: Mount,
    interfaces: tuple[Interface, ...],
) -> tuple[Artefact, ...]:
    """The backing of one finger and, where it bends, the interface behind it: STEP in the sensor
    frame, STL and 3MF as they lie on the bed."""
    solid = backing_solid(finger, stack, outline, tip, board, mount, interfaces)
    files = _files("backing", finger, solid, backing_bed_to_sensor(mount, stack))
    for interface in interfaces:
        solid = flex.interface_solid(finger, stack, mount, interface)
        files += _files("interface", finger, solid, mount_to_sensor(mount, stack))
    return files


def _files(kind: str, finger: Finger, solid: Solid, to_sensor: Matrix) -> tuple[Artefact, ...]:
    printed = placed(solid, np.asarray(np.linalg.inv(to_sensor), dtype=np.float64))
    name = f"{finger.name}_{kind}"
    return (
        Artefact(f"{kind}/{name}.step", export.step(solid, name)),
        Artefact(f"{kind}/{name}.stl", export.stl(printed), to_sensor),
        Artefact(f"{kind}/{name}.3mf", export.three_mf(printed, name), to_sensor),
    )


def backing_solid(
    finger: Finger,
    stack: Stack,
    outline: Outline,
    tip: Tip,
    board: Board,
    mount: Mount,
    interfaces: tuple[Interface, ...],
) -> Solid:
    """The backing in the finger's sensor frame: with its coupling, or as a plate that bends.

    Raises:
        BuildError: if the kernel does not make one valid solid of it.
    """
    plate = _plate(stack, outline) - _tip_cutter(stack, outline, tip)
    for interface in interfaces:
        return one_solid(flex.sheet(plate, finger, stack, mount, interface), finger, "backing")
    plate = plate - box_solid(board.pocket, stack.pocket_z_mm, stack.rim_z_mm + BEYOND_MM)
    plate = plate - coupling.notch_cutter(stack, mount, finger.notch)
    whole = plate + coupling.coupling_solid(mount, stack, finger.notch)
    foot = stack.pocket_z_mm - stack.floor_mm / 2
    whole = whole + [
        pin_solid(hole, board.pin_mm, foot, stack.rim_z_mm, stack.pcb_mm) for hole in finger.holes
    ]
    taken = [
        coupling.beyond_mount_plane(mount, stack),
        *coupling.coupling_holes(mount, stack),
        letter_cutter(finger.name, mount.letter, mount_to_sensor(mount, stack)),
        *(_relief(r.box, r.depth_mm, r.through, stack) for r in finger.reliefs),
    ]
    return one_solid((whole - taken).clean(), finger, "backing")


def pin_solid(
    centre: Point, pin_mm: float, foot_mm: float, top_mm: float, pocket_mm: float
) -> Solid:
    """A locating pin, upright.

    Args:
        centre: its axis.
        pin_mm: its diameter.
        foot_mm: where it begins, inside the floor.
        top_mm: its top, which is chamfered.
        pocket_mm: how far it stands out of the floor.
    """
    lead = min(PIN_LEAD_MM, pin_mm / 4, pocket_mm / 4)
    pin = cylinder(centre, pin_mm, foot_mm, top_mm)
    top = max(pin.edges(), key=lambda edge: edge.center().Z)
    return pin.chamfer(lead, None, [top])


def _plate(stack: Stack, outline: Outline) -> Solid:
    """The plate, reaching past the gripper end so that the tilted mount plane cuts it all."""
    half = outline.end_width_mm / 2
    foot = Box(-half, half, outline.end_y_mm - BEYOND_MM, outline.end_y_mm)
    plate = prism(outline_face(outline), stack.back_z_mm, stack.face_z_mm)
    return plate + box_solid(foot, stack.back_z_mm, stack.face_z_mm)


def _tip_cutter(stack: Stack, outline: Outline, tip: Tip) -> Solid:
    """What the wedge takes from the back of the plate."""
    edge_z = stack.face_z_mm - tip.edge_mm
    rise = (edge_z - stack.back_z_mm) / (outline.tip_y_mm - tip.slant_start_y_mm)
    end_y, far_z = outline.tip_y_mm + BEYOND_MM, stack.back_z_mm - BEYOND_MM
    start_y = tip.slant_start_y_mm
    half = float(np.abs(outline.polygon()[:, 0]).max()) + BEYOND_MM
    corners = [
        (start_y, stack.back_z_mm),
        (end_y, edge_z + rise * BEYOND_MM),
        (end_y, far_z),
        (start_y, far_z),
    ]
    return side_prism(corners, -half, half)


def _relief(box: Box, depth_mm: float, through: bool, stack: Stack) -> Solid:
    """Room behind the board, from inside the pocket to its depth or through the plate."""
    bottom = stack.back_z_mm - BEYOND_MM if through else stack.pocket_z_mm - depth_mm
    return box_solid(box, bottom, stack.pocket_z_mm + stack.pcb_mm / 2)
