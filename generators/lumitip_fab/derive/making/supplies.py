"""How much of glue, primer, tape, thread, ties and mating connectors a pair of fingers uses."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from shapely import Polygon

from lumitip_fab.config.load import Input
from lumitip_fab.derive.finger.stack import is_flex
from lumitip_fab.design import (
    AuxiliaryBoard,
    Board,
    Cabling,
    Clamp,
    Finger,
    Holder,
    Insert,
    Interface,
    Key,
    Mount,
    Outline,
    Point,
    Stack,
)
from lumitip_fab.design.board_rules import common_supply_mm
from lumitip_fab.design.boards import GLUE_FILM_MM
from lumitip_fab.design.cabling import plugged_headers
from lumitip_fab.design.gripper_cable import GripperCable, gripper_cable

TAPE_MARGIN_MM = 5.0
"""Of the tape beyond a window, on each side."""
KNOT_MM = 80.0
"""Of a thread, on each side of its knot."""
STRIPS = 2
"""Of tape, across a plate in its mould without a printed clamp; with it, one across the tip of a
plate that bends."""
CLAMP_END_MM = 25.0
"""Of such a strip on the mould's outside, at each end."""
TURNS = 2
"""Of a thread, through both holes."""
TIE_MM = 200.0
"""Length of a cable tie: the product in `packs.toml`."""
CARRIER_MM = 300.0
"""Of tape, that holds a mask's film on the paper that carries it through the printer."""
FREE_END_MM = 30.0
"""Of tape, over the end of a wire that stays free in the first test."""
HELD_TURNS = 3
"""Of tape, round a finger, that hold its flaps down while their adhesive hardens."""
INSERT_MM = 120.0
"""Of tape, on the drawing by which a smooth film is cut."""
A4_MM = (210.0, 297.0)
CUT_MM = 5.0
"""Of a sheet, from one insert to the next."""
ROUND_MM = 400.0
"""Round a gripper, with the knot (assumed)."""
TIE_LOCK_MM = 25.0
"""Of a cable tie, for its lock and to pull at."""


@dataclass(frozen=True)
class Used:
    """What a pair of fingers uses out of a pack."""

    pack: str
    where: str
    quantity: float
    unit: str


@dataclass(frozen=True)
class Assembled:
    """What is glued, primed, taped, tied and plugged together."""

    fingers: tuple[Finger, Finger]
    board: Board
    stack: Stack
    outline: Outline
    interfaces: tuple[Interface, ...]
    holders: tuple[Holder, ...]
    auxiliary_boards: tuple[AuxiliaryBoard, ...]
    cabling: Cabling
    mount: Mount
    clamps: tuple[Clamp, ...]
    inserts: tuple[Insert, ...]
    keys: tuple[Key, ...]


def derive_supplies(config: Input, of: Assembled) -> tuple[Used, ...]:
    """All supplies, in the order of work."""
    found = (*_tied(of), *_held(of), *_plugged(config, of), *_cast(config, of))
    return tuple(replace(each, quantity=round(each.quantity, 2)) for each in found)


def _tied(of: Assembled) -> Iterator[Used]:
    """Thread of the cables' strain relief, of the boards on bendable plates, and of a controller's
    board that no holder has."""
    ties = [tie for finger in of.fingers for tie in finger.ties]
    length = sum(_loop_mm(*tie.holes, of.stack.pcb_mm) for tie in ties)
    outside = [tie for board in of.auxiliary_boards for tie in board.ties]
    length += sum(_loop_mm(*tie.holes, of.stack.auxiliary_mm) for tie in outside)
    where = f"strain relief of {len(ties) + len(outside)} cable ends"
    if of.interfaces:
        through = of.stack.pcb_mm + of.stack.floor_mm
        for finger in of.fingers:
            pairs = zip(finger.holes[::2], finger.holes[1::2], strict=False)
            length += sum(_loop_mm(one, other, through) for one, other in pairs)
        where += ", boards on their plates"
    if not of.holders and any(board.name == "breakout" for board in of.auxiliary_boards):
        length += 2 * ROUND_MM
        where += ", controller's board beside the gripper"
    if length:
        yield Used("waxed thread", where, length / 1000, "m")


def _loop_mm(one: Point, other: Point, through_mm: float) -> float:
    """A thread through two holes and back, some turns, with a knot."""
    return TURNS * 2 * (math.dist(one, other) + through_mm) + 2 * KNOT_MM


def _held(of: Assembled) -> Iterator[Used]:
    """Cable ties: loops round the gripper through the lugs of the holder's arms, at the lugs of
    fingers and holder, and without lugs round a cable that no thread holds."""
    count = 0
    for holder in of.holders:
        each = max(2, math.ceil(holder.tie_loop_mm / (TIE_MM - TIE_LOCK_MM)))
        count += len(holder.arm_lugs) // 2 * each
    loose = [finger for finger in of.fingers if of.mount.lugs or not finger.ties]
    lugs = sum(len(holder.lugs) for holder in of.holders)
    where = ["holder round the gripper"] * bool(count) + ["cables at the gripper"] * bool(loose)
    where += ["cables at the holder"] * bool(lugs)
    if where:
        yield Used("cable tie", ", ".join(where), count + len(loose) + lugs, "piece")


def _plugged(config: Input, of: Assembled) -> Iterator[Used]:
    """A mating connector for each header of the flange that a cable ends at, and the gripper's own
    cable: from there, where its other plug and its current are the gripper's, or its maker's."""
    plugs = plugged_headers(of.cabling.cables, of.auxiliary_boards)
    own = _gripper_cable(config, of)
    lines = own.headers if own and not own.by_maker else ()
    headers, mate = sorted({*plugs, *lines}), config.parts.flange.header.mate
    if mate and headers:
        yield Used(mate, f"plug at {', '.join(headers)} of the flange", len(headers), "piece")
    if own and own.by_maker:
        yield Used("gripper cable by maker", "past the flange, to its own supply", 1, "piece")
    if lines:
        where = f"from {', '.join(lines)} of the flange: its maker's, or wires for its current"
        yield Used("gripper cable", where, 1, "piece")
    if own and own.feeds:
        yield Used("gripper fuse", "supply wire of the gripper's cable", 1, "piece")


def _gripper_cable(config: Input, of: Assembled) -> GripperCable | None:
    """The gripper's cable, where it has a flange."""
    if not any(board.name == "flange" for board in of.auxiliary_boards):
        return None
    track_mm = common_supply_mm(config.parameters.board.supply_track_mm)
    contact_a = config.parts.flange.contacts.contact_a
    cables, supply_a = of.cabling.cables, of.mount.supply_a
    return gripper_cable(of.auxiliary_boards, cables, supply_a, track_mm, contact_a)


def _cast(config: Input, of: Assembled) -> Iterator[Used]:
    """Glue, tape and primer, before the silicone is poured."""
    p = config.parameters
    where = "interfaces on backings" if is_flex(p) else "boards in their backings"
    yield Used(p.backing.glue, where, _glue_mm3(of) / 1000, "mL")
    width = config.parts.mould.tape.width_mm
    taped = sum(_strips_mm(sides, width) for f in of.fingers for sides in _windows(f, of))
    widest = 2 * max(x for x, _ in of.outline.polygon())
    strips = (1 if of.interfaces else 0) if of.clamps else STRIPS
    down = len(of.fingers) * strips * (widest + 2 * (p.mould.wall_mm + CLAMP_END_MM))
    uses = ["tips of both plates" if of.clamps else "clamps of both moulds"] * bool(down)
    uses += ["windows on the back while casting"] * bool(taped)
    carried = len(of.fingers) * CARRIER_MM if p.mask.route == "film" else 0.0
    uses += ["films on their carriers"] * bool(carried)
    cut = len(of.fingers) * INSERT_MM * len(of.inserts)
    uses += ["smooth films on their drawing"] * bool(cut)
    wires = [wire for cable in of.cabling.cables for wire in cable.wires]
    free = FREE_END_MM * sum(w.start.board == "breakout" or w.end.board == "supply" for w in wires)
    uses += ["free wires in the first test"] * bool(free)
    held = len(of.fingers) * HELD_TURNS * 2 * (widest + of.stack.thickness_mm)
    uses += ["flaps while their adhesive hardens"]
    tape_mm = taped + down + carried + cut + free + held
    yield Used(p.mould.tape, ", ".join(uses), tape_mm / 1000, "m")
    if primer := config.parts.mould.primer:
        cm2 = sum(Polygon(of.outline.polygon()).area for _ in of.fingers) / 100
        yield Used(p.mould.primer, "front of both fingers", cm2 / primer.coverage_cm2_ml, "mL")
    for insert in of.inserts:
        yield Used(p.mould.insert, "floor of both moulds", sheets(insert), "sheet")


def sheets(insert: Insert) -> int:
    """Sheets of A4 for the inserts of both moulds: one where two lie side by side."""
    short, long = sorted((insert.box.width_mm + CUT_MM, insert.box.length_mm + CUT_MM))
    pairs = ((2 * short, long), (short, 2 * long))
    fits = any(min(pair) <= A4_MM[0] and max(pair) <= A4_MM[1] for pair in pairs)
    return 1 if fits else 2


def _glue_mm3(of: Assembled) -> float:
    """A film under each board, the slit round it and the wedge beyond its tip, where the pocket is
    wider at the rim; or a film under each pad."""
    if of.interfaces:
        box = of.interfaces[0].box
        return len(of.fingers) * box.width_mm * box.length_mm * GLUE_FILM_MM
    box, gap = of.board.box, of.board.pocket_clearance_mm
    deep = of.stack.pcb_mm
    slit = 2 * (box.width_mm + box.length_mm) * gap * deep
    wedge = of.board.pocket.width_mm * of.board.roof_mm * deep / 2
    return len(of.fingers) * (box.width_mm * box.length_mm * GLUE_FILM_MM + slit + wedge)


def _windows(finger: Finger, of: Assembled) -> Iterator[Point]:
    """Sides of each window through the plate; the thread's holes are open too."""
    for relief in finger.reliefs:
        if relief.through:
            yield relief.box.width_mm, relief.box.length_mm
    if of.interfaces:
        hole = of.interfaces[0].thread_hole_mm
        yield from ((hole, hole) for _ in finger.holes)


def _strips_mm(sides_mm: Point, width_mm: float) -> float:
    """Length of tape over a window: strips along its longer side, as many as it needs."""
    short, long = (side + 2 * TAPE_MARGIN_MM for side in sorted(sides_mm))
    return math.ceil(short / width_mm - 1e-9) * long
