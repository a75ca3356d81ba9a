"""Cells with holes of their own: in the layout's file, and in the light of the twin."""

import json
from dataclasses import replace

import numpy as np
import pytest

from lumitip import Layout
from lumitip.grid import Floats
from lumitip.twin import HalfPlane, Model, Twin
from lumitip.twin.rays import bundle, relative_light

SIZES = np.random.default_rng(4).uniform(1.5, 4.0, 32).round(2)


def sized(layout: Layout, sizes_mm: Floats) -> Layout:
    mean_mm = float(sizes_mm.mean())
    optics = replace(layout.optics, hole_mm=mean_mm)
    return replace(layout, optics=optics, hole_share=sizes_mm / mean_mm)


def test_the_file_has_a_size_for_each_cell_only_where_they_differ(layout: Layout) -> None:
    assert "hole_mm" not in json.loads(layout.to_json())
    for sizes in (SIZES, np.full(32, 3.0)):
        text = sized(layout, sizes).to_json()
        again = Layout.from_json(text)
        assert again.hole_mm == pytest.approx(sizes, abs=1e-6)
        assert again.to_json() == text
    assert sized(layout, SIZES) == layout, "holes belong to no cell's wiring"


@pytest.mark.parametrize(("share", "exponent"), [(0.6, 1.0), (1.4, 2.0), (1.0, 3.0)])
def test_a_hole_scatters_the_light_of_its_die_that_falls_on_it(
    share: float, exponent: float
) -> None:
    """Against random directions of a lobe cos(angle) ** m, counted where they meet the mask."""
    model, depth_mm = Model(), 0.8
    slope = np.random.default_rng(1).random(400_000) ** (1.0 / (exponent + 1.0))  # cos(angle)
    away_mm = depth_mm * np.sqrt(1.0 - slope**2) / slope
    own, usual = (np.mean(away_mm < model.hole_mm / 2.0 * size) for size in (share, 1.0))
    assert relative_light(model, share, depth_mm, exponent) == pytest.approx(own / usual, rel=0.01)


def test_light_between_two_sizes_is_that_of_points_drawn_in_both_holes() -> None:
    """Light that is wholly scattered, against random points in two hexagons."""
    model = Model(alpha=1.0)
    chance = np.random.default_rng(1)
    ends = []
    for size_mm in (1.5, 3.5):
        x, y = chance.uniform(-0.6, 0.6, (2, 400_000)) * size_mm
        inside = (abs(y) < size_mm / 2) & (np.sqrt(3) * abs(x) + abs(y) < size_mm)
        ends.append(np.stack([x, y])[:, inside][:, :200_000])
    for dx_mm, dy_mm in ((0.0, 0.0), (5.196, 3.0)):
        slope = (ends[0] + [[dx_mm], [dy_mm]] - ends[1]) / model.gap_mm
        light = (1.0 + (slope**2).sum(axis=0)) ** -2.5 / model.gap_mm**2
        middle = ends[1] + slope * model.gap_mm / 2.0
        shares = 1.5 / model.hole_mm, 3.5 / model.hole_mm
        rays = bundle(model, dx_mm, dy_mm, shares)
        scattered = relative_light(model, shares[0], model.emitter_depth_mm, model.led_exponent)
        scattered *= relative_light(
            model, shares[1], model.detector_depth_mm, model.detector_exponent
        )
        assert rays.weight.sum() == pytest.approx(scattered * light.mean(), rel=0.01)
        for found, places in zip(rays.at(model.gap_mm / 2.0), middle, strict=True):
            there = np.average(places, weights=light)
            assert np.average(found, weights=rays.weight) == pytest.approx(there, abs=0.01)
            spread = np.sqrt(np.average((places - there) ** 2, weights=light))
            own = np.average(found, weights=rays.weight)
            seen = np.sqrt(np.average((found - own) ** 2, weights=rays.weight))
            assert seen == pytest.approx(spread, rel=0.03)


def test_a_narrow_hole_makes_the_border_of_a_shadow_sharp_at_its_cell_alone(
    layout: Layout,
) -> None:
    """The middle cell's values change over a shorter way of an edge; those far away do not."""
    narrow = np.full(32, 2.5)
    middle = int(np.hypot(layout.x_mm, layout.y_mm).argmin())
    narrow[middle] = 1.2
    way = np.linspace(-3.0, 3.0, 61)
    usual, other = (Twin(of).edges(way, 0.0) for of in (layout, sized(layout, narrow)))
    steepest = [np.abs(np.diff(values[:, middle])).max() for values in (usual, other)]
    assert steepest[1] > 1.1 * steepest[0]
    far = np.hypot(layout.x_mm - layout.x_mm[middle], layout.y_mm - layout.y_mm[middle]) > 13.0
    assert other[:, far] == pytest.approx(usual[:, far], abs=0.5)


def test_a_narrow_hole_makes_its_cell_dimmer(layout: Layout) -> None:
    sizes = np.full(32, 2.5)
    middle = int(np.hypot(layout.x_mm, layout.y_mm).argmin())
    sizes[middle] = 1.5
    usual, other = Twin(layout).drive[middle], Twin(sized(layout, sizes)).drive[middle]
    assert 0.4 * usual < other < 0.9 * usual


@pytest.mark.slow
def test_every_way_to_compute_a_scene_knows_the_sizes(layout: Layout) -> None:
    """Table, raster and single rays: an edge alone, with a second sheet, and as a polygon."""
    twin, alike = Twin(sized(layout, SIZES)), Twin(layout)
    edges = [HalfPlane(offset_mm=1.0, angle_deg=float(angle)) for angle in range(0, 360, 40)]
    by_table, by_rays = (
        twin.batch(edges),
        [twin.calibrated(twin._mixed().light([e])) for e in edges],
    )
    covered = np.stack([edge.coverage(*_at(twin)) for edge in edges]).astype(np.float32)
    without = np.sqrt(np.mean((alike.batch(edges) - by_table) ** 2))
    for found in (twin.batch(covered), by_rays):
        assert np.sqrt(np.mean((found - by_table) ** 2)) < 0.4 * without


def _at(twin: Twin) -> tuple[Floats, Floats, float]:
    at = twin.plane()
    return at.x_mm, at.y_mm, at.pixel_mm
