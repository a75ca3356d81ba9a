"""Strength of the printed flange as its files have it, by closed formulas: an estimate, no test.

The arm holds the gripper out level, so that `System.load_kg` acts across the axis at the tool
centre point, `DYNAMIC` times as heavy for stops of the arm, about whichever axis is worst. Two
bounds, each as if the other help were not there:

- Layers: every printed section alone is a beam, as if no bolt held the parts together; normal
  stress by Euler and Bernoulli, shear of a thin ring, both joined by Mohr's circle, against the
  filament's strength from layer to layer: the parts are printed along the axis.
- Bolts: the bolts alone take moment and weight, shared as in a rigid group, and press onto the
  plastic right under their heads, as if the gripper's foot spread nothing.

Neither knows creep, heat, fatigue, notches or how tight the bolts are.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from lumitip_fab.checks.flange_read import Stacked
from lumitip_fab.checks.result import Measurement
from lumitip_fab.checks.solids import Vectors, section
from lumitip_fab.design import Design
from lumitip_fab.frames import gripper_to_tool

DYNAMIC = 2.0  # of the weight, while the arm stops (assumed)
LEAST_SAFETY = 2.0  # beyond that, of an estimate that no test stands behind
RING_SHEAR = 2.0  # greatest shear over its mean, of a thin ring; of solid sections it is less
STEP_MM = 0.25
INSIDE_MM = 0.4  # half of the thinnest web
G_N_KG = 9.81


@dataclass(frozen=True)
class Strength:
    """What the flange bears, in times the load."""

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
    told = f"{found.load_n:.0f} N at {found.lever_mm:.0f} mm; an estimate"
    for check, safety in (("layers", found.layers), ("bolt_bearing", found.bolts)):
        yield of.figure(check, safety, LEAST_SAFETY, math.inf, "times the load", told)


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
