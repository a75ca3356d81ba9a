"""Printed parts: their mesh in both frames, and room round fasteners."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely
from scipy.spatial import cKDTree

from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.solids import Vectors, cast, section
from lumitip_fab.checks.result import Clearance, Measurement, Subject, farthest
from lumitip_fab.checks.spans import longest_span_mm
from lumitip_fab.design import Design, Fastener, Finger, Point, Printing
from lumitip_fab.design.frames import Matrix

RAY_MM = 5.0  # rays start this far in front of the rim
ROUND_MM = 0.05  # chords of a mesh, and an axis that is a little off
HEAD_MM = (0.1, 0.8)  # round a countersunk head
NUT_MM = (0.05, 0.45)  # round a nut, across flats: it goes in, and does not turn
_LEAST_MM2 = 1e-6  # smaller rings of a section are where it grazes an edge


@dataclass(frozen=True, eq=False)
class Printed(Subject):
    """The backing of one finger, or the interface behind it, as it was read."""

    standing: Any
    """Mesh as the file has it, on its bed; what is bolted on, in the mount frame (u, w, h)."""
    sensor: Any
    """Mesh in the finger's sensor frame."""
    finger: Finger
    design: Design
    to_sensor: Matrix
    """From the first frame to the second."""
    kind: str = "backing"
    """Or `interface`."""
    plate: "Printed | None" = None
    """The plate in which an interface sits."""


def circles(rings: list[Any], centres: tuple[Point, ...], reach_mm: float) -> tuple[Vectors, ...]:
    """The ring nearest to each centre: its distance and its diameter, NaN without one."""
    polygons = [p for p in map(shapely.Polygon, rings) if p.area > _LEAST_MM2]
    found = np.array([(p.centroid.x, p.centroid.y) for p in polygons]).reshape(-1, 2)
    wide = np.array([2 * np.sqrt(p.area / np.pi) for p in polygons])
    off, diameter = np.full(len(centres), np.nan), np.full(len(centres), np.nan)
    for k, centre in enumerate(centres):
        distance = np.hypot(*(found - np.array(centre)).T)
        if distance.size and distance.min() <= reach_mm:
            off[k], diameter[k] = distance.min(), wide[distance.argmin()]
    return off, diameter


def room(rings: list[Any], axes: tuple[Point, ...]) -> Vectors:
    """Diameter of the widest rod along each axis that goes through the ring round it, or, of a
    nut's pocket, width across flats of the nut; NaN without such a ring."""
    polygons = [shapely.Polygon(ring) for ring in rings]
    found = np.full(len(axes), np.nan)
    for k, axis in enumerate(map(shapely.Point, axes)):
        around = [p.exterior.distance(axis) for p in polygons if p.contains(axis)]
        if around:
            found[k] = 2 * min(around)
    return found


def holes_at(mesh: Any, z_mm: float) -> list[Any]:
    """Rings of the holes through a mesh's section."""
    parts = shapely.get_parts(section(mesh, z_mm))
    return [ring for part in parts if part.geom_type == "Polygon" for ring in part.interiors]


def islands_at(mesh: Any, z_mm: float, area_mm2: float) -> list[Any]:
    """Outlines of the small pieces of a mesh's section."""
    parts = shapely.get_parts(section(mesh, z_mm))
    return [p.exterior for p in parts if p.geom_type == "Polygon" and p.area < area_mm2]


def front_z(part: Printed, points: Vectors) -> Vectors:
    """Height of what is seen from the front at points (x, y); NaN through a hole."""
    above = np.column_stack([points, np.full(len(points), part.design.stack.rim_z_mm + RAY_MM)])
    drop, _ = cast(part.sensor, above, np.array([0.0, 0.0, -1.0]), 40.0).first(len(points))
    return np.asarray(np.where(np.isfinite(drop), above[:, 2] - drop, np.nan))


def round_thread(found_mm: Vectors, of: Fastener, fit_mm: float) -> Clearance:
    """Clearance of a thread, less the printer's fit on both sides."""
    fine, coarse = of.hole_mm
    low, high = fine - of.thread_mm - ROUND_MM, coarse - of.thread_mm + ROUND_MM
    clear = found_mm - of.thread_mm - 2 * fit_mm
    return farthest(clear, (low + high) / 2), low, high, f"round {of.name} of {of.thread_mm:g} mm"


def round_head(found_mm: Vectors, of: Fastener) -> Clearance:
    """Clearance of a countersunk head, whose countersink no fit changes."""
    clear = farthest(found_mm - of.countersunk_mm, sum(HEAD_MM) / 2)
    return clear, *HEAD_MM, f"round heads of {of.countersunk_mm:g} mm, {of.name}"


def round_nut(found_mm: Vectors, of: Fastener, fit_mm: float) -> Clearance:
    """Clearance of a nut across flats, less the printer's fit on both sides."""
    clear = farthest(found_mm - of.nut_mm - 2 * fit_mm, sum(NUT_MM) / 2)
    return clear, *NUT_MM, f"round nuts of {of.nut_mm:g} mm across flats, {of.name}"


def measure_closed(of: Subject, mesh: Any, bodies: int = 1) -> Iterator[Measurement]:
    """Open edges of a mesh, and how many bodies it is."""
    yield of.figure("watertight", solids.open_edges(mesh), 0, 0, "open edges")
    yield of.figure("bodies", solids.bodies(mesh), bodies, bodies, "bodies")


def measure_bed(
    of: Subject, mesh: Any, printing: Printing, most: float, least: float
) -> Iterator[Measurement]:
    """Overhang of a mesh that stands on its bed, and what lies on the bed (mm²)."""
    yield of.figure("overhang", solids.overhang_mm2(mesh), 0, most, "mm²")
    yield measure_span(of, mesh, printing)
    yield of.figure("bed_contact", solids.bed_contact_mm2(mesh), least, math.inf, "mm²")


def measure_span(of: Subject, mesh: Any, printing: Printing) -> Measurement:
    """The longest line of a mesh on its bed that is laid over nothing."""
    span, at_mm = longest_span_mm(mesh, printing)
    note = f"longest line over nothing, {at_mm:.1f} mm over the bed"
    return of.figure("span", span, 0.0, printing.bridge_mm, note=note)


def as_moulds(design: Design) -> Printing:
    """How moulds and what belongs to them are printed: in layers of their own."""
    return replace(design.printing, layer_mm=design.mould.layer_mm)


def apart_mm(found: Vectors, wanted: Vectors) -> float:
    """Farthest distance of a point of one set to the other set, either way (mm)."""
    there, back = (cKDTree(b).query(a)[0] for a, b in ((found, wanted), (wanted, found)))
    return float(max(there.max(), back.max()))
