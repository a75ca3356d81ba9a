"""Measures of a compliant finger's parts: the bendable plate as it lies on the bed, the holes that
the board is tied through, and how the interface sits in the plate's groove."""

from collections.abc import Iterator

import numpy as np
import shapely

from lumitip_fab.checks.plate import DEPTH_MM, floor_points, front_z
from lumitip_fab.checks.printed import Printed, circles, holes_at
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.solids import Vectors, cast, section
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Interface
from lumitip_fab.design.frames import applied, mount_to_sensor

HOLE_MM = 0.05
GLUE_MM = 0.05
SHARED_MM3 = 0.05
SIZE_MM = 0.05
STEP_MM = 0.5
_UP = np.array([0.0, 0.0, 1.0])


def measure_face(part: Printed) -> Iterator[Measurement]:
    """The plate's front, on which the board lies: flat, and where the stack has it."""
    heights = front_z(part, floor_points(part))
    yield part.near("face", heights, part.design.stack.face_z_mm, DEPTH_MM)


def measure_ties(part: Printed) -> Iterator[Measurement]:
    """The holes for thread behind those of the board: place and diameter, at front and back."""
    stack, hole = part.design.stack, _interface(part).thread_hole_mm
    for side, z_mm in (("front", stack.face_z_mm - 0.1), ("back", stack.back_z_mm + 0.1)):
        holes = _clear_of_wedge(part) if side == "back" else part.finger.holes
        off, wide = circles(holes_at(part.sensor, z_mm), holes, hole / 2)
        yield part.near("ties", off, 0.0, HOLE_MM, at=side)
        yield part.near("tie_hole", wide, hole, HOLE_MM, at=side)


def measure_groove(part: Printed) -> Iterator[Measurement]:
    """The groove's depth along its middle, and its width by a section half way down."""
    interface, stack = _interface(part), part.design.stack
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
    design, interface = part.design, _interface(part)
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


def measure_joint(plate: Printed, held: Printed) -> Iterator[Measurement]:
    """Rim in groove: the gap for glue beside it, its height, what both share, and the pad."""
    interface, stack = _interface(plate), plate.design.stack
    half_way = stack.back_z_mm + interface.rim_height_mm / 2
    rim, around = section(held.sensor, half_way), section(plate.sensor, half_way)
    edge = shapely.get_coordinates(shapely.segmentize(shapely.boundary(rim), STEP_MM))
    near = np.asarray(shapely.distance(shapely.points(edge), around))
    # The rim's ends at the gripper and the slope under its upper bar stand farther off.
    beside = near[near < interface.groove_mm / 2]
    least = float(beside.min()) if len(beside) > len(near) / 2 else float("nan")
    wanted = interface.glue_mm + held.design.printing.fit_mm  # the rim's, not the groove's
    yield held.figure("glue", least, wanted - GLUE_MM, wanted + GLUE_MM)
    top = float(held.sensor.bounds[1, 2])
    rise = np.array([top - stack.back_z_mm])
    yield held.near("rim_height", rise, interface.rim_height_mm, GLUE_MM)
    shared = solids.shared_mm3(
        solids.solid(plate.sensor, "the backing"), solids.solid(held.sensor, "the interface")
    )
    yield held.figure("joint", shared, 0.0, SHARED_MM3, "mm³")
    yield held.near("pad", _pad_z(held), stack.back_z_mm, DEPTH_MM)


def _pad_z(part: Printed) -> Vectors:
    """Heights of the pad within its rim, seen from the front."""
    interface = _interface(part)
    inner = interface.box.grown(-interface.rim_mm - 1.5)
    xs = np.linspace(inner.x_min_mm, inner.x_max_mm, 9)
    ys = np.linspace(inner.y_min_mm + interface.rim_mm, inner.y_max_mm, 9)
    return front_z(part, np.array([(x, y) for x in xs for y in ys]))


def _interface(part: Printed) -> Interface:
    return part.design.interfaces[0]


def _clear_of_wedge(part: Printed) -> tuple[tuple[float, float], ...]:
    """Holes where the plate has its full thickness."""
    low = part.design.tip.slant_start_y_mm - _interface(part).thread_hole_mm
    return tuple(hole for hole in part.finger.holes if hole[1] < low)
