"""`Printed`: a printed part's mesh in both of its frames, and the room round its fasteners."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from lumitip_fab.checks.readers.solids import Vectors, section
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Design, Fastener, Finger, Point
from lumitip_fab.design.frames import Matrix

_LEAST_MM2 = 1e-6  # smaller rings of a section are where it grazes an edge


@dataclass(frozen=True, eq=False)
class Printed:
    """The backing of one finger, or the interface behind it, as it was read."""

    subject: str
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

    def figure(
        self, check: str, measured: float, low: float, high: float, unit: str = "mm", at: str = ""
    ) -> Measurement:
        """A measurement of this file, or of a place in it."""
        subject = f"{self.subject}: {at}" if at else self.subject
        return Measurement(f"backing.{check}", subject, measured, low, high, unit)

    def near(
        self,
        check: str,
        measured: Vectors,
        wanted: float,
        by: float,
        unit: str = "mm",
        at: str = "",
    ) -> Measurement:
        """The value that strays farthest from what is wanted; NaN if one could not be taken."""
        return self.figure(check, farthest(measured, wanted), wanted - by, wanted + by, unit, at)


def farthest(values: Vectors, wanted: float) -> float:
    """Of several values the one farthest from a wanted one; NaN if any is, or there is none."""
    if not len(values) or not np.isfinite(values).all():
        return float("nan")
    return float(values[np.abs(values - wanted).argmax()])


def circles(rings: list[Any], centres: tuple[Point, ...], reach_mm: float) -> tuple[Vectors, ...]:
    """Of the ring nearest to each centre: how far it is off and its diameter, NaN without one."""
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


ROUND_MM = 0.05  # chords of a mesh, and an axis that is a little off
HEAD_MM = (0.1, 0.8)  # round a countersunk head
NUT_MM = (0.05, 0.45)  # round a nut, across flats: it goes in, and does not turn
Figures = tuple[float, float, float, str]
"""Measured clearance, least, most (mm), and what it is of."""


def round_thread(found_mm: Vectors, of: Fastener, fit_mm: float) -> Figures:
    """Clearance of a thread, less the printer's fit on both sides."""
    fine, coarse = of.hole_mm
    low, high = fine - of.thread_mm - ROUND_MM, coarse - of.thread_mm + ROUND_MM
    clear = found_mm - of.thread_mm - 2 * fit_mm
    return farthest(clear, (low + high) / 2), low, high, f"round {of.name} of {of.thread_mm:g} mm"


def round_head(found_mm: Vectors, of: Fastener) -> Figures:
    """Clearance of a countersunk head, whose countersink no fit changes."""
    clear = farthest(found_mm - of.countersunk_mm, sum(HEAD_MM) / 2)
    return clear, *HEAD_MM, f"round heads of {of.countersunk_mm:g} mm, {of.name}"


def round_nut(found_mm: Vectors, of: Fastener, fit_mm: float) -> Figures:
    """Clearance of a nut across flats, less the printer's fit on both sides."""
    clear = farthest(found_mm - of.nut_mm - 2 * fit_mm, sum(NUT_MM) / 2)
    return clear, *NUT_MM, f"round nuts of {of.nut_mm:g} mm across flats, {of.name}"
