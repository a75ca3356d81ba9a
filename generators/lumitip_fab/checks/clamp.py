"""The clamp as files: it prints without support, its feet meet the plate behind the stops, it is
clear of all else, and its marks are in one line with the mould's when the plate is down.

Everything is measured in the frame of the mould's bed, for both fingers.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import manifold3d
import numpy as np
import shapely

from lumitip_fab.checks.printed import (
    as_moulds,
    circles,
    holes_at,
    measure_bed,
    measure_closed,
    room,
    round_head,
    round_thread,
)
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.result import Measure, Measurement, Subject, farthest, measured, unreadable
from lumitip_fab.checks.walls import walls
from lumitip_fab.design import Box, Clamp, Design, Finger
from lumitip_fab.design.clamp import MARK_MM, PITCH_MM
from lumitip_fab.design.frames import (
    backing_bed_to_sensor,
    clamp_bed_to_sensor,
    mould_bed_to_sensor,
    mount_to_sensor,
)
from lumitip_fab.design.making import tip_stop_mm
from lumitip_fab.errors import OutputError

READS = ("mould/*.stl", "backing/*.stl", "interface/*.stl")
SEAT_MM = 0.1
LINE_MM = 0.1
FLUSH_MM = 0.1
HOLE_MM = 0.05
CLEAR_MM = 0.4
SHARED_MM3 = 0.05
LEAST_BED_MM2 = 300.0
_INSET_MM = 0.2
_BESIDE_MM = 1.5  # of a mark's place, from the end of its rail
_BESIDE_NUT = (0.05, 0.5, 1.0)  # of its height, where walls are looked for
_STEP_MM = 0.02
_REACH_MM = 60.0
_SEARCH_MM = 5.0
_DOWN = np.array([0.0, 0.0, -1.0])


@dataclass(frozen=True, eq=False)
class Held(Subject):
    """A clamp on one finger in its mould, as they were read."""

    finger: Finger
    clamp: Clamp
    design: Design
    mesh: Any
    """The clamp, where the design has it."""
    mould: Any
    plates: tuple[Any, ...]
    """The backing, and the interface of a compliant one."""


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every figure of the clamp."""
    for clamp in design.clamps:
        subject = clamp.file
        try:
            standing = solids.read_mesh(outputs / subject)
        except OutputError as error:
            yield unreadable("clamp.readable", subject, str(error))
            continue
        to_sensor = clamp_bed_to_sensor(design.stack, clamp)
        of = Subject("clamp", subject)
        yield from _prints(of, standing, design)
        sensor = solids.moved(standing, to_sensor)
        for finger in design.fingers:
            try:
                held = _held(outputs, design, finger, clamp, sensor)
            except OutputError as error:
                yield unreadable("clamp.readable", f"mould/{finger.name}_mould.stl", str(error))
                continue
            yield held.figure("readable", len(held.mesh.faces), 4, math.inf, "triangles")
            yield from measured(MEASURES, held)


def _prints(of: Subject, standing: Any, design: Design) -> Iterator[Measurement]:
    """One closed body that lies on the bed with its back, and its walls."""
    yield from measure_closed(of, standing)
    yield from measure_bed(of, standing, as_moulds(design), 0.1, LEAST_BED_MM2)
    left = np.array(design.printing.bed_mm) - standing.extents
    yield of.figure("fits_bed", left.min(), 0, math.inf, note="room left")
    yield from walls("clamp.min_wall", of.subject, standing, design.printing.min_wall_mm, ())


def _held(outputs: Path, design: Design, finger: Finger, clamp: Clamp, sensor: Any) -> Held:
    """A finger in its mould under the clamp."""
    stack, mount = design.stack, design.mount
    to_bed = np.asarray(np.linalg.inv(mould_bed_to_sensor(stack, design.mould)), np.float64)
    plates = [(f"backing/{finger.name}_backing.stl", backing_bed_to_sensor(mount, stack))]
    if design.interfaces:
        plates.append((f"interface/{finger.name}_interface.stl", mount_to_sensor(mount, stack)))
    return Held(
        "clamp",
        f"{clamp.file} on the {finger.name}",
        finger,
        clamp,
        design,
        solids.moved(sensor, to_bed),
        solids.read_mesh(outputs / f"mould/{finger.name}_mould.stl"),
        tuple(solids.moved(solids.read_mesh(outputs / path), to_bed @ at) for path, at in plates),
    )


def measure_seats(held: Held) -> Iterator[Measurement]:
    """All over each foot, its distance to the plate's back: none where there is a window."""
    worst = farthest(np.concatenate(_gaps(held)), 0.0)
    yield held.figure("seats", worst, -SEAT_MM, SEAT_MM, note="from a foot to the plate's back")


def measure_over_pads(held: Held) -> Iterator[Measurement]:
    """Feet cover the pads, and press inside the figure that pads and tip line span."""
    design, clamp = held.design, held.clamp
    cut = solids.section(held.mesh, clamp.back_mm + clamp.foot_mm / 2)
    pads = [shapely.Point(x, -y) for x, y in design.mould.pads]
    inside = [_inside_mm(cut, pad) for pad in pads]
    least = design.mould.pad_mm / 2 - HOLE_MM
    yield held.figure("over_pads", np.min(inside), least, math.inf, note="of a foot round each pad")
    half, tip_y = tip_stop_mm(design.outline.tip_width_mm) / 2, -design.outline.tip_y_mm
    spanned = shapely.MultiPoint([*pads, (-half, tip_y), (half, tip_y)]).convex_hull
    feet = [shapely.box(*_turned(foot)).intersection(cut).centroid for foot in clamp.feet[2:]]
    within = np.min([_inside_mm(spanned, foot) for foot in feet])
    yield held.figure("over_tip", within, 0, math.inf, note="inside the triangle of the stops")


def measure_clear(held: Held) -> Iterator[Measurement]:
    """Play to coupling and interface on all sides, distance to the mould, and free wires."""
    body = solids.solid(held.mesh, "the clamp")
    plates = [solids.solid(plate, "the backing") for plate in held.plates]
    ways = [(0, 0), (CLEAR_MM, 0), (-CLEAR_MM, 0), (0, CLEAR_MM), (0, -CLEAR_MM)]
    shared = max(
        solids.shared_mm3(body.translate((x, y, 0.0)), plate) for x, y in ways for plate in plates
    )
    note = f"shared with the finger, wherever the clamp lies within {CLEAR_MM:g} mm"
    yield held.figure("clear", shared, 0, SHARED_MM3, "mm³", note=note)
    gap = float(body.min_gap(solids.solid(held.mould, "the mould"), _SEARCH_MM))
    least = CLEAR_MM + held.design.printing.fit_mm
    yield held.figure("off_mould", gap, least, math.inf, note="from clamp to mould")
    low_x, low_y, high_x, high_y = _turned(held.finger.notch)
    height = held.clamp.top_mm + _REACH_MM
    size = (high_x - low_x, high_y + _REACH_MM - low_y, height)
    out = manifold3d.Manifold.cube(size).translate((low_x, low_y, 0.0))
    yield held.figure("wires", solids.shared_mm3(body, out), 0, SHARED_MM3, "mm³", note="over them")


def measure_marks(held: Held) -> Iterator[Measurement]:
    """Marks of each leg and of the rail beside it, with the plate on the stops as they are, and
    whether both faces are in one plane."""
    clamp = held.clamp
    drop = float(np.min([gap.min() for gap in _gaps(held)])) - _stops_mm(held)
    off, flush = [], []
    for leg in clamp.legs:
        _, low_y, _, high_y = _turned(leg)
        side = math.copysign(1.0, leg.centre_mm[0])
        rail = _turned(clamp.rails[1])
        end = min(rail[1], rail[3]) if high_y < rail[3] else rail[3]
        beside = end + math.copysign(_BESIDE_MM, (rail[1] + rail[3]) / 2 - end)
        own_z, own_x = _mark(held.mesh, side, (low_y + high_y) / 2, clamp.mark_mm)
        rail_z, rail_x = _mark(held.mould, side, beside, clamp.mark_mm)
        off.append(own_z - drop - rail_z)
        flush.append(own_x - rail_x)
    note = "from a leg's mark to its rail's, with the plate on its stops"
    yield held.figure("marks", farthest(np.array(off), 0.0), -LINE_MM, LINE_MM, note=note)
    note = "from a leg's outer face to its rail's"
    yield held.figure("flush", farthest(np.array(flush), 0.0), -FLUSH_MM, FLUSH_MM, note=note)


def measure_screws(held: Held) -> Iterator[Measurement]:
    """Holes of clamp and mould on the same axes, round the screws and their heads; screws that
    reach through their nuts, and room for those on the rails."""
    clamp, fit_mm = held.clamp, held.design.printing.fit_mm
    at = tuple((x, -y) for x, y in clamp.screws)
    for mesh, z, name in (
        (held.mesh, clamp.top_mm - clamp.thickness_mm / 2, "clamp"),
        (held.mould, clamp.rail_mm - 0.3, "rails"),
    ):
        rings = holes_at(mesh, z)
        off, _ = circles(rings, at, 2.0)
        yield held.figure("screws", farthest(off, 0.0), 0, HOLE_MM, note="off axis", at=name)
        clear = round_thread(room(rings, at), clamp.screw, fit_mm)
        yield held.clear("screw_clearance", clear)
    heads = room(holes_at(held.mould, 0.02), at)
    yield held.clear("head_clearance", round_head(heads, clamp.screw))
    nut = clamp.screw
    left = clamp.screw_length_mm - float(held.mesh.bounds[1][2]) - nut.nut_height_mm
    yield held.figure("screw_length", left, PITCH_MM, math.inf, note="of a screw beyond its nut")
    heights = (clamp.rail_mm + share * nut.nut_height_mm for share in _BESIDE_NUT)
    walls = [wall for z in heights if not (wall := solids.section(held.mould, z)).is_empty]
    # A wall that ends below a nut leaves it room.
    near = [shapely.Point(axis).distance(wall) for wall in walls for axis in at]
    apart = min(near, default=nut.nut_mm) - nut.nut_mm / math.sqrt(3)
    yield held.figure("nut_room", apart, 0, math.inf, note="from a nut on its rail to the wall")


def measure_press(held: Held) -> Iterator[Measurement]:
    """Press on both pads after a quarter turn, by the thinnest place of arms, bar and lugs."""
    clamp = held.clamp
    boxes = (*clamp.arms, clamp.bar, *clamp.lugs)
    points = np.array([_middle(box) for box in boxes])
    above = np.column_stack([points, np.full(len(points), held.mesh.bounds[1][2] + 1.0)])
    hits = solids.cast(held.mesh, above, _DOWN, _REACH_MM)
    through = [hits.distance_mm[hits.ray == k] for k in range(len(points))]
    thin = min(float(np.ptp(found)) if len(found) else 0.0 for found in through)
    pressed = clamp.pads_n(thin) if thin > 0 else 0.0
    note = f"on both pads after a quarter turn, {thin:.2f} mm thick"
    yield held.figure("press", pressed, clamp.needed_n, math.inf, "N", note=note)


def _gaps(held: Held) -> list[solids.Vectors]:
    """Distances from each foot's end to the plate's back, above zero where there is a gap."""
    clamp, found = held.clamp, []
    for foot in clamp.feet:
        low_x, low_y, high_x, high_y = _turned(foot)
        x = np.linspace(low_x + _INSET_MM, high_x - _INSET_MM, 5)
        y = np.linspace(low_y + _INSET_MM, high_y - _INSET_MM, 5)
        at = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        start = np.column_stack([at, np.full(len(at), clamp.back_mm + clamp.foot_mm / 2)])
        own, _ = solids.cast(held.mesh, start, _DOWN, _REACH_MM).first(len(at))
        plate, _ = solids.cast(held.plates[0], start, _DOWN, _REACH_MM).first(len(at))
        found.append(np.asarray(np.where(np.isfinite(own), plate - own, np.nan)))
    return found


def _stops_mm(held: Held) -> float:
    """How far the pads really are over the rim plane, the higher one."""
    pads = np.array([(x, -y, held.clamp.top_mm) for x, y in held.design.mould.pads])
    drop, _ = solids.cast(held.mould, pads, _DOWN, _REACH_MM).first(len(pads))
    rim = held.design.mould.stops_mm(held.design.stack.cover_mm)
    return float((held.clamp.top_mm - drop).max()) - rim


def _mark(mesh: Any, side: float, y_mm: float, near_mm: float) -> tuple[float, float]:
    """Height of a mark's deepest place on a face that looks outward, and |x| of the face; NaN
    where there is no mark."""
    z = near_mm + np.arange(-2 * MARK_MM, 2 * MARK_MM + _STEP_MM / 2, _STEP_MM)
    far = float(np.abs(mesh.bounds[:, 0]).max()) + 1.0
    start = np.column_stack([np.full(len(z), side * far), np.full(len(z), y_mm), z])
    hit, _ = solids.cast(mesh, start, np.array([-side, 0.0, 0.0]), 2 * far).first(len(z))
    deep = hit - hit.min()
    marked = deep > MARK_MM / 2
    if not marked.any() or deep.max() > 2 * MARK_MM:
        return math.nan, far - float(hit.min())
    return float(np.average(z[marked], weights=deep[marked])), far - float(hit.min())


def _inside_mm(area: Any, point: Any) -> float:
    """Distance of a point from the edge of an area, below zero outside it."""
    return float(area.boundary.distance(point)) * (1.0 if area.contains(point) else -1.0)


def _middle(box: Box) -> tuple[float, float]:
    """Of a box, in the mould's frame."""
    x, y = box.centre_mm
    return x, -y


def _turned(box: Box) -> tuple[float, float, float, float]:
    """A box of the sensor frame in that of the mould's bed."""
    return box.x_min_mm, -box.y_max_mm, box.x_max_mm, -box.y_min_mm


MEASURES: tuple[Measure[Held], ...] = (
    measure_seats,
    measure_over_pads,
    measure_clear,
    measure_marks,
    measure_screws,
    measure_press,
)
