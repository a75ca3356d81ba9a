"""The flange as files: printable, at home in coupling and gripper, and round its board.

Everything is measured in the frame of the flange.
"""

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from lumitip_fab.checks import flange_board
from lumitip_fab.checks.board_read import read_auxiliary
from lumitip_fab.checks.flange_read import REACH_MM, Stacked, heights, hole_walls, measure_strength
from lumitip_fab.checks.printed import (
    circles,
    holes_at,
    islands_at,
    measure_corners,
    room,
    round_thread,
)
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.checks.walls import walls
from lumitip_fab.design import Design, Flange
from lumitip_fab.design.frames import flange_beds
from lumitip_fab.errors import OutputError

READS = ("flange/*.stl", "flange/*.3mf", "flange/*.step", "boards/flange/*.kicad_pcb")

SIZE_MM = 0.05
HOLE_MM = 0.05
PEG_PLAY_MM = (0.3, 0.7)  # in its hole, without the printer's fit, which is on both
MOST_OVERHANG_MM2 = 30.0  # the roof of the pin's hole
LEAST_BED_MM2 = 2000.0
_NEAR_MM = 2.0


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every figure of the flange."""
    for flange in design.flanges:
        meshes = {}
        for part, bed in flange_beds(flange).items():
            subject = f"flange/{flange.name}_{part}.stl"
            try:
                lying = solids.read_mesh(outputs / subject)
            except OutputError as error:
                yield unreadable("flange.readable", subject, str(error))
                continue
            meshes[part] = solids.moved(lying, bed)
            yield from _printed(subject, lying, design)
            yield from measure_corners(
                "flange", outputs, subject, lying.bounds, meshes[part].vertices
            )
        try:
            board = read_auxiliary(outputs, design, flange.auxiliary)
        except (OutputError, LookupError) as error:
            yield unreadable("flange.readable", f"boards/{flange.auxiliary}", str(error))
            continue
        if len(meshes) == len(flange_beds(flange)):
            yield from _measured(Stacked(meshes["lower"], meshes["upper"], board, flange, design))


def _printed(subject: str, lying: Any, design: Design) -> Iterator[Measurement]:
    """One closed body that prints as it lies, and its walls."""

    def figure(check: str, measured: float, low: float, high: float, unit: str) -> Measurement:
        return Measurement(f"flange.{check}", subject, measured, low, high, unit)

    yield figure("readable", len(lying.faces), 4, math.inf, "triangles")
    yield figure("watertight", solids.open_edges(lying), 0, 0, "open edges")
    yield figure("bodies", solids.bodies(lying), 1, 1, "bodies")
    yield figure("overhang", solids.overhang_mm2(lying), 0, MOST_OVERHANG_MM2, "mm²")
    yield figure("bed_contact", solids.bed_contact_mm2(lying), LEAST_BED_MM2, math.inf, "mm²")
    yield from walls("flange.min_wall", subject, lying, design.printing.min_wall_mm, ())


def _measured(of: Stacked) -> Iterator[Measurement]:
    steps: tuple[Callable[[Stacked], Iterator[Measurement]], ...] = (
        measure_faces,
        measure_bolts,
        measure_pins,
        measure_overlap,
        flange_board.measure_pocket,
        flange_board.measure_contacts,
        flange_board.measure_headers,
        flange_board.measure_screws,
        measure_strength,
    )
    for step in steps:
        try:
            yield from step(of)
        except (
            ArithmeticError,
            LookupError,
            ValueError,
            OutputError,
            shapely.errors.ShapelyError,
        ) as error:
            name = step.__name__.removeprefix("measure_")
            yield unreadable(
                f"flange.{name}", "flange/*.stl", f"cannot be measured: {error!r:.200}"
            )


def measure_faces(of: Stacked) -> Iterator[Measurement]:
    """Spigot and recess, and what the flange adds between coupling and gripper."""
    flange = of.flange
    for check, mesh, z, wanted, hole in (
        ("spigot", of.lower, flange.seat_z_mm / 2, flange.centring_mm - 2 * of.gap_mm, False),
        ("recess", of.upper, flange.top_z_mm - 0.5, flange.centring_mm + 2 * of.gap_mm, True),
    ):
        part = max(shapely.get_parts(solids.section(mesh, z)), key=shapely.area)
        rings = part.interiors if hole else [part.exterior]
        ring = max(rings, key=lambda ring: shapely.Polygon(ring).area)
        radii = np.hypot(*np.array(ring.coords).T)
        yield of.near(check, 2 * radii, wanted, SIZE_MM, "diameter about the axis")
    corners = of.lower.vertices
    rim = corners[np.abs(np.hypot(corners[:, 0], corners[:, 1]) - flange.spigot_mm / 2) < SIZE_MM]
    yield of.near("seat", np.ptp(rim[:, 2]), -flange.seat_z_mm, SIZE_MM, "height of the spigot")
    wide = [2 * float(np.hypot(*mesh.vertices[:, :2].T).max()) for mesh in (of.lower, of.upper)]
    yield of.near("face", wide, flange.face_mm, SIZE_MM, "diameter")
    (x, y), away = flange.peg_at, 0.5 * flange.recess_mm / math.hypot(*flange.peg_at)
    inner = np.array([(0.3 * x, 0.3 * y), (0.9 * away * -y, 0.9 * away * x)])
    depth = of.upper.bounds[1][2] - heights(of.upper, inner)
    yield of.near("recess_depth", depth, flange.recess_depth_mm, SIZE_MM)
    added = of.split_mm + float(np.ptp(of.upper.bounds[:, 2]))
    yield of.near("added_height", added, flange.top_z_mm, SIZE_MM, "from coupling to gripper")


def measure_bolts(of: Stacked) -> Iterator[Measurement]:
    """The bolts' holes through both parts; walls beside every hole; the board out of their way."""
    flange = of.flange
    levels = (
        (of.lower, flange.seat_z_mm / 2),
        (of.lower, flange.split_z_mm - 1.0),
        (of.upper, flange.split_z_mm + flange.web_mm / 2),
    )
    found = [circles(holes_at(mesh, z), flange.bolts, _NEAR_MM) for mesh, z in levels]
    yield of.near("bolts", np.concatenate([off for off, _ in found]), 0.0, HOLE_MM)
    wide = np.concatenate([wide for _, wide in found])
    yield of.near("bolt_width", wide, flange.bolt_hole_mm, HOLE_MM)
    through = np.concatenate([room(holes_at(mesh, z), flange.bolts) for mesh, z in levels])
    bolt, fit_mm = of.design.threads[flange.bolt], of.design.printing.fit_mm
    yield of.clear("bolt_clearance", round_thread(through, bolt, fit_mm))
    least = min(hole_walls(mesh, z) for mesh, z in levels)
    yield of.figure("hole_wall", least, of.design.printing.min_wall_mm - SIZE_MM, math.inf)
    apart = [of.outline.distance(shapely.Point(at)) for at in flange.bolts]
    clear = min(apart) - flange.bolt_hole_mm / 2
    yield of.figure(
        "bolt_board",
        clear,
        of.design.printing.min_wall_mm,
        math.inf,
        note="from a bolt's hole to the board's edge",
    )


def measure_pins(of: Stacked) -> Iterator[Measurement]:
    """Hole of the locating pin, holes for the gripper's, and the peg in its hole."""
    flange, fit = of.flange, 2 * of.design.printing.fit_mm
    off, wide = circles(holes_at(of.lower, flange.seat_z_mm + 1.0), (flange.pin_at,), _NEAR_MM)
    yield of.near("pin", off, 0.0, HOLE_MM)
    yield of.near("pin_width", wide, flange.pin_mm + flange.pin_play_mm + fit, HOLE_MM)
    below = np.array([(*flange.pin_at, flange.seat_z_mm - 1.0)])
    deep, _ = solids.cast(of.lower, below, np.array([0.0, 0.0, 1.0]), REACH_MM).first(1)
    yield of.near("pin_depth", deep - 1.0, flange.pin_depth_mm, SIZE_MM)
    both = [(of.upper, flange.split_z_mm + flange.web_mm / 2)]
    if flange.socket_z_mm < flange.split_z_mm:
        both.append((of.lower, (flange.socket_z_mm + flange.split_z_mm) / 2))
    found = [circles(holes_at(mesh, z), (flange.pin_at,), _NEAR_MM) for mesh, z in both]
    yield of.near("socket", np.concatenate([off for off, _ in found]), 0.0, HOLE_MM)
    wide = np.concatenate([wide for _, wide in found])
    yield of.near("socket_width", wide, flange.pin_mm + flange.socket_play_mm + fit, HOLE_MM)
    yield from _peg(of, flange)


def _peg(of: Stacked, flange: Flange) -> Iterator[Measurement]:
    level = of.split_mm + flange.peg_height_mm / 2
    islands = islands_at(of.lower, level, 100.0)
    peg_off, peg_wide = circles(islands, (flange.peg_at,), _NEAR_MM)
    middle = flange.split_z_mm + flange.web_mm / 2
    off, wide = circles(holes_at(of.upper, middle), (flange.peg_at,), _NEAR_MM)
    yield of.near("peg", np.concatenate([peg_off, off]), 0.0, HOLE_MM)
    least, most = (play + 4 * of.design.printing.fit_mm for play in PEG_PLAY_MM)
    yield of.figure("peg_play", (wide - peg_wide)[0], least, most)
    stands = float(of.lower.bounds[1][2]) - of.split_mm
    yield of.figure("peg_height", stands, SIZE_MM, flange.web_mm)


def measure_overlap(of: Stacked) -> Iterator[Measurement]:
    """No volume is shared by the parts, the board and its components."""
    lower, upper = solids.solid(of.lower, "lower"), solids.solid(of.upper, "upper")
    inside = flange_board.bodies(of)
    shared = {"lower and upper": solids.shared_mm3(lower, upper)}
    for name, body in inside.items():
        shared[f"lower and {name}"] = solids.shared_mm3(lower, body)
        shared[f"upper and {name}"] = solids.shared_mm3(upper, body)
    which = max(shared, key=lambda pair: shared[pair])
    yield of.figure(
        "interference", shared[which], 0, 0.05, "mm³", f"{which}, the worst of {len(shared)} pairs"
    )
