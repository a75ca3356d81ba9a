"""The printed flange between coupling and gripper: a tray for its board, and a lid."""

from build123d import Plane, Solid

from lumitip_fab.design import Box, Design, Flange, Point, Stack
from lumitip_fab.design.frames import flange_beds
from lumitip_fab.parts import export
from lumitip_fab.parts.shapes import box_solid, cylinder, one_solid
from lumitip_fab.pipeline.artefact import Artefact

BEYOND_MM = 1.0  # how far a cutter reaches past what it cuts
CORNER_MM = 0.5  # of windows, reliefs and openings


def flange_files(design: Design, flange: Flange) -> tuple[Artefact, ...]:
    """Both parts of the flange."""
    solids = {"lower": lower_solid(flange, design.stack), "upper": upper_solid(flange)}
    beds = flange_beds(flange)
    return tuple(
        artefact
        for part, solid in solids.items()
        for artefact in export.part_files(
            f"flange/{flange.name}_{part}", solid, beds[part], "flange"
        )
    )


def lower_solid(flange: Flange, stack: Stack) -> Solid:
    """The tray with the board's pocket, in the coupling's recess.

    Raises:
        BuildError: if the kernel does not make one valid solid of it.
    """
    seat, split = flange.seat_z_mm, flange.split_z_mm
    lean = (flange.face_mm - flange.spigot_mm) / 2  # of 45°, to print
    cone = Solid.make_cone(flange.spigot_mm / 2, flange.face_mm / 2, lean)
    whole = cylinder((0.0, 0.0), flange.spigot_mm, seat, BEYOND_MM).fuse(
        cone,
        cylinder((0.0, 0.0), flange.face_mm, lean, split),
        cylinder(flange.peg_at, flange.peg_mm, split - BEYOND_MM, split + flange.peg_height_mm),
    )
    above = split + BEYOND_MM
    front = flange.board_z_mm + stack.auxiliary_mm
    floor = flange.board_z_mm
    taken = [box_solid(flange.pocket, floor, above, flange.pocket_corner_mm)]
    taken += [_cut(box, floor - flange.tail_mm, above) for box in flange.reliefs]
    taken += [_cut(box, front, above, outward=True) for box in flange.openings]
    taken.append(_cut(flange.window, seat - BEYOND_MM, above))
    taken += [_screw(flange, at) for at in flange.screws]
    taken += _bolts(flange, seat, split)
    taken.append(
        cylinder(flange.pin_at, flange.pin_hole_mm, seat - BEYOND_MM, seat + flange.pin_depth_mm)
    )
    taken.append(cylinder(flange.pin_at, flange.socket_mm, flange.socket_z_mm, above))
    return one_solid((whole - taken).clean(), "flange, lower", "[flange]")


def upper_solid(flange: Flange) -> Solid:
    """The lid with the gripper's recess.

    Raises:
        BuildError: if the kernel does not make one valid solid of it.
    """
    split, top = flange.split_z_mm, flange.top_z_mm
    whole = cylinder((0.0, 0.0), flange.face_mm, split, top)
    taken = [cylinder((0.0, 0.0), flange.recess_mm, split + flange.web_mm, top + BEYOND_MM)]
    taken += _bolts(flange, split, top)
    for at, hole in ((flange.pin_at, flange.socket_mm), (flange.peg_at, flange.peg_hole_mm)):
        taken.append(cylinder(at, hole, split - BEYOND_MM, top))
    return one_solid((whole - taken).clean(), "flange, upper", "[flange]")


def _cut(box: Box, low_mm: float, high_mm: float, outward: bool = False) -> Solid:
    """A cutter on a rectangle; one that goes out through a wall reaches beyond it."""
    if outward:
        far = BEYOND_MM if box.y_max_mm > -box.y_min_mm else -BEYOND_MM
        low, high = min(box.y_min_mm, box.y_min_mm + far), max(box.y_max_mm, box.y_max_mm + far)
        return box_solid(Box(box.x_min_mm, box.x_max_mm, low, high), low_mm, high_mm)
    return box_solid(box, low_mm, high_mm, CORNER_MM)


def _screw(flange: Flange, at: Point) -> Solid:
    """A hole through the floor, countersunk from below."""
    seat, lean = flange.seat_z_mm, (flange.screw_head_mm - flange.screw_mm) / 2
    head = Solid.make_cone(
        flange.screw_head_mm / 2, flange.screw_mm / 2, lean, Plane((at[0], at[1], seat))
    )
    return cylinder(at, flange.screw_mm, seat - BEYOND_MM, flange.board_z_mm + BEYOND_MM) + head


def _bolts(flange: Flange, low_mm: float, high_mm: float) -> list[Solid]:
    return [
        cylinder(at, flange.bolt_hole_mm, low_mm - BEYOND_MM, high_mm + BEYOND_MM)
        for at in flange.bolts
    ]
