"""`Stacked`: the flange's printed parts and board as their files have them, and their strength."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import ReadAuxiliary
from lumitip_fab.checks.printed import Figures, farthest
from lumitip_fab.checks.readers.solids import Vectors, cast, section
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Design, Flange, Point
from lumitip_fab.design.frames import applied, auxiliary_to_flange, gripper_to_tool

CONTACTS = "J1"  # on the board's back, towards the robot
REACH_MM = 100.0


@dataclass(frozen=True, eq=False)
class Stacked:
    """The flange as it was read."""

    lower: Any
    """Mesh of the lower part."""
    upper: Any
    """Mesh of the upper part."""
    board: ReadAuxiliary
    flange: Flange
    design: Design

    def figure(
        self, check: str, measured: float, low: float, high: float, unit: str = "mm", note: str = ""
    ) -> Measurement:
        """A measurement of both files."""
        return Measurement(
            f"flange.{check}", "flange/*.stl", float(measured), low, high, unit, note
        )

    def near(
        self, check: str, measured: Any, wanted: float, by: float, note: str = ""
    ) -> Measurement:
        """The value that strays farthest from what is wanted; NaN if one could not be taken."""
        worst = farthest(np.atleast_1d(np.asarray(measured, dtype=np.float64)), wanted)
        return self.figure(check, worst, wanted - by, wanted + by, note=note)

    def clear(self, check: str, found: Figures) -> Measurement:
        """Room round a fastener."""
        measured, low, high, note = found
        return self.figure(check, measured, low, high, note=note)

    @property
    def gap_mm(self) -> float:
        """Wanted from the printed parts to coupling, gripper and board, by the printer's fit."""
        return self.flange.clearance_mm + self.design.printing.fit_mm

    def places(self, page: list[Point]) -> Vectors:
        """Places on the board's page, shape `(n, 2)`."""
        on_board = self.board.sensor(page)
        return applied(auxiliary_to_flange(self.flange), on_board)[:, :2]

    def pads(self, ref: str) -> Vectors:
        """Plated holes of a part of the board."""
        part = self.board.parts[ref]
        return self.places([t.at for t in part.terminals if t.drill_mm and t.copper is not None])

    @cached_property
    def outline(self) -> BaseGeometry:
        """The board's edge."""
        return shapely.transform(
            self.board.outline, lambda points: self.places([(x, y) for x, y in points])
        )

    @cached_property
    def headers(self) -> tuple[str, ...]:
        """Headers and pads for cables, on the board's front."""
        return tuple(
            d.ref
            for d in self.board.auxiliary.components
            if d.kind in ("header", "wires") and d.ref != CONTACTS
        )

    @cached_property
    def board_z_mm(self) -> float:
        """Area that carries the board, around its screws."""
        ring = 0.5 * self.flange.screw_mm + 0.6
        around = [
            (x + dx, y + dy)
            for x, y in self.flange.screws
            for dx, dy in ((ring, 0), (-ring, 0), (0, ring), (0, -ring))
        ]
        return farthest(heights(self.lower, np.array(around)), self.flange.board_z_mm)

    @cached_property
    def split_mm(self) -> float:
        """Where the upper part lies on the lower one, round the bolts."""
        ring = 0.5 * self.flange.bolt_hole_mm + 0.5
        around = [
            (x + dx, y + dy)
            for x, y in self.flange.bolts
            for dx, dy in ((ring, 0), (-ring, 0), (0, ring), (0, -ring))
        ]
        return farthest(heights(self.lower, np.array(around)), self.flange.split_z_mm)


def heights(mesh: Any, points: Vectors) -> Vectors:
    """Height of what is seen from above at points (x, y); minus infinity through a hole."""
    above = np.column_stack([points[:, :2], np.full(len(points), REACH_MM / 2)])
    drop, _ = cast(mesh, above, np.array([0.0, 0.0, -1.0]), 2 * REACH_MM).first(len(points))
    return np.asarray(above[:, 2] - drop)


def hole_walls(mesh: Any, z_mm: float) -> float:
    """Least distance from a hole to another or to the outside, in a section."""
    least = np.inf
    for part in shapely.get_parts(section(mesh, z_mm)):
        rings = [part.exterior, *part.interiors]
        for at, ring in enumerate(rings):
            rest = rings[at + 1 :]
            least = min(least, *(ring.distance(other) for other in rest), np.inf)
    return float(least)


DYNAMIC = 2.0  # of the weight, while the arm stops (assumed)
LEAST_SAFETY = 2.0  # beyond that, of an estimate that no test stands behind
RING_SHEAR = 2.0  # greatest shear over its mean, of a thin ring; of solid sections it is less
STEP_MM = 0.25
INSIDE_MM = 0.4  # half of the thinnest web
G_N_KG = 9.81


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
    area, middle, inertia = _moments(cut)
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


def _moments(cut: Any) -> tuple[float, Vectors, Vectors]:
    """Area, centre, and second moments about the centre, of polygons with holes."""
    area, first, second = 0.0, np.zeros(2), np.zeros((2, 2))
    for part in shapely.get_parts(cut):
        if part.geom_type != "Polygon":
            continue
        whole = shapely.geometry.polygon.orient(part)  # holes turn the other way, and count less
        for ring in (whole.exterior, *whole.interiors):
            corners = shapely.get_coordinates(ring)
            a, b = corners[:-1], corners[1:]
            cross = a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1]
            area += float(cross.sum()) / 2
            first += ((a + b) * cross[:, None]).sum(axis=0) / 6
            mixed = np.einsum("n,ni,nj->ij", cross, a, b)
            own = np.einsum("n,ni,nj->ij", cross, a, a) + np.einsum("n,ni,nj->ij", cross, b, b)
            second += (2 * own + mixed + mixed.T) / 24
    middle = first / area if area > 0 else first
    return area, middle, second - area * np.outer(middle, middle)
