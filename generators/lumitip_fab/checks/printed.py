"""Printed parts: their mesh in both frames, room round fasteners, and 3MF and STEP against STL."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import shapely
from scipy.spatial import cKDTree

from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.solids import Vectors, cast, section
from lumitip_fab.checks.readers.tables import unpacked
from lumitip_fab.checks.readers.vertices import step_mm
from lumitip_fab.checks.result import Clearance, Measurement, Subject, farthest, unreadable
from lumitip_fab.design import Design, Fastener, Finger, Point
from lumitip_fab.design.frames import Matrix
from lumitip_fab.errors import OutputError

AGREE_MM = 0.02
_NAMESPACE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
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


def measure_bed(of: Subject, mesh: Any, most: float, least: float) -> Iterator[Measurement]:
    """Overhang of a mesh that stands on its bed, and what lies on the bed (mm²)."""
    yield of.figure("overhang", solids.overhang_mm2(mesh), 0, most, "mm²")
    yield of.figure("bed_contact", solids.bed_contact_mm2(mesh), least, math.inf, "mm²")


def measure_boxes(
    prefix: str, outputs: Path, stl: str, standing: Vectors, sensor: Vectors, bodies: int = 1
) -> Iterator[Measurement]:
    """How far the boxes round 3MF and STEP differ from the STL's, and what else they hold.

    Args:
        prefix: of the checks' names.
        outputs: the output folder.
        stl: the part's STL file in it; the others lie beside it.
        standing: bounds of the part in the printer, shape `(2, 3)`.
        sensor: its bounds in the sensor frame.
        bodies: how many the STEP file has to hold.
    """
    yield _three_mf_of(prefix, outputs, stl, standing)
    yield _measured(
        f"{prefix}.step",
        outputs,
        stl.replace(".stl", ".step"),
        lambda path: _step(path, bodies),
        _from_box(sensor),
    )


def measure_corners(
    prefix: str, outputs: Path, stl: str, standing: Vectors, corners: Vectors
) -> Iterator[Measurement]:
    """The same of a part whose widest places are round, where a STEP file has no corner: how far
    its corners lie from those of the STL.

    Args:
        prefix: of the checks' names.
        outputs: the output folder.
        stl: the part's STL file in it; the others lie beside it.
        standing: bounds of the part in the printer, shape `(2, 3)`.
        corners: the STL's corners in the STEP file's frame, shape `(n, 3)`.
    """
    tree = cKDTree(corners)

    def off_mm(points: Vectors) -> float:
        return float(tree.query(points)[0].max())

    yield _three_mf_of(prefix, outputs, stl, standing)
    yield _measured(f"{prefix}.step", outputs, stl.replace(".stl", ".step"), _step, off_mm)


def measure_polyhedron(
    prefix: str, outputs: Path, stl: str, standing: Vectors, sensor: Vectors
) -> Iterator[Measurement]:
    """How far the corners of 3MF and STEP lie from those of a part with flat faces alone.

    Args:
        prefix: of the checks' names.
        outputs: the output folder.
        stl: the part's STL file in it; the others lie beside it.
        standing: the design's corners in the printer, shape `(n, 3)`.
        sensor: its corners in the sensor frame, shape `(n, 3)`.
    """
    for check, end, read, corners in (
        ("three_mf", ".3mf", three_mf_mm, standing),
        ("step", ".step", _step, sensor),
    ):
        path = stl.replace(".stl", end)

        def off_mm(found: Vectors, corners: Vectors = corners) -> float:
            return apart_mm(found, corners)

        yield _measured(f"{prefix}.{check}", outputs, path, read, off_mm)


def apart_mm(found: Vectors, wanted: Vectors) -> float:
    """Farthest distance of a point of one set to the other set, either way (mm)."""
    there, back = (cKDTree(b).query(a)[0] for a, b in ((found, wanted), (wanted, found)))
    return float(max(there.max(), back.max()))


def _from_box(bounds: Vectors) -> Callable[[Vectors], float]:
    """How far the box round some points differs from this one."""
    return lambda points: float(
        np.abs(np.array([points.min(axis=0), points.max(axis=0)]) - bounds).max()
    )


def _three_mf_of(prefix: str, outputs: Path, stl: str, standing: Vectors) -> Measurement:
    path = stl.replace(".stl", ".3mf")
    return _measured(f"{prefix}.three_mf", outputs, path, three_mf_mm, _from_box(standing))


def _measured(
    check: str,
    outputs: Path,
    path: str,
    read: Callable[[Path], Vectors],
    off_mm: Callable[[Vectors], float],
) -> Measurement:
    try:
        points = read(outputs / path)
    except (OutputError, OSError, ValueError, LookupError, SyntaxError) as error:
        return unreadable(check, path, f"cannot be read: {error!r:.200}")
    return Measurement(check, path, off_mm(points), 0.0, AGREE_MM, "mm")


def three_mf_mm(path: Path) -> Vectors:
    """Corners of the model in a 3MF file, shape `(n, 3)` (mm).

    Raises:
        OutputError: if it is no package.
        ValueError: if its unit is not the millimetre.
        LookupError: if it has no model.
    """
    model = ElementTree.fromstring(unpacked(path)["3D/3dmodel.model"])
    if model.get("unit") != "millimeter":
        raise ValueError(f"unit {model.get('unit')!r}, millimeter is needed")
    vertices = model.iter(f"{_NAMESPACE}vertex")
    return np.array([[float(v.attrib[axis]) for axis in "xyz"] for v in vertices])


def _step(path: Path, bodies: int = 1) -> Vectors:
    corners, found = step_mm(path)
    if found != bodies:
        raise ValueError(f"{found} solids, {bodies} needed")
    return corners
