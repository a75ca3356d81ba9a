"""The bodies that make one finger: backing, what holds it, board with its parts, silicone, film."""

from collections.abc import Iterator
from dataclasses import dataclass

from build123d import Face, Location, Plane, Solid, Vector, Wire

from lumitip_fab.design import Board, Design, Finger, Part, Point, Stack
from lumitip_fab.parts import backing as printed
from lumitip_fab.parts.backing import backing_solid
from lumitip_fab.parts.shapes import box_face
from lumitip_fab.parts.skin import film_solid, silicone_solid
from lumitip_fab.parts.wrap import fillings


@dataclass(frozen=True, eq=False)
class Bodies:
    """The solids of one finger in its sensor frame.

    The silicone is whole: the parts on the board stick into it. Taking out a hundred boxes would
    double the time and the size of every file, and show nothing more.
    """

    finger: Finger
    backing: Solid
    interface: Solid | None
    """Rigid interface of a flexible backing."""
    board: Solid
    silicone: Solid
    film: Solid
    parts: tuple[Solid, ...]
    """One box for each of the finger's parts, in the same order."""


def layers_of(bodies: Bodies) -> Iterator[tuple[str, Solid]]:
    """Name and solid of each layer, from the back."""
    if bodies.interface is not None:
        yield "interface", bodies.interface
    for kind in ("backing", "board", "silicone", "film"):
        yield kind, getattr(bodies, kind)


def finger_bodies(design: Design, finger: Finger) -> Bodies:
    """Every body of a finger."""
    stack, outline, tip, board = design.stack, design.outline, design.tip, design.board
    mount, mould, interfaces, keys = design.mount, design.mould, design.interfaces, design.keys
    held = [printed.interface_solid(finger, stack, mount, interface) for interface in interfaces]
    return Bodies(
        finger=finger,
        backing=backing_solid(finger, stack, outline, tip, board, mount, interfaces, keys),
        interface=held[0] if held else None,
        board=board_solid(finger, stack, board),
        silicone=silicone_solid(
            stack, outline, board, mould, fillings(keys, stack, outline, tip, mould)
        ),
        film=film_solid(stack, outline, mould),
        parts=tuple(part_solid(part, stack) for part in finger.parts),
    )


def part_solid(part: Part, stack: Stack) -> Solid:
    """A part as a box on its side of the board."""
    low = stack.rim_z_mm if part.side == "front" else stack.pocket_z_mm - part.height_mm
    corner = Plane((part.box.x_min_mm, part.box.y_min_mm, low))
    return Solid.make_box(part.size_x_mm, part.size_y_mm, part.height_mm, corner)


def board_solid(finger: Finger, stack: Stack, board: Board) -> Solid:
    """The board with the holes for pins and wires."""
    holes = [_circle(at, board.hole_mm) for at in finger.holes]
    holes += [_circle(at, finger.connector.drill_mm) for at in finger.connector.pads]
    face = Face(box_face(board.box).outer_wire(), holes)
    low = face.moved(Location((0, 0, stack.pocket_z_mm)))
    return Solid.extrude(low, Vector(0, 0, stack.pcb_mm))


def _circle(at: Point, diameter_mm: float) -> Wire:
    return Wire.make_circle(diameter_mm / 2, Plane((at[0], at[1], 0.0)))
