"""Measures of a backing's plate, taken in the finger's sensor frame: outline, pocket, pins, room
behind the board; of a bendable plate as it lies on the bed, with the holes
that the board is tied through and the groove in which its interface sits."""

from collections.abc import Iterator

import numpy as np
import shapely

from lumitip_fab.checks.keys import beside
from lumitip_fab.checks.printed import Printed, circles, front_z, holes_at, islands_at
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.solids import Vectors, cast, inside, section
from lumitip_fab.checks.result import Measurement, farthest
from lumitip_fab.design import Box
from lumitip_fab.design.frames import applied, mount_to_sensor

GAP_MM = (0.10, 0.30)
STL_DECIMALS = 4  # of mm: its corners are in single precision
OUTLINE_MM = 0.05
DEPTH_MM = 0.05
PIN_MM = 0.05
FILLET_MM = 0.4  # solder round the foot of a pad's tail
SIZE_MM = 0.05
HOLE_MM = 0.05
SLOT_MM = 0.05  # beside a slot of the tip edge, which is measured by itself
GLUE_MM = 0.05
FLOOR_MM = 0.05  # over the pocket's floor
SHARED_MM3 = 0.05
STEP_MM = 0.5
_UP = np.array([0.0, 0.0, 1.0])


def measure_outline(part: Printed) -> Iterator[Measurement]:
    """The plate's silhouette just behind the rim, above the wedge, but for notch and slots."""
    design, notch = part.design, part.finger.notch
    silhouette = shapely.LinearRing(design.outline.polygon(24))
    corners = shapely.get_coordinates(shapely.segmentize(silhouette, 1.0))
    open_ = (np.abs(corners[:, 0]) < notch.x_max_mm) & (corners[:, 1] < notch.y_max_mm)
    for slot in design.tip.slots:
        open_ |= shapely.contains_xy(shapely.box(*slot.grown(SLOT_MM).bounds_mm), corners)
    cut = section(part.sensor, design.stack.face_z_mm - design.printing.line_mm / 2)
    skins = [p.exterior for p in shapely.get_parts(cut) if p.geom_type == "Polygon"]
    off = shapely.distance(shapely.points(corners[~open_]), shapely.union_all(skins))
    yield part.near("outline", np.asarray(off), 0.0, OUTLINE_MM)


def measure_pocket(part: Printed) -> Iterator[Measurement]:
    """Gap from each side of the board to the pocket, and the pocket's depth."""
    design = part.design
    low, high = (gap + design.printing.fit_mm for gap in GAP_MM)
    stack, box, notch = design.stack, design.board.box, part.finger.notch
    cut = section(part.sensor, stack.rim_z_mm - stack.pcb_mm / 2)
    floor = section(part.sensor, stack.pocket_z_mm + FLOOR_MM)  # the end at the tip leans
    steps = np.linspace(0.01, 0.99, 25)
    xs, ys = box.x_min_mm + steps * box.width_mm, box.y_min_mm + steps * box.length_mm
    beside = xs[(xs < notch.x_min_mm) | (xs > notch.x_max_mm)]
    sides = {
        "left": ([(box.x_min_mm, y) for y in ys], (-1.0, 0.0)),
        "right": ([(box.x_max_mm, y) for y in ys], (1.0, 0.0)),
        "tip": ([(x, box.y_max_mm) for x in xs], (0.0, 1.0)),
        "gripper": ([(x, box.y_min_mm) for x in beside], (0.0, -1.0)),
    }
    leans = design.board.roof_mm / stack.pcb_mm * FLOOR_MM
    for side, (starts, outward) in sides.items():
        off, there = (leans, floor) if side == "tip" else (0.0, cut)
        from_ = np.array(starts) - np.array(outward) * 0.5
        lines = shapely.linestrings(np.stack([from_, from_ + np.array(outward) * 3.0], axis=1))
        gaps = (
            shapely.distance(shapely.points(from_), shapely.intersection(lines, there)) - 0.5 - off
        )
        gaps = np.round(gaps, STL_DECIMALS)
        yield part.figure("pocket_gap", farthest(gaps, (low + high) / 2), low, high, at=side)
    depths = _rim_z(part) - front_z(part, floor_points(part))
    yield part.near("pocket_depth", depths, stack.pcb_mm, DEPTH_MM)


def measure_pins(part: Printed) -> Iterator[Measurement]:
    """Locating pins in the board's holes: place, clearance all round, height under the rim."""
    board, stack, holes = part.design.board, part.design.stack, part.finger.holes
    rings = islands_at(part.sensor, stack.pocket_z_mm + 0.4 * stack.pcb_mm, 4 * board.pin_mm**2)
    off, wide = circles(rings, holes, board.hole_mm)
    yield part.near("pins", off, 0.0, PIN_MM)
    wanted = (board.hole_mm - board.pin_mm) / 2  # the fit in it
    yield part.near("pin_clearance", (board.hole_mm - wide) / 2, wanted, PIN_MM)
    low = _rim_z(part) - front_z(part, np.array(holes))
    yield part.figure("pin_height", farthest(low, 0.0), -0.02, stack.pcb_mm / 4)


def measure_reliefs(part: Printed) -> Iterator[Measurement]:
    """Material where parts on the back of the board and the connector's solder are."""
    stack, mount = part.design.stack, part.design.mount
    pads = part.finger.connector
    # Behind a bendable plate is the interface's pad.
    front = mount.block_front_w_mm - stack.pcb_mm if stack.sunk else stack.floor_mm
    rooms = [(q.name, q.box, q.height_mm) for q in part.finger.parts if q.side == "back"]
    for place, (x, y) in enumerate(pads.pads, start=1):
        solder, wire = pads.pad_mm / 2, pads.drill_mm / 2
        rooms.append(
            (f"pad {place}", Box(x - solder, x + solder, y - solder, y + solder), FILLET_MM)
        )
        # Below the notch the block rises at 45° to its front.
        tail = min(front, stack.floor_mm + part.finger.notch.y_max_mm - (y + solder))
        rooms.append((f"tail {place}", Box(x - wire, x + wire, y - wire, y + wire), tail))
    volumes = [
        _filled(part, _lattice(box, stack.pocket_z_mm - deep, stack.pocket_z_mm))
        for _, box, deep in rooms
    ]
    worst = int(np.argmax(volumes))
    yield part.figure("reliefs", volumes[worst], 0.0, 0.0, "%", at=rooms[worst][0])


def measure_notch(part: Printed) -> Iterator[Measurement]:
    """Material in the way of the wires: notch through the plate, but for the coupling behind."""
    design, notch = part.design, part.finger.notch
    open_ = Box(notch.x_min_mm, notch.x_max_mm, design.outline.end_y_mm, notch.y_max_mm)
    points = _lattice(open_.grown(-0.05), design.stack.back_z_mm, design.stack.face_z_mm, 12)
    inverse = np.asarray(
        np.linalg.inv(mount_to_sensor(design.mount, design.stack)), dtype=np.float64
    )
    front = applied(inverse, points)[:, 1] < design.mount.block_front_w_mm - 0.02
    yield part.figure("notch", _filled(part, points[front]), 0.0, 0.0, "%")


def _rim_z(part: Printed) -> float:
    """Height of the rim between the pocket's leaning end and the tip."""
    design, board = part.design, part.design.board
    y = (board.pocket.y_max_mm + board.roof_mm + design.outline.tip_y_mm) / 2
    xs = beside(design, np.linspace(-0.3, 0.3, 25) * design.outline.tip_width_mm)
    return float(np.median(front_z(part, np.array([(x, y) for x in xs]))))


def floor_points(part: Printed) -> Vectors:
    """Points over the pocket's floor, away from pins, reliefs and notch."""
    design = part.design
    box, floor = design.board.box.grown(-0.5), design.stack.floor_mm
    grid = np.meshgrid(
        np.linspace(box.x_min_mm, box.x_max_mm, 15), np.linspace(box.y_min_mm, box.y_max_mm, 15)
    )
    points = np.column_stack([axis.ravel() for axis in grid])
    free = np.ones(len(points), dtype=np.bool_)
    for taken in (
        part.finger.notch.grown(2 * floor),
        *(r.box.grown(0.2) for r in part.finger.reliefs),
    ):
        x, y = points.T
        free &= ~(
            (taken.x_min_mm < x)
            & (x < taken.x_max_mm)
            & (taken.y_min_mm < y)
            & (y < taken.y_max_mm)
        )
    holes = [interface.thread_hole_mm for interface in design.interfaces]
    away = max(design.board.hole_mm, *(wide / 2 + 0.2 for wide in holes), 0.0)
    for hole in part.finger.holes:
        free &= np.hypot(*(points - np.array(hole)).T) > away
    return points[free]


def _lattice(box: Box, z_min_mm: float, z_max_mm: float, steps: int = 6) -> Vectors:
    """Points that fill a block, a little inside its faces and off every symmetric place."""
    along = [
        np.linspace(low + 0.0107, high - 0.0113, steps)
        for low, high in (
            (box.x_min_mm, box.x_max_mm),
            (box.y_min_mm, box.y_max_mm),
            (z_min_mm, z_max_mm),
        )
    ]
    return np.column_stack([axis.ravel() for axis in np.meshgrid(*along)])


def _filled(part: Printed, points: Vectors) -> float:
    """Share of points in the material, in percent."""
    return 100.0 * float(inside(part.sensor, points).mean()) if len(points) else 0.0


def measure_face(part: Printed) -> Iterator[Measurement]:
    """The plate's front, on which the board lies: flat, and where the stack has it."""
    heights = front_z(part, floor_points(part))
    yield part.near("face", heights, part.design.stack.face_z_mm, DEPTH_MM)


def measure_ties(part: Printed) -> Iterator[Measurement]:
    """The holes for thread behind those of the board: place and diameter, at front and back."""
    stack, hole = part.design.stack, part.design.interfaces[0].thread_hole_mm
    for side, z_mm in (("front", stack.face_z_mm - 0.1), ("back", stack.back_z_mm + 0.1)):
        holes = _clear_of_wedge(part) if side == "back" else part.finger.holes
        off, wide = circles(holes_at(part.sensor, z_mm), holes, hole / 2)
        yield part.near("ties", off, 0.0, HOLE_MM, at=side)
        yield part.near("tie_hole", wide, hole, HOLE_MM, at=side)


def measure_groove(part: Printed) -> Iterator[Measurement]:
    """The groove's depth along its middle, and its width by a section half way down."""
    interface, stack = part.design.interfaces[0], part.design.stack
    box, wide = interface.groove, interface.groove_mm
    middle, low = box.grown(-wide / 2), part.design.stack.back_z_mm - 3.0
    # Off the corners, where the groove is wider.
    ys = np.linspace(box.y_min_mm + 1.0, middle.y_max_mm - wide, 24)
    xs = np.linspace(middle.x_min_mm + wide, middle.x_max_mm - wide, 24)
    along = [(x, y) for y in ys for x in (middle.x_min_mm, middle.x_max_mm)]
    along += [(x, middle.y_max_mm) for x in xs]
    starts = np.column_stack([along, np.full(len(along), low)])
    reach, _ = cast(part.sensor, starts, _UP, 20.0).first(len(starts))
    yield part.near(
        "groove_depth", low + reach - stack.back_z_mm, interface.groove_depth_mm, DEPTH_MM
    )
    cut = section(part.sensor, stack.back_z_mm + interface.groove_depth_mm / 2)
    lines = [shapely.LineString([(x - wide, y), (x + wide, y)]) for x, y in along[: 2 * len(ys)]]
    lines += [shapely.LineString([(x, y - wide), (x, y + wide)]) for x, y in along[2 * len(ys) :]]
    gaps = [line.difference(cut) for line in lines]
    widths = [
        next((g.length for g in shapely.get_parts(gap) if g.distance(shapely.Point(at)) < 1e-6), 0)
        for gap, at in zip(gaps, along, strict=True)
    ]
    yield part.near("groove", np.array(widths, dtype=float), wide, 2 * GLUE_MM)


def measure_sheet_size(part: Printed) -> Iterator[Measurement]:
    """The box round the plate as it lies on its front."""
    design = part.design
    half = float(np.abs(design.outline.polygon()[:, 0]).max())
    stack, mount = design.stack, design.mount
    # The plate ends in the mount plane, which leans: on its front or on its back it is longer.
    lean = np.tan(np.radians(mount.tilt_deg))
    ends = [
        mount.origin_y_mm - (stack.rim_z_mm - z) * lean for z in (stack.face_z_mm, stack.back_z_mm)
    ]
    wanted = np.array([[-half, -design.outline.tip_y_mm, 0.0], [half, -min(ends), stack.plate_mm]])
    yield part.near("size", (part.standing.bounds - wanted).ravel(), 0.0, SIZE_MM)


def measure_interface_size(part: Printed) -> Iterator[Measurement]:
    """The box round the interface as it stands on its mount face."""
    design, interface = part.design, part.design.interfaces[0]
    box, stack = interface.box, design.stack
    top, half = stack.back_z_mm + interface.rim_height_mm, box.x_max_mm
    tips = np.array([(0.0, box.y_max_mm, z) for z in (top, stack.back_z_mm - interface.pad_mm)])
    feet = np.array([(0.0, box.y_min_mm, top)])
    inverse = np.asarray(np.linalg.inv(mount_to_sensor(design.mount, stack)))
    tips, feet = applied(inverse, tips), applied(inverse, feet)
    front = min(float(tips[0, 1]), float(feet[0, 1]))
    wanted = np.array(
        [[-half, front, 0.0], [half, design.mount.block_back_w_mm, float(tips[:, 2].max())]]
    )
    yield part.near("size", (part.standing.bounds - wanted).ravel(), 0.0, SIZE_MM)


def measure_joint(held: Printed) -> Iterator[Measurement]:
    """Rim in groove: the gap for glue beside it, its height, what both share, and the pad."""
    if (plate := held.plate) is None:
        return
    interface, stack = plate.design.interfaces[0], plate.design.stack
    half_way = stack.back_z_mm + interface.rim_height_mm / 2
    rim, around = section(held.sensor, half_way), section(plate.sensor, half_way)
    edge = shapely.get_coordinates(shapely.segmentize(shapely.boundary(rim), STEP_MM))
    near = np.asarray(shapely.distance(shapely.points(edge), around))
    # The rim's ends at the gripper and the slope under its upper bar stand farther off.
    beside = near[near < interface.groove_mm / 2]
    least = float(beside.min()) if len(beside) > len(near) / 2 else float("nan")
    wanted = interface.glue_mm + held.design.printing.fit_mm  # the rim's, not the groove's
    yield held.figure("glue", least, wanted - GLUE_MM, wanted + GLUE_MM)
    rise = float(held.sensor.bounds[1, 2]) - stack.back_z_mm
    yield held.near("rim_height", rise, interface.rim_height_mm, GLUE_MM)
    shared = solids.shared_mm3(
        solids.solid(plate.sensor, "the backing"), solids.solid(held.sensor, "the interface")
    )
    yield held.figure("joint", shared, 0.0, SHARED_MM3, "mm³")
    yield held.near("pad", _pad_z(held), stack.back_z_mm, DEPTH_MM)


def _pad_z(part: Printed) -> Vectors:
    """Heights of the pad within its rim, seen from the front."""
    interface = part.design.interfaces[0]
    inner = interface.box.grown(-interface.rim_mm - 1.5)
    xs = np.linspace(inner.x_min_mm, inner.x_max_mm, 9)
    ys = np.linspace(inner.y_min_mm + interface.rim_mm, inner.y_max_mm, 9)
    return front_z(part, np.array([(x, y) for x in xs for y in ys]))


def _clear_of_wedge(part: Printed) -> tuple[tuple[float, float], ...]:
    """Holes where the plate has its full thickness."""
    low = part.design.tip.slant_start_y_mm - part.design.interfaces[0].thread_hole_mm
    return tuple(hole for hole in part.finger.holes if hole[1] < low)
