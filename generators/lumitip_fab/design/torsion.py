"""A finger twisted about its axis: Saint-Venant's torsion of its sections.

The closed form of an ellipse (Roark's Formulas for Stress and Strain, table of torsion) is written
with the moments of the section, K = 4 Iu Iw / (Iu + Iw). It is exact for a thin rectangle, and 18 %
too stiff for a square, so that it is reduced as for a rectangle with the same ratio of moments.
Each section is cut into the strip as wide as the coupling's block and the thin plate beside that.
A deep flare behind a board is up to a quarter too stiff so (`tests/fab/test_torsion.py`); it turns
by little.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from lumitip_fab.design.beam import Beam, Layer, Vectors

SHEAR = 1 / 2.7
"""Shear modulus by Young's modulus, of Poisson's ratio 0.35 (assumed), for the board, too: woven
glass and epoxy has less, so a finger whose board is most of it may twist by 1.4 times as much."""


@dataclass(frozen=True, eq=False)
class Torsion:
    """Sections in torsion; arrays of shape `(sections,)`."""

    stiffness_nmm2: Vectors
    reach_mm: tuple[Vectors, ...]
    """Greatest shear strain over the twist of a unit of length, in each layer."""


def torsion(beam: Beam) -> Torsion:
    """Stiffness of a beam's sections, and how far their shear strain reaches."""
    total = np.zeros_like(beam.h_mm)
    reach = [np.zeros_like(beam.h_mm) for _ in beam.layers]
    for k, strip in enumerate(zip(*(each.strips for each in beam.layers), strict=True)):
        across, middle = _across_nmm2(strip)
        side = sum((SHEAR * each.modulus_mpa * each.side_mm4 for each in strip), np.zeros(1))
        if k == 0:
            area = sum((each.area_mm2 for each in strip), np.zeros(1))
            total = total + 4 * across * _compact(across, side)
        else:
            total, area = total + 4 * across, np.full_like(beam.h_mm, np.inf)
        for of, each in enumerate(strip):
            reach[of] = np.maximum(reach[of], _reach_mm(each, middle, area))
    return Torsion(np.maximum(total, 1e-9), tuple(reach))


def _across_nmm2(strip: Iterable[Layer]) -> tuple[Vectors, Vectors]:
    """Stiffness in shear across the thickness, and the w about which it is taken."""
    beam = Beam(np.zeros(1), 0.0, tuple(strip))
    return SHEAR * beam.stiffness_nmm2, beam.middle_mm


def _compact(across: Vectors, side: Vectors) -> Vectors:
    """Share of a thin section's stiffness that a compact one has, by that of its two axes."""
    low, high = np.minimum(across, side), np.maximum(across, side)
    flat = np.sqrt(low / np.maximum(high, 1e-12))
    rectangle = 1 - 0.63 * flat * (1 - flat**4 / 12)
    return np.asarray(rectangle * low / np.maximum(across, 1e-12))


def _reach_mm(layer: Layer, middle_mm: Vectors, area_mm2: Vectors) -> Vectors:
    """Of the middle of a section's long side: twice its distance from the middle, less where the
    section is compact (Roark, by the circle inscribed in it, straight sides; a square at most, for
    holes take nothing off)."""
    middle = middle_mm if layer.glued else layer.middle_mm
    away = np.maximum(middle - layer.front_mm, layer.back_mm - middle)
    wide = np.minimum(2 * away, 2 * layer.half_mm)
    full = np.minimum(np.pi * wide**2 / 4 / np.maximum(area_mm2, 1e-9), np.pi / 4) ** 2
    reach = wide * (1 + 0.15 * full) / (1 + full)
    return np.where(layer.area_mm2 > 0, reach, 0.0)
