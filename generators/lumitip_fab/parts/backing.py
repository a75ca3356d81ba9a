"""The printed finger: backing with the board's pocket and the coupling, or plate and interface of
a compliant one."""

from dataclasses import replace

from build123d import Solid

from lumitip_fab.design import (
    Board,
    Box,
    Design,
    Finger,
    Interface,
    Key,
    Mount,
    Outline,
    Point,
    Stack,
    Tip,
    frames,
)
from lumitip_fab.parts import coupling, export, shapes
from lumitip_fab.parts.letters import letter_cutter
from lumitip_fab.parts.plate import BEYOND_MM, key_cutters, plate_solid
from lumitip_fab.pipeline.artefact import Artefact


def sheet(plate: Solid, finger: Finger, stack: Stack, mount: Mount, interface: Interface) -> Solid:
    """The bendable plate in the sensor frame: with holes for thread, windows behind parts on the
    board's back, wire notch and groove. Every opening goes straight through, or is in the back.

    Args:
        plate: the whole plate, thinner towards its tip.
        finger: for holes, windows and letter.
        stack: its heights.
        mount: for the plane in which it ends.
        interface: for groove and holes.
    """
    low, high = stack.back_z_mm - BEYOND_MM, stack.face_z_mm + BEYOND_MM
    notch = finger.notch
    end_y = notch.y_min_mm - 2 * BEYOND_MM
    opening = Box(notch.x_min_mm, notch.x_max_mm, end_y, notch.y_max_mm)
    deep = stack.back_z_mm + interface.groove_depth_mm
    island = _within(interface.groove, interface.groove_mm, end_y)
    groove = shapes.box_solid(_from(interface.groove, end_y), low, deep)
    taken = [
        coupling.beyond_mount_plane(mount, stack),
        shapes.box_solid(opening, low, high),
        groove - shapes.box_solid(island, low - BEYOND_MM, high),
        letter_cutter(finger.name, interface.letter, frames.plate_back_to_sensor(mount, stack)),
        *(shapes.cylinder(at, interface.thread_hole_mm, low, high) for at in finger.holes),
        *(shapes.box_solid(relief.box, low, high) for relief in finger.reliefs),
    ]
    return (plate - taken).clean()


def interface_solid(finger: Finger, stack: Stack, mount: Mount, interface: Interface) -> Solid:
    """The rigid part behind the plate, in the sensor frame: pad with rim, and the coupling.

    Raises:
        BuildError: if the kernel does not make one valid solid of it.
    """
    back_z, pad = stack.back_z_mm, interface.pad_mm
    end_y = interface.box.y_min_mm - BEYOND_MM
    # To the coupling the pad is the plate, and all before it the depth of a pocket.
    behind = replace(stack, floor_mm=pad, pcb_mm=stack.rim_z_mm - back_z, sunk=True)
    far = replace(interface.box, x_min_mm=-_FAR_MM, x_max_mm=_FAR_MM, y_min_mm=-_FAR_MM)
    held = coupling.coupling_solid(mount, behind, None) & shapes.box_solid(far, -_FAR_MM, _FAR_MM)
    whole = shapes.box_solid(_from(interface.box, end_y), back_z - pad, back_z) + held
    taken = [
        coupling.beyond_mount_plane(mount, behind),
        *coupling.coupling_holes(mount, behind),
        *coupling.tie_openings(mount, behind),
        letter_cutter(finger.name, mount.letter, frames.mount_to_sensor(mount, behind)),
    ]
    whole = whole + _rim(stack, interface, end_y) + coupling.tie_lugs(mount, behind)
    return shapes.one_solid((whole - taken).clean(), f"{finger.name} interface")


def _rim(stack: Stack, interface: Interface, end_y: float) -> Solid:
    """The rim on the pad. Below its upper bar it rises at 45° as printed, so nothing hangs over."""
    low, high = stack.back_z_mm - interface.pad_mm / 2, stack.back_z_mm + interface.rim_height_mm
    inner = _within(interface.box, interface.rim_mm, end_y - BEYOND_MM)
    slope = interface.rim_height_mm
    corners = [
        (inner.y_min_mm, stack.back_z_mm),
        (inner.y_max_mm, stack.back_z_mm),
        (inner.y_max_mm + slope + BEYOND_MM, high + BEYOND_MM),
        (inner.y_min_mm, high + BEYOND_MM),
    ]
    hollow = shapes.side_prism(corners, inner.x_min_mm, inner.x_max_mm)
    return shapes.box_solid(_from(interface.box, end_y), low, high) - hollow


def _from(box: Box, y_mm: float) -> Box:
    return replace(box, y_min_mm=y_mm)


def _within(box: Box, by_mm: float, y_mm: float) -> Box:
    """A box narrower by a width on three sides, which begins at a y."""
    return Box(box.x_min_mm + by_mm, box.x_max_mm - by_mm, y_mm, box.y_max_mm - by_mm)


_FAR_MM = 100.0


PIN_LEAD_MM = 0.25  # chamfer that leads the board onto a pin


def backing(design: Design, finger: Finger) -> tuple[Artefact, ...]:
    """The backing of one finger and, where it bends, the interface behind it."""
    stack, mount = design.stack, design.mount
    solid = backing_solid(
        finger,
        stack,
        design.outline,
        design.tip,
        design.board,
        mount,
        design.interfaces,
        design.keys,
    )
    path, bed = f"backing/{finger.name}_backing", frames.backing_bed_to_sensor(mount, stack)
    files = export.part_files(path, solid, bed)
    for interface in design.interfaces:
        solid = interface_solid(finger, stack, mount, interface)
        path, bed = f"interface/{finger.name}_interface", frames.mount_to_sensor(mount, stack)
        files += export.part_files(path, solid, bed)
    return files


def backing_solid(
    finger: Finger,
    stack: Stack,
    outline: Outline,
    tip: Tip,
    board: Board,
    mount: Mount,
    interfaces: tuple[Interface, ...],
    keys: tuple[Key, ...],
) -> Solid:
    """The backing in the finger's sensor frame: with its coupling, or as a plate that bends.

    Raises:
        BuildError: if the kernel does not make one valid solid of it.
    """
    plate = plate_solid(stack, outline, tip) - key_cutters(keys, stack, tip)
    for interface in interfaces:
        bendable = sheet(plate, finger, stack, mount, interface)
        return shapes.one_solid(bendable, f"{finger.name} backing")
    plate = plate - pocket_solid(stack, board)
    plate = plate - coupling.notch_cutter(stack, mount, finger.notch)
    whole = plate + coupling.coupling_solid(mount, stack, finger.notch)
    whole = whole + coupling.tie_lugs(mount, stack)
    foot = stack.pocket_z_mm - stack.floor_mm / 2
    whole = whole + [
        pin_solid(hole, board.pin_mm, foot, stack.rim_z_mm, stack.pcb_mm) for hole in finger.holes
    ]
    taken = [
        coupling.beyond_mount_plane(mount, stack),
        *coupling.coupling_holes(mount, stack),
        *coupling.tie_openings(mount, stack),
        letter_cutter(finger.name, mount.letter, frames.mount_to_sensor(mount, stack)),
        *(_relief(r.box, r.depth_mm, r.through, stack) for r in finger.reliefs),
    ]
    return shapes.one_solid((whole - taken).clean(), f"{finger.name} backing")


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
    pin = shapes.cylinder(centre, pin_mm, foot_mm, top_mm)
    top = max(pin.edges(), key=lambda edge: edge.center().Z)
    return pin.chamfer(lead, None, [top])


def pocket_solid(stack: Stack, board: Board) -> Solid:
    """Room of the board. At the tip it rises at 45° as printed, so that nothing hangs over."""
    box, top_z = board.pocket, stack.rim_z_mm + BEYOND_MM
    leant = board.roof_mm * (1 + BEYOND_MM / stack.pcb_mm)
    corners = [
        (box.y_min_mm, stack.pocket_z_mm),
        (box.y_max_mm, stack.pocket_z_mm),
        (box.y_max_mm + leant, top_z),
        (box.y_min_mm, top_z),
    ]
    return shapes.side_prism(corners, box.x_min_mm, box.x_max_mm)


def _relief(box: Box, depth_mm: float, through: bool, stack: Stack) -> Solid:
    """Room behind the board, from inside the pocket to its depth or through the plate."""
    bottom = stack.back_z_mm - BEYOND_MM if through else stack.pocket_z_mm - depth_mm
    return shapes.box_solid(box, bottom, stack.pocket_z_mm + stack.pcb_mm / 2)
