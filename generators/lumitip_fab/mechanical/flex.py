"""A compliant finger's printed parts: the bendable plate, and the interface that is glued to it.

Section along the finger, gripper end at the left:

       ┌───────────────────────────────────────────╮  plate, printed on this face
       └──────┐ ┌──────────────────────────────────╯
       ╔══════╡ ╞╗ rim in groove            thinner towards the tip
       ║ pad      ║
       ║ ╭────────╯
       coupling
"""

from dataclasses import replace

from build123d import Solid

from lumitip_fab.design import Box, Finger, Interface, Mount, Stack
from lumitip_fab.frames import mount_to_sensor, plate_back_to_sensor
from lumitip_fab.mechanical import coupling
from lumitip_fab.mechanical.letters import letter_cutter
from lumitip_fab.mechanical.shapes import box_solid, cylinder, one_solid, side_prism

BEYOND_MM = 1.0  # how far a cutter reaches past what it cuts


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
    groove = box_solid(_from(interface.groove, end_y), low, deep)
    taken = [
        coupling.beyond_mount_plane(mount, stack),
        box_solid(opening, low, high),
        groove - box_solid(island, low - BEYOND_MM, high),
        letter_cutter(finger.name, interface.letter, plate_back_to_sensor(mount, stack)),
        *(cylinder(at, interface.thread_hole_mm, low, high) for at in finger.holes),
        *(box_solid(relief.box, low, high) for relief in finger.reliefs),
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
    held = coupling.coupling_solid(mount, behind, None) & box_solid(far, -_FAR_MM, _FAR_MM)
    whole = box_solid(_from(interface.box, end_y), back_z - pad, back_z) + held
    taken = [
        coupling.beyond_mount_plane(mount, behind),
        *coupling.coupling_holes(mount, behind),
        letter_cutter(finger.name, mount.letter, mount_to_sensor(mount, behind)),
    ]
    whole = whole + _rim(stack, interface, end_y)
    return one_solid((whole - taken).clean(), finger, "interface")


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
    hollow = side_prism(corners, inner.x_min_mm, inner.x_max_mm)
    return box_solid(_from(interface.box, end_y), low, high) - hollow


def _from(box: Box, y_mm: float) -> Box:
    return replace(box, y_min_mm=y_mm)


def _within(box: Box, by_mm: float, y_mm: float) -> Box:
    """A box narrower by a width on three sides, which begins at a y."""
    return Box(box.x_min_mm + by_mm, box.x_max_mm - by_mm, y_mm, box.y_max_mm - by_mm)


_FAR_MM = 100.0
