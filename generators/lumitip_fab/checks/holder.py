"""The holder as files: printable, the board's screws meet its holes, and it clips on the gripper.

Everything is measured in the frame of the auxiliary board in it.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import manifold3d
import numpy as np
import shapely

from lumitip_fab.checks.board_read import ReadBoard, read_any
from lumitip_fab.checks.printed import (
    circles,
    holes_at,
    measure_bed,
    measure_closed,
    room,
    round_nut,
    round_thread,
)
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.result import Measure, Measurement, Subject, farthest, measured, unreadable
from lumitip_fab.checks.walls import walls
from lumitip_fab.design import Design, Fastener, Holder
from lumitip_fab.design.frames import holder_bed_to_auxiliary, rotation_y, translation
from lumitip_fab.errors import OutputError

READS = ("holder/*.stl", "boards/*.kicad_pcb")

SIZE_MM = 0.05
HOLE_MM = 0.05
SPACING_MM = 0.02  # from hole to hole, of the printed part against the board
ROOFS = 1.1  # overhang, by that of the roofs of its holes
LEAST_BED_MM2 = 300.0
LEAST_GRIP_MM = 0.25  # each arm's end inside the body's widest place
OFF_ARM_MM = 0.1  # from an arm to a tie beside it
SHARED_MM3 = 0.01
_SEGMENTS = 720
_UP, _DOWN = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -1.0])
_REACH_MM = 100.0


@dataclass(frozen=True, eq=False)
class Clip(Subject):
    """A holder as it was read, with the board that goes into it."""

    standing: Any
    """Mesh as the file has it."""
    mesh: Any
    """Mesh in the auxiliary board's frame."""
    holder: Holder
    board: ReadBoard
    design: Design


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every figure of the holder."""
    for holder in design.holders:
        subject = f"holder/{holder.name}.stl"
        try:
            standing = solids.read_mesh(outputs / subject)
            board = read_any(outputs, design, holder.auxiliary)
        except (OutputError, LookupError) as error:
            yield unreadable("holder.readable", subject, f"{error}")
            continue
        mesh = solids.moved(standing, holder_bed_to_auxiliary(holder))
        clip = Clip("holder", subject, standing, mesh, holder, board, design)
        yield clip.figure("readable", len(mesh.faces), 4, math.inf, "triangles")
        yield from measured(MEASURES, clip)


def measure_print(clip: Clip) -> Iterator[Measurement]:
    """One closed body that prints standing, and its walls."""
    printing, roofs = clip.design.printing, ROOFS * _roofs_mm2(clip.holder)
    yield from measure_closed(clip, clip.standing)
    yield from measure_bed(clip, clip.standing, printing, roofs, LEAST_BED_MM2)
    yield from walls("holder.min_wall", clip.subject, clip.standing, printing.min_wall_mm, ())


def measure_tray(clip: Clip) -> Iterator[Measurement]:
    """The board's edge, as its file has it, in the tray; the rim, the floor and the bosses."""
    holder = clip.holder
    left, _, right, _ = clip.board.outline.bounds
    x_min, x_max = clip.board.sensor([(left, 0.0), (right, 0.0)])[:, 0]
    z = holder.top_z_mm / 2
    ys = np.linspace(0.9, -0.9, 13) * holder.tray.y_max_mm
    gaps = []
    for x, way in ((x_min, -1.0), (x_max, 1.0)):
        inside = np.column_stack([np.full_like(ys, x - way), ys, np.full_like(ys, z)])
        hit, _ = solids.cast(clip.mesh, inside, np.array([way, 0.0, 0.0]), 10.0).first(len(ys))
        gaps.append(hit - 1.0)
    clearance = holder.clearance_mm + clip.design.printing.fit_mm
    worst = farthest(np.concatenate(gaps), clearance)
    yield clip.figure("tray_gap", worst, clearance - SIZE_MM, clearance + SIZE_MM)
    rim = clip.mesh.bounds[1][2] - clip.design.stack.auxiliary_mm
    yield clip.figure("rim", rim, -SIZE_MM, SIZE_MM, note="above the board's front")
    floor = _height(clip, np.array([(0.0, y) for y in ys]))
    wanted = -holder.floor_z_mm
    room = farthest(-floor, wanted)
    yield clip.figure("tail_room", room, wanted - SIZE_MM, math.inf, note="under the board")
    beside = 0.45 * holder.boss_mm[0]
    ring = [(x + dx, y) for x, y in holder.holes for dx in (-beside, beside)]
    seat = farthest(_height(clip, np.array(ring)), 0.0)
    yield clip.figure("bosses", seat, -SIZE_MM, SIZE_MM, note="from the board's back")


def measure_screws(clip: Clip) -> Iterator[Measurement]:
    """The screws' holes against those in the board's file: one by one, and from hole to hole."""
    board = clip.board.sensor([hole.at for hole in clip.board.screws])
    at = tuple((float(x), float(y)) for x, y in board)
    rings = holes_at(clip.mesh, -0.5)
    off, wide = circles(rings, at, 2.0)
    yield clip.figure("screws", farthest(off, 0.0), 0, HOLE_MM, note="from the board's holes")
    width = clip.holder.screw_mm
    yield clip.figure("screw_width", farthest(wide, width), width - HOLE_MM, width + HOLE_MM)
    screw, fit_mm = clip.design.threads[clip.holder.screw], clip.design.printing.fit_mm
    yield clip.clear("screw_clearance", round_thread(room(rings, at), screw, fit_mm))
    centres = np.array([shapely.Polygon(ring).centroid.coords[0] for ring in rings])
    spans = [np.ptp(places[:, 0]) if len(places) else math.nan for places in (board, centres)]
    note = "from hole to hole, against the board"
    yield clip.figure("spacing", spans[1] - spans[0], -SPACING_MM, SPACING_MM, note=note)


def measure_nuts(clip: Clip) -> Iterator[Measurement]:
    """The nuts' pockets: across flats, and how far under the board the nuts bear."""
    holder = clip.holder
    rings = holes_at(clip.mesh, holder.seat_z_mm - 0.5)
    off, wide = circles(rings, holder.holes, 2.0)
    yield clip.figure("nuts", farthest(off, 0.0), 0, HOLE_MM, note="from the screws")
    # `circles` gives the diameter of a circle of the same area
    flats = wide * math.sqrt(math.pi / (2 * math.sqrt(3)))
    width = holder.nut_mm
    yield clip.figure("nut_width", farthest(flats, width), width - HOLE_MM, width + HOLE_MM)
    nut, fit_mm = clip.design.threads[holder.screw], clip.design.printing.fit_mm
    yield clip.clear("nut_clearance", round_nut(room(rings, holder.holes), nut, fit_mm))
    beside = (holder.screw_mm + holder.nut_mm) / 4
    start = np.array([(x, y + beside, holder.axis_z_mm) for x, y in holder.holes])
    hit, _ = solids.cast(clip.mesh, start, _UP, _REACH_MM).first(len(start))
    seats = holder.axis_z_mm + hit
    seat = farthest(seats, holder.seat_z_mm)
    yield clip.figure("nut_seat", seat, holder.seat_z_mm - SIZE_MM, holder.seat_z_mm + SIZE_MM)
    left = min(_left_mm(holder, nut, x, z) for (x, _), z in zip(holder.holes, seats, strict=True))
    yield clip.figure("nut_room", left, 0.0, math.inf, note="nuts and screws' ends to gripper")


def _left_mm(holder: Holder, screw: Fastener, x_mm: float, seat_z_mm: float) -> float:
    """Distance from a nut seated at a height, or from its screw's end, to the gripper's body."""
    beyond = holder.screw_length_mm - (holder.top_z_mm - seat_z_mm)
    radius, middle = holder.body_mm / 2, abs(x_mm)
    return min(
        seat_z_mm - reach - holder.axis_z_mm - math.sqrt(max(radius**2 - max(inner, 0.0) ** 2, 0.0))
        for inner, reach in (
            (middle - screw.nut_mm / math.sqrt(3), screw.nut_height_mm),
            (middle - screw.thread_mm / 2, beyond),
        )
    )


def measure_preload(clip: Clip) -> Iterator[Measurement]:
    """How far each arm's end reaches into the body, which lies in the middle of the cradle: by rays
    from the body's axis, in several sections."""
    holder, fit = clip.holder, clip.design.printing.fit_mm
    turns = np.radians(holder.wrap_deg + np.linspace(-6.0, 3.0, 37))
    worst = []
    for side in (-1.0, 1.0):
        away = np.column_stack([side * np.sin(turns), np.zeros_like(turns), np.cos(turns)])
        for share in (-0.9, 0.0, 0.9):
            y = share * holder.outer.y_max_mm
            start = np.tile((0.0, y, holder.axis_z_mm + holder.clearance_mm), (len(turns), 1))
            hit, _ = solids.cast(clip.mesh, start, away, _REACH_MM).first(len(turns))
            worst.append(holder.body_mm / 2 - (float(hit.min()) - fit))
    yield clip.near("preload", worst, holder.preload_mm, SIZE_MM, "each arm's end into the body")


def measure_cradle(clip: Clip) -> Iterator[Measurement]:
    """The cradle's radius by rays from its axis, and how far the arms close behind the body."""
    holder = clip.holder
    to_rib = holder.wrap_deg - 2 * math.degrees(holder.end_mm[0] / holder.end_mm[1])
    turns = np.radians(np.linspace(-to_rib, to_rib, 61))
    away = np.column_stack([np.sin(turns), np.zeros_like(turns), np.cos(turns)])
    y = _free_y_mm(holder)
    start = np.tile((0.0, y, holder.axis_z_mm), (len(turns), 1))
    hit, _ = solids.cast(clip.mesh, start, away, _REACH_MM).first(len(turns))
    fit = clip.design.printing.fit_mm
    wanted = holder.body_mm / 2 + holder.clearance_mm + fit
    yield clip.figure("cradle", farthest(hit, wanted), wanted - SIZE_MM, wanted + SIZE_MM)
    below = clip.mesh.vertices[clip.mesh.vertices[:, 2] < holder.axis_z_mm]
    inward = float(np.abs(below[:, 0]).min(initial=math.inf))
    grip = holder.body_mm / 2 - inward
    note = "each arm's end inside the body's widest place, as drawn"
    yield clip.figure("grip", grip, LEAST_GRIP_MM - fit, math.inf, note=note)


def measure_straps(clip: Clip) -> Iterator[Measurement]:
    """The holes through both arms, seen along each hole."""
    holder = clip.holder
    offs, widths = [], []
    for side in (-1, 1):
        upright = rotation_y(-side * holder.strap_deg) @ translation(0, 0, -holder.axis_z_mm)
        turned = solids.moved(clip.mesh, upright)
        rings = holes_at(turned, holder.cradle_mm + holder.wall_mm / 2)
        off, wide = circles(rings, tuple((0.0, y) for y in holder.strap_y_mm), 2.0)
        offs.append(off)
        widths.append(wide)
    yield clip.figure("straps", farthest(np.concatenate(offs), 0.0), 0, HOLE_MM)
    wanted = holder.strap_hole_mm
    worst = farthest(np.concatenate(widths), wanted)
    yield clip.figure("strap_width", worst, wanted - HOLE_MM, wanted + HOLE_MM)


def measure_ties(clip: Clip) -> Iterator[Measurement]:
    """The way of each tie from arm to arm: outside the holder, half round the gripper."""
    holder, body = clip.holder, solids.solid(clip.standing, "the holder")
    inner = holder.cradle_mm + holder.wall_mm + OFF_ARM_MM
    heights = {lug.opening.centre_mm[1] for lug in holder.arm_lugs}
    first = max(lug.along_mm[1] for lug in holder.arm_lugs)
    for up in sorted(heights):
        wide, thick = holder.arm_lugs[0].tie_mm
        outside = manifold3d.Manifold.cylinder(wide, inner + thick, circular_segments=_SEGMENTS)
        inside = manifold3d.Manifold.cylinder(wide, inner, circular_segments=_SEGMENTS)
        tie = (outside - inside).translate((0.0, -holder.axis_z_mm, up - wide / 2))
        tie = tie.trim_by_plane((0.0, 1.0, 0.0), first)
        note = f"in the way of a tie of {wide:g} x {thick:g} mm from arm to arm"
        shared = solids.shared_mm3(body, tie)
        yield clip.figure("tie_way", shared, 0.0, SHARED_MM3, "mm³", note, f"{up:.1f} mm")


def _height(clip: Clip, points: solids.Vectors) -> solids.Vectors:
    """Height of what is seen from above at points (x, y); infinite through a hole."""
    above = np.column_stack([points, np.full(len(points), _REACH_MM / 2)])
    drop, _ = solids.cast(clip.mesh, above, _DOWN, 2 * _REACH_MM).first(len(points))
    return np.asarray(above[:, 2] - drop)


def _roofs_mm2(holder: Holder) -> float:
    """Overhang of lying holes: a quarter of the way round each, a side of each nut, and the roof
    of each lug."""
    screws = math.pi / 4 * holder.screw_mm * -holder.seat_z_mm * len(holder.holes)
    straps = math.pi / 4 * holder.strap_hole_mm * holder.wall_mm * 2 * len(holder.strap_y_mm)
    deep = [holder.cradle_mm - math.sqrt(holder.cradle_mm**2 - x**2) for x, _ in holder.holes]
    lugs = (*holder.lugs, *holder.arm_lugs)
    ties = sum(lug.opening.width_mm * (lug.along_mm[1] - lug.along_mm[0]) for lug in lugs)
    return screws + straps + ties + holder.nut_mm / math.sqrt(3) * sum(deep)


def _free_y_mm(holder: Holder) -> float:
    """Where a section across the cradle is farthest from its ends, the nuts and the arms' holes."""
    ys = np.linspace(0.0, holder.outer.y_max_mm, 200)
    taken = [(0.0, holder.nut_mm / math.sqrt(3))]
    taken += [(y, holder.strap_hole_mm / 2) for y in holder.strap_y_mm]
    apart = np.min([np.abs(ys - y) - half for y, half in taken], axis=0)
    return float(ys[np.minimum(apart, holder.outer.y_max_mm - ys).argmax()])


MEASURES: tuple[Measure[Clip], ...] = (
    measure_print,
    measure_tray,
    measure_screws,
    measure_nuts,
    measure_cradle,
    measure_preload,
    measure_straps,
    measure_ties,
)
