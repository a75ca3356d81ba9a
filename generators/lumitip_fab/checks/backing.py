"""The backings as files: printable, and everything that goes into or onto them fits."""

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import shapely

from lumitip_fab.checks import keys, plate, printed, tip
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.solids import Vectors, cast, section
from lumitip_fab.checks.result import Measure, Measurement, measured, unreadable
from lumitip_fab.checks.walls import MESH_MM, Exempt, Mask, beside, measure_relief, walls
from lumitip_fab.design import Design, Finger, Letter
from lumitip_fab.design.cabling import THREAD_MM, outer_mm
from lumitip_fab.design.frames import (
    Matrix,
    applied,
    backing_bed_to_sensor,
    mount_to_sensor,
    plate_back_to_sensor,
)
from lumitip_fab.errors import OutputError

POSITION_MM = 0.05
DIAMETER_MM = 0.1
DEPTH_MM = 0.05
_DOWN, _UP = np.array([0.0, 0.0, -1.0]), np.array([0.0, 0.0, 1.0])
_REACH_MM = 30.0


def measure_bolt(part: printed.Printed) -> Iterator[Measurement]:
    """Bolt holes, above the pins, and gripper pins: place, diameter, and room for the bolt."""
    mount = part.design.mount
    rings = printed.holes_at(part.standing, (mount.land_mm + mount.pin_depth_mm) / 2)
    bolts = tuple((u, mount.bolt_w_mm) for u in mount.bolt_u_mm)
    off, wide = printed.circles(rings, bolts, mount.bolt_hole_mm / 2)
    yield part.near("bolt", off, 0.0, POSITION_MM)
    yield part.near("bolt_hole", wide, mount.bolt_hole_mm, DIAMETER_MM)
    bolt, fit_mm = part.design.threads[mount.bolt], part.design.printing.fit_mm
    clear, low, high, _ = printed.round_thread(printed.room(rings, bolts), bolt, fit_mm)
    yield part.figure("bolt_clearance", clear, low, high)
    pins = tuple((u, mount.bolt_w_mm) for u in mount.pin_u_mm)
    if pins:
        rings = printed.holes_at(part.standing, mount.pin_depth_mm / 2)
        off, wide = printed.circles(rings, pins, mount.pin_mm / 2)
        yield part.near("gripper_pins", off, 0.0, POSITION_MM)
        yield part.near("gripper_pin_hole", wide, mount.pin_mm, DIAMETER_MM)
        beside = (mount.pin_mm + mount.bolt_hole_mm) / 4 if mount.sleeved else 0.0
        below = np.array([(u + beside, w, -1.0) for u, w in pins])
        depth, _ = cast(part.standing, below, _UP, 2 * mount.land_mm + 1).first(len(pins))
        yield part.near("gripper_pin_depth", depth - 1.0, mount.pin_depth_mm, DEPTH_MM)


def measure_screw(part: printed.Printed) -> Iterator[Measurement]:
    """The screws' seats, seen from where screw and driver come: nothing may stand above them."""
    mount = part.design.mount
    above = float(part.standing.bounds[1, 2]) + 1.0
    turn = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)
    radii = np.linspace(mount.bolt_hole_mm / 2 + 0.15, mount.counterbore_mm / 2 - 0.1, 4)
    radius, angle = (grid.ravel() for grid in np.meshgrid(radii, turn))
    around = np.column_stack(
        [
            radius * np.cos(angle),
            mount.bolt_w_mm + radius * np.sin(angle),
            np.full(radius.size, above),
        ]
    )
    origins = np.concatenate([around + np.array([u, 0.0, 0.0]) for u in mount.bolt_u_mm])
    drop, _ = cast(part.standing, origins, _DOWN, above + 1).first(len(origins))
    yield part.near("screw_seat", above - drop, mount.land_mm, DEPTH_MM)


def measure_nose(part: printed.Printed) -> Iterator[Measurement]:
    """Half the width of the nose on either side, against its trapezoid."""
    mount, nose = part.design.mount, part.design.mount.nose
    if nose is None:
        return
    spread = np.tan(np.radians(nose.half_angle_deg))
    rows = np.linspace(
        mount.block_front_w_mm + 0.3, mount.block_back_w_mm - mount.block_corner_mm, 8
    )
    half = np.minimum(
        nose.front_width_mm / 2 + (rows - nose.front_w_mm) * spread, mount.block_width_mm / 2
    )
    cut = section(part.standing, nose.height_mm / 2)
    reach = mount.block_width_mm / 2 + 1.0  # less than where the plate begins beside the notch
    errors = []
    for w, wanted in zip(rows, half, strict=True):
        bounds = shapely.LineString([(-reach, w), (reach, w)]).intersection(cut).bounds
        errors += [bounds[2] - wanted, -bounds[0] - wanted] if bounds else [np.nan]
    yield part.near("nose", np.array(errors), 0.0, POSITION_MM)


READS = (
    "backing/*.stl",
    "interface/*.stl",
    "interface/*.3mf",
    "interface/*.step",
)

PUBLISHED_OVERHANG_MM2 = 341.0  # of the published part, standing on its mount face
FLAT_OVERHANG_MM2 = 0.5  # of a plate printed on its front: no support
LEAST_BED_MM2 = 120.0  # on which a finger 55 mm tall stays up
SIZE_MM = 0.05
Step = Measure[printed.Printed]


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every figure of both backings."""
    stack, mount = design.stack, design.mount
    for finger in design.fingers:
        made = [_read(outputs, design, finger, "backing", backing_bed_to_sensor(mount, stack))]
        if design.interfaces:
            made.append(_read(outputs, design, finger, "interface", mount_to_sensor(mount, stack)))
        for part in made:
            if isinstance(part, Measurement):
                yield part
                continue
            yield part.figure("readable", float(len(part.standing.faces)), 4, np.inf, "triangles")
            yield from _measured(part)
        whole = [part for part in made if isinstance(part, printed.Printed)]
        if len(whole) == 2:
            yield from measured((plate.measure_joint,), replace(whole[1], plate=whole[0]))


def _read(
    outputs: Path, design: Design, finger: Finger, kind: str, to_sensor: Matrix
) -> printed.Printed | Measurement:
    subject = f"{kind}/{finger.name}_{kind}.stl"
    try:
        standing = solids.read_mesh(outputs / subject)
    except OutputError as error:
        return unreadable("backing.readable", subject, str(error))
    sensor = solids.moved(standing, to_sensor)
    return printed.Printed("backing", subject, standing, sensor, finger, design, to_sensor, kind)


_PLATE: tuple[Step, ...] = (
    plate.measure_outline,
    plate.measure_reliefs,
    plate.measure_notch,
    tip.measure_tip,
    keys.measure_keys,
)
_HELD: tuple[Step, ...] = (measure_bolt, measure_screw, measure_nose)


def _measured(part: printed.Printed) -> Iterator[Measurement]:
    steps: tuple[Step, ...] = (measure_print, measure_walls, measure_letter)
    if part.design.stack.sunk:
        steps += (
            measure_size,
            measure_thread,
            plate.measure_pocket,
            plate.measure_pins,
            *_PLATE,
            *_HELD,
        )
    elif part.kind == "backing":
        steps += (
            plate.measure_sheet_size,
            plate.measure_face,
            plate.measure_ties,
            plate.measure_groove,
            *_PLATE,
        )
    else:
        steps += (plate.measure_interface_size, *_HELD)
    yield from measured(steps, part)


def measure_print(part: printed.Printed) -> Iterator[Measurement]:
    """One closed body; overhang, and contact with the print bed."""
    most = PUBLISHED_OVERHANG_MM2 if part.kind == part.design.held else FLAT_OVERHANG_MM2
    yield from printed.measure_closed(part, part.standing)
    printing = part.design.printing
    yield from printed.measure_bed(part, part.standing, printing, most, LEAST_BED_MM2)


def measure_size(part: printed.Printed) -> Iterator[Measurement]:
    """The box round the part as it stands, against outline and coupling."""
    design = part.design
    stack, tip_y = design.stack, design.outline.tip_y_mm
    half = float(np.abs(design.outline.polygon()[:, 0]).max())
    edges = np.array(
        [(0.0, tip_y, stack.rim_z_mm), (0.0, tip_y, stack.rim_z_mm - design.tip.edge_mm)]
    )
    inverse = np.asarray(np.linalg.inv(mount_to_sensor(design.mount, stack)), dtype=np.float64)
    front, back = applied(inverse, edges)
    height = max(front[2], back[2])
    wanted = np.array(
        [[-half, min(front[1], 0.0), 0.0], [half, design.mount.block_back_w_mm, height]]
    )
    yield part.near("size", (part.standing.bounds - wanted).ravel(), 0.0, SIZE_MM)


def measure_letter(part: printed.Printed) -> Iterator[Measurement]:
    """The letter on the back of the coupling's block, or of a bendable plate."""
    letter, to_letter = _letter(part)
    mesh = solids.moved(part.standing, to_letter)
    yield measure_relief("backing.letter", part.subject, mesh, part.finger, letter)


def measure_thread(part: printed.Printed) -> Iterator[Measurement]:
    """From the board to the block along the thread of the strain relief, by rays: a wire and the
    thread over it are to fit."""
    design, name = part.design, part.finger.name
    ends = {
        cable.section_mm2
        for cable in design.cabling.cables
        if name in (cable.start.board, cable.end.board)
    }
    for tie in part.finger.ties:
        (left, y), (right, _) = tie.holes
        xs, ys = np.meshgrid(
            np.linspace(left, right, 41), y + THREAD_MM * np.arange(-1.5, 1.0, 0.5)
        )
        start = np.column_stack(
            [xs.ravel(), ys.ravel(), np.full(xs.size, design.stack.pocket_z_mm)]
        )
        gap, _ = cast(part.sensor, start, _DOWN, _REACH_MM).first(len(start))
        least = outer_mm(max(ends)) + THREAD_MM
        note = f"behind the board, for a wire and {THREAD_MM:g} mm of thread"
        low = least - DEPTH_MM
        yield part.figure("thread_room", float(gap.min()), low, math.inf, note=note, at=tie.ref)


def _letter(part: printed.Printed) -> tuple[Letter, Matrix]:
    """The part's letter, and the matrix from its print bed to its frame."""
    design = part.design
    if part.kind == design.held:
        return design.mount.letter, np.eye(4)
    from_sensor = np.linalg.inv(plate_back_to_sensor(design.mount, design.stack))
    return design.interfaces[0].letter, np.asarray(from_sensor @ part.to_sensor)


def measure_walls(part: printed.Printed) -> Iterator[Measurement]:
    """The thinnest walls. Thinner ones are listed here by name, each with its own limit."""
    design, mount = part.design, part.design.mount
    letter, to_letter = _letter(part)
    about = beside(letter, design.printing)

    slant, floor_mm = math.radians(design.tip.angle_deg), design.stack.floor_mm
    start_y = design.tip.slant_start_y_mm
    tip_y = start_y + floor_mm * math.tan(slant) + MESH_MM

    def on_tip(points: Vectors) -> Mask:
        places, edge_mm = applied(part.to_sensor, points), design.tip.edge_mm
        tip = places[:, 1] > tip_y
        if edge_mm < design.printing.min_wall_mm:
            return np.asarray(tip)
        # From a key to a thick tip edge is a wall like others, and so is what is behind the roof.
        past_roof = places[:, 1] > tip_y + design.board.roof_mm
        return np.asarray(tip & past_roof & ~keys.near(design, places, edge_mm))

    def at_slant(points: Vectors) -> Mask:
        """Where the slant may begin below the floor of the pocket, which is not the tip's."""
        y = applied(part.to_sensor, points)[:, 1]
        return np.asarray((y > start_y) & (y <= tip_y))

    def between(points: Vectors) -> Mask:
        far = max(*mount.pin_u_mm, *mount.bolt_u_mm) + max(mount.pin_mm, mount.bolt_hole_mm) / 2
        beside = np.abs(points[:, 1] - mount.bolt_w_mm) < mount.bolt_hole_mm / 2
        low = points[:, 2] < mount.land_mm
        return np.asarray(beside & low & (np.abs(points[:, 0]) < far))

    exempt = [replace(about, holds=lambda points: about.holds(applied(to_letter, points)))]
    if part.kind == "backing":
        leaning = min(design.printing.min_wall_mm, floor_mm * math.cos(slant))
        exempt.insert(0, Exempt("tip edge", design.tip.edge_mm, on_tip))
        exempt.insert(1, Exempt("floor at the slant", leaning, at_slant))
    if part.kind == design.held and mount.pin_u_mm and not mount.sleeved:
        away = abs(max(mount.pin_u_mm) - max(mount.bolt_u_mm))
        apart = away - (mount.pin_mm + mount.bolt_hole_mm) / 2
        least = min(apart, design.printing.min_wall_mm)
        exempt.append(Exempt("bolt to gripper pins", least, between))
    yield from walls(
        "backing.min_wall", part.subject, part.standing, design.printing.min_wall_mm, exempt
    )
