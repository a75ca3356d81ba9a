"""The flange as files: printable, at home in coupling and gripper, and round its board.

Everything is measured in the frame of the flange.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from lumitip_fab.checks.board_read import read_any
from lumitip_fab.checks.flange_board import BOARD, REACH_MM, Stacked, bodies, heights, hole_walls
from lumitip_fab.checks.printed import (
    circles,
    holes_at,
    islands_at,
    measure_bed,
    measure_closed,
    room,
    round_thread,
)
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.solids import Vectors, moments, section
from lumitip_fab.checks.result import Measure, Measurement, Subject, measured, unreadable
from lumitip_fab.checks.walls import walls
from lumitip_fab.design import Design, Flange
from lumitip_fab.design.frames import flange_beds, gripper_to_tool
from lumitip_fab.errors import OutputError

READS = ("flange/*.stl", "boards/flange/*.kicad_pcb")

SIZE_MM = 0.05
HOLE_MM = 0.05
PEG_PLAY_MM = (0.3, 0.7)  # in its hole, without the printer's fit, which is on both
MOST_OVERHANG_MM2 = 30.0  # the roof of the pin's hole
LEAST_BED_MM2 = 2000.0
_NEAR_MM = 2.0
DYNAMIC = 2.0  # of the weight, while the arm stops (assumed)
LEAST_SAFETY = 2.0  # beyond that, of an estimate that no test stands behind
RING_SHEAR = 2.0  # greatest shear over its mean, of a thin ring; of solid sections it is less
STEP_MM = 0.25
INSIDE_MM = 0.4  # half of the thinnest web
G_N_KG = 9.81


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
        try:
            board = read_any(outputs, design, flange.auxiliary)
        except (OutputError, LookupError) as error:
            yield unreadable("flange.readable", f"boards/{flange.auxiliary}", str(error))
            continue
        if len(meshes) == len(flange_beds(flange)):
            both = meshes["lower"], meshes["upper"]
            of = Stacked("flange", "flange/*.stl", *both, board, flange, design)
            yield from measured(MEASURES, of)


def _printed(subject: str, lying: Any, design: Design) -> Iterator[Measurement]:
    """One closed body that prints as it lies, and its walls."""
    of = Subject("flange", subject)
    yield of.figure("readable", len(lying.faces), 4, math.inf, "triangles")
    yield from measure_closed(of, lying)
    yield from measure_bed(of, lying, design.printing, MOST_OVERHANG_MM2, LEAST_BED_MM2)
    yield from walls("flange.min_wall", subject, lying, design.printing.min_wall_mm, ())


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
    note = "from a bolt's hole to the board's edge"
    yield of.figure("bolt_board", clear, of.design.printing.min_wall_mm, math.inf, note=note)


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
    inside = bodies(of)
    shared = {"lower and upper": solids.shared_mm3(lower, upper)}
    for name, body in inside.items():
        shared[f"lower and {name}"] = solids.shared_mm3(lower, body)
        shared[f"upper and {name}"] = solids.shared_mm3(upper, body)
    which = max(shared, key=lambda pair: shared[pair])
    yield of.figure(
        "interference", shared[which], 0, 0.05, "mm³", f"{which}, the worst of {len(shared)} pairs"
    )


@dataclass(frozen=True)
class Strength:
    """Safety factor of the flange."""

    layers: float
    """From layer to layer."""
    bolts: float
    """Under the bolts' heads."""
    load_n: float
    lever_mm: float
    """From the coupling's face to the tool centre point."""


def strength(lower: Any, upper: Any, design: Design) -> Strength:
    """Safety of both printed parts, by their meshes in the frame of the flange."""
    (flange,), system = design.flanges, design.system
    filament = design.slicing.of(f"flange/{flange.name}")
    load_n = DYNAMIC * G_N_KG * system.load_kg
    to_tool = gripper_to_tool(design.stack, design.mount, design.closing, system)
    lever_mm = float(to_tool[2, 3]) - system.coupling_mm
    seat, split, web = flange.seat_z_mm, flange.split_z_mm, flange.split_z_mm + flange.web_mm
    cuts = [(z, section(lower, z)) for z in _levels(seat, split)]
    cuts += [(z, section(upper, z)) for z in _levels(split, web)]
    worst_mpa = max(_layer_mpa(cut, load_n, load_n * (lever_mm - z)) for z, cut in cuts)
    force_n = _bolt_n(np.array(flange.bolts), load_n, load_n * (lever_mm - seat))
    head_mm = design.threads[flange.bolt].cap_head_mm
    heads = [shapely.Point(at).buffer(head_mm / 2, 64) for at in flange.bolts]
    area_mm2 = min(cut.intersection(head).area for _, cut in cuts for head in heads)
    return Strength(
        layers=filament.layer_mpa / worst_mpa,
        bolts=filament.bearing_mpa * area_mm2 / force_n,
        load_n=load_n,
        lever_mm=lever_mm,
    )


def measure_strength(of: Stacked) -> Iterator[Measurement]:
    """Safety from layer to layer, and under the heads of the bolts."""
    found = strength(of.lower, of.upper, of.design)
    note = f"{found.load_n:.0f} N at {found.lever_mm:.0f} mm; an estimate"
    for check, safety in (("layers", found.layers), ("bolt_bearing", found.bolts)):
        yield of.figure(check, safety, LEAST_SAFETY, math.inf, "times the load", note)


def _levels(low_mm: float, high_mm: float) -> Vectors:
    """Heights from one face to another, inside both: where the faces are, other checks tell."""
    low_mm, high_mm = low_mm + INSIDE_MM, max(high_mm - INSIDE_MM, low_mm + INSIDE_MM)
    return np.linspace(low_mm, high_mm, 1 + math.ceil((high_mm - low_mm) / STEP_MM))


def _layer_mpa(cut: Any, force_n: float, moment_nmm: float) -> float:
    """Greatest tension in a section, by bending and shear; infinite where there is no material."""
    area, middle, inertia = moments(cut)
    if area <= 0:
        return math.inf
    corners = shapely.get_coordinates(cut) - middle
    bending = moment_nmm * np.linalg.norm(np.linalg.solve(inertia, corners.T), axis=0).max()
    shear = RING_SHEAR * force_n / area
    return float(bending / 2 + math.hypot(bending / 2, shear))


def _bolt_n(places_mm: Vectors, force_n: float, moment_nmm: float) -> float:
    """Greatest tension of a bolt: moment about the group's middle, and its share of the force.

    Bolts in one line hold nothing that tilts about it."""
    away = places_mm - places_mm.mean(axis=0)
    if np.linalg.matrix_rank(away) < 2:
        return math.inf
    lean = np.linalg.norm(np.linalg.pinv(away.T @ away) @ away.T, axis=0).max()
    return float(moment_nmm * lean + force_n / len(places_mm))


MEASURES: tuple[Measure[Stacked], ...] = (
    measure_faces,
    measure_bolts,
    measure_pins,
    measure_overlap,
    *BOARD,
    measure_strength,
)
