"""Measures of a backing's plate, taken in the finger's sensor frame: outline, pocket, pins,
room behind the board, and the wedge at the tip."""

from collections.abc import Iterator

import numpy as np
import shapely

from lumitip_fab.checks.printed import Printed, circles, farthest, islands_at
from lumitip_fab.checks.readers.solids import Vectors, cast, inside, section
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Box
from lumitip_fab.design.frames import applied, mount_to_sensor

GAP_MM = (0.10, 0.30)
OUTLINE_MM = 0.05
DEPTH_MM = 0.05
PIN_MM = 0.05
ANGLE_DEG = 0.5
FILLET_MM = 0.4  # solder round the foot of a pad's tail
_DOWN = np.array([0.0, 0.0, -1.0])
_START_MM = 5.0  # rays start this far in front of the rim


def measure_outline(part: Printed) -> Iterator[Measurement]:
    """The plate's silhouette just behind the rim, above the wedge, but for the notch."""
    design, notch = part.design, part.finger.notch
    silhouette = shapely.LinearRing(design.outline.polygon(24))
    corners = shapely.get_coordinates(shapely.segmentize(silhouette, 1.0))
    open_ = (np.abs(corners[:, 0]) < notch.x_max_mm) & (corners[:, 1] < notch.y_max_mm)
    cut = section(part.sensor, design.stack.face_z_mm - design.tip.edge_mm / 2)
    skins = [p.exterior for p in shapely.get_parts(cut) if p.geom_type == "Polygon"]
    off = shapely.distance(shapely.points(corners[~open_]), shapely.union_all(skins))
    yield part.near("outline", np.asarray(off), 0.0, OUTLINE_MM)


def measure_pocket(part: Printed) -> Iterator[Measurement]:
    """Gap from each side of the board to the pocket, and the pocket's depth."""
    design = part.design
    low, high = (gap + design.printing.fit_mm for gap in GAP_MM)
    stack, box, notch = design.stack, design.board.box, part.finger.notch
    cut = section(part.sensor, stack.rim_z_mm - stack.pcb_mm / 2)
    steps = np.linspace(0.01, 0.99, 25)
    xs, ys = box.x_min_mm + steps * box.width_mm, box.y_min_mm + steps * box.length_mm
    beside = xs[(xs < notch.x_min_mm) | (xs > notch.x_max_mm)]
    sides = {
        "left": ([(box.x_min_mm, y) for y in ys], (-1.0, 0.0)),
        "right": ([(box.x_max_mm, y) for y in ys], (1.0, 0.0)),
        "tip": ([(x, box.y_max_mm) for x in xs], (0.0, 1.0)),
        "gripper": ([(x, box.y_min_mm) for x in beside], (0.0, -1.0)),
    }
    for side, (starts, outward) in sides.items():
        from_ = np.array(starts) - np.array(outward) * 0.5
        lines = shapely.linestrings(np.stack([from_, from_ + np.array(outward) * 3.0], axis=1))
        gaps = shapely.distance(shapely.points(from_), shapely.intersection(lines, cut)) - 0.5
        yield part.figure(
            "pocket_gap", farthest(np.asarray(gaps), (low + high) / 2), low, high, at=side
        )
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
    tail = mount.block_front_w_mm - stack.pcb_mm if stack.sunk else stack.floor_mm
    rooms = [(q.name, q.box, q.height_mm) for q in part.finger.parts if q.side == "back"]
    for place, (x, y) in enumerate(pads.pads, start=1):
        solder, wire = pads.pad_mm / 2, pads.drill_mm / 2
        rooms.append(
            (f"pad {place}", Box(x - solder, x + solder, y - solder, y + solder), FILLET_MM)
        )
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


def measure_tip(part: Printed) -> Iterator[Measurement]:
    """The wedge: thickness at the tip edge and angle."""
    outline, tip = part.design.outline, part.design.tip
    slope = np.tan(np.radians(tip.angle_deg))
    xs = np.linspace(-0.45, 0.45, 9) * outline.tip_width_mm
    edge = _thickness(part, np.array([(x, outline.tip_y_mm - 0.05) for x in xs])) - 0.05 * slope
    yield part.near("tip_edge", edge, tip.edge_mm, DEPTH_MM)
    low, high = tip.slant_start_y_mm + 0.3, outline.tip_y_mm - 0.3
    thick = _thickness(part, np.array([(x, y) for x in xs for y in (low, high)]))
    angles = np.degrees(np.arctan((thick[::2] - thick[1::2]) / (high - low)))
    yield part.near("slant", angles, tip.angle_deg, ANGLE_DEG, "°")


def _rim_z(part: Printed) -> float:
    """Height of the rim between pocket and tip."""
    design = part.design
    y = (design.board.pocket.y_max_mm + design.outline.tip_y_mm) / 2
    xs = np.array([-0.3, 0.0, 0.3]) * design.outline.tip_width_mm
    return float(np.median(front_z(part, np.array([(x, y) for x in xs]))))


def front_z(part: Printed, points: Vectors) -> Vectors:
    """Height of what is seen from the front at points (x, y); NaN through a hole."""
    above = np.column_stack([points, np.full(len(points), part.design.stack.rim_z_mm + _START_MM)])
    drop, _ = cast(part.sensor, above, _DOWN, 40.0).first(len(points))
    return np.asarray(np.where(np.isfinite(drop), above[:, 2] - drop, np.nan))


def _thickness(part: Printed, points: Vectors) -> Vectors:
    """Thickness along z at points (x, y); NaN where the rays do not cross two faces."""
    above = np.column_stack([points, np.full(len(points), part.design.stack.rim_z_mm + _START_MM)])
    hits = cast(part.sensor, above, _DOWN, 40.0)
    thick = np.full(len(points), np.nan)
    for k in range(len(points)):
        crossed = hits.distance_mm[hits.ray == k]
        if len(crossed) == 2:
            thick[k] = crossed[1] - crossed[0]
    return thick


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
