"""The estimate of the flange's strength against a handbook's figures of plain cylinders."""

import dataclasses
import math
from pathlib import Path
from typing import Any

import pytest
import trimesh

from lumitip_fab.checks.flange import strength
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import read_design

FACE_MM, HEAD_MM = 75.0, 8.5
LOAD_N = 2 * 9.81 * 5.9
INSIDE_MM = 0.4


@pytest.fixture
def design(outputs: Path) -> Design:
    """The published design."""
    return read_design(outputs / "design.json")


def tubes(design: Design, inner_mm: float = 0.0) -> tuple[Any, Any]:
    """Both parts as plain cylinders of the flange's diameter, or tubes."""
    (flange,) = design.flanges
    made = []
    for low, high in (
        (flange.seat_z_mm, flange.split_z_mm),
        (flange.split_z_mm, flange.top_z_mm),
    ):
        size = {"height": high - low, "sections": 256}
        mesh = (
            trimesh.creation.annulus(inner_mm / 2, FACE_MM / 2, **size)
            if inner_mm
            else trimesh.creation.cylinder(FACE_MM / 2, **size)
        )
        made.append(mesh.apply_translation((0.0, 0.0, (low + high) / 2)))
    return made[0], made[1]


@pytest.mark.parametrize("inner_mm", [0.0, 50.0])
def test_layers_are_a_beam_of_the_handbook(inner_mm: float, design: Design) -> None:
    """32 M D / (π (D⁴ - d⁴)), and twice the mean shear, joined by Mohr's circle."""
    (flange,) = design.flanges
    found = strength(*tubes(design, inner_mm), design)
    moment = LOAD_N * (found.lever_mm - flange.seat_z_mm - INSIDE_MM)
    bending = 32 * moment * FACE_MM / (math.pi * (FACE_MM**4 - inner_mm**4))
    shear = 2 * LOAD_N / (math.pi / 4 * (FACE_MM**2 - inner_mm**2))
    worst = bending / 2 + math.hypot(bending / 2, shear)
    assert found.load_n == pytest.approx(LOAD_N)
    assert found.layers == pytest.approx(15.0 / worst, rel=2e-3)


def test_a_bolt_takes_its_share_of_the_moment(design: Design) -> None:
    """Four bolts at (±27, ±16): M·√((27/Σx²)² + (16/Σy²)²), and a quarter of the weight."""
    (flange,) = design.flanges
    found = strength(*tubes(design), design)
    share = math.hypot(27 / (4 * 27**2), 16 / (4 * 16**2))
    force = LOAD_N * (found.lever_mm - flange.seat_z_mm) * share + LOAD_N / 4
    assert found.bolts == pytest.approx(40.0 * math.pi / 4 * HEAD_MM**2 / force, rel=2e-3)


def test_safety_falls_with_the_load_and_rises_with_the_filament(design: Design) -> None:
    parts = tubes(design)
    plain = strength(*parts, design)
    system = dataclasses.replace(design.system, load_kg=2 * design.system.load_kg)
    heavy = strength(*parts, dataclasses.replace(design, system=system))
    assert (heavy.layers, heavy.bolts) == pytest.approx((plain.layers / 2, plain.bolts / 2))
    rigid = dataclasses.replace(design.slicing.rigid, layer_mpa=30.0, bearing_mpa=80.0)
    slicing = dataclasses.replace(design.slicing, rigid=rigid)
    tough = strength(*parts, dataclasses.replace(design, slicing=slicing))
    assert (tough.layers, tough.bolts) == pytest.approx((2 * plain.layers, 2 * plain.bolts))


def test_bolts_in_one_line_hold_nothing_that_tilts_about_it(design: Design) -> None:
    (flange,) = design.flanges
    row = dataclasses.replace(flange, bolts=((-27.0, 0.0), (0.0, 0.0), (27.0, 0.0)))
    found = strength(*tubes(design), dataclasses.replace(design, flanges=(row,)))
    assert found.bolts == 0.0 and found.layers > 2.0
