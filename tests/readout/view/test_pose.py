"""The numbers, words, lines and bands of an estimate."""

import math
from typing import Any

import numpy as np
import pytest

from lumitip import Layout
from lumitip.estimation import Estimate, PoseEstimator
from lumitip.twin import Cable, Corner, HalfPlane, Thing, Twin
from lumitip.view.pose import WORDS, described, reach_of, steady

SCENES = {
    "edge": HalfPlane(offset_mm=2.0, angle_deg=20.0),
    "cable": Cable(offset_mm=-1.5, angle_deg=35.0),
    "corner": Corner(x_mm=-2.0, y_mm=1.0, angle_deg=-60.0),
}


def seen(layout: Layout, thing: Thing) -> tuple[Estimate, dict[str, Any]]:
    estimate = PoseEstimator(layout)(Twin(layout).values(thing))
    return estimate, described(estimate, reach_of(layout))


@pytest.mark.slow_cases
@pytest.mark.parametrize("kind", SCENES)
def test_numbers_and_lines_are_those_of_the_object(layout: Layout, kind: str) -> None:
    estimate, shown = seen(layout, SCENES[kind])
    assert (shown["kind"], shown["words"]) == (kind, [])
    assert shown["offset_mm"] == pytest.approx(estimate.offset_mm, abs=1e-3)
    assert shown["error"]["angle_deg"] == pytest.approx(1.96 * estimate.angle_sd_deg, abs=1e-3)
    thing = SCENES[kind]
    for line in shown["lines"][:2]:  # the third is a cable's axis
        points = np.array(line)
        places = points[0] + np.linspace(0, 1, 50)[:, None] * (points[1] - points[0])
        near = np.hypot(*places.T) < 15.0
        away = thing.signed_distance_mm(places[near, 0], places[near, 1])  # type: ignore[attr-defined]
        assert np.abs(away).max() < (0.3 if kind == "corner" else 0.15)
    assert len(shown["lines"]) == {"edge": 1, "cable": 3, "corner": 2}[kind]
    assert len(shown["bands"]) == {"edge": 1, "cable": 2, "corner": 3}[kind]
    assert (shown["width_mm"] is None) == (kind != "cable")
    assert (shown["vertex_mm"] is None) == (kind != "corner")


@pytest.mark.slow
def test_a_cable_has_its_width_with_an_error(layout: Layout) -> None:
    _, shown = seen(layout, SCENES["cable"])
    assert shown["width_mm"] == pytest.approx(3.0, abs=0.2)
    assert 0.0 < shown["error"]["width_mm"] < 1.0


@pytest.mark.slow
@pytest.mark.parametrize("kind", SCENES)
def test_bands_hold_95_of_100_lines_drawn_from_the_covariance(layout: Layout, kind: str) -> None:
    estimate, _ = seen(layout, SCENES[kind])
    shown = described(estimate, 12.0)
    chance = np.random.default_rng(5)
    names = estimate.parameters
    drawn = chance.multivariate_normal(np.zeros(len(names)), estimate.covariance, 4000)
    by = {name: drawn[:, names.index(name)] for name in names}
    band = np.array(shown["bands"][-1])
    line, back = np.split(band, 2)
    middle, half = (line + back[::-1]) / 2, np.hypot(*((line - back[::-1]) / 2).T)
    place = 3  # of the line: neither its foot nor its end
    way = middle[-1] - middle[0]
    way /= np.hypot(*way)
    left = np.array((-way[1], way[0]))
    if kind == "corner":
        along = math.dist(middle[place], estimate.vertex_mm or (0, 0))
        turn = by["direction_deg"] - 0.5 * by["opening_deg"]
        off = left[0] * by["x_mm"] + left[1] * by["y_mm"] + np.radians(turn) * along
    else:
        along = float(middle[place] @ way)
        off = by["offset_mm"] + np.radians(by["angle_deg"]) * along
        off = off - 0.5 * by["width_mm"] if kind == "cable" else off
    assert np.mean(np.abs(off) < half[place]) == pytest.approx(0.95, abs=0.015)


def test_the_ellipse_of_a_vertex_holds_95_of_100(layout: Layout) -> None:
    estimate, shown = seen(layout, SCENES["corner"])
    at = [estimate.parameters.index(name) for name in ("x_mm", "y_mm")]
    spread = estimate.covariance[np.ix_(at, at)]
    away = np.array(shown["bands"][0]) - np.array(estimate.vertex_mm)
    square = np.einsum("pi,ij,pj->p", away, np.linalg.inv(spread), away)
    np.testing.assert_allclose(square, 5.99, rtol=0.08)  # -2 ln 0.05; points are rounded to 1 µm


@pytest.mark.slow
def test_what_no_shape_explains_is_said_in_words(layout: Layout) -> None:
    values = Twin(layout).values()
    values[::3] = 5.0
    estimate = PoseEstimator(layout)(values)
    assert "misfit" in estimate.flags
    shown = described(estimate, 20.0)
    assert shown["words"][0].startswith("misfit: no edge, cable or corner explains these cells")
    assert len(shown["words"]) == len(estimate.flags)
    flags = {"misfit", "weak", "astray", "unfinished", "bright", "ambiguous", "dead"}
    assert set(WORDS) == flags


def test_cells_that_may_be_dead_are_named(layout: Layout) -> None:
    values = np.floor(Twin(layout).values(HalfPlane(offset_mm=1.0, angle_deg=8.0)))
    lit = np.flatnonzero(values > 250.0)[[0, -1]]
    values[lit] = 0.0
    shown = described(PoseEstimator(layout)(values, "edge"), 10.0)
    cells = ", ".join(map(str, lit.tolist()))
    said = f"dead: found without cells {cells}, which have no value or may be dead"
    assert shown["words"] == [said]


def test_without_contact_there_is_nothing_to_draw(layout: Layout) -> None:
    shown = described(PoseEstimator(layout)(Twin(layout).values()), 20.0)
    assert shown["kind"] == "none"
    assert shown["lines"] == shown["bands"] == []
    assert shown["offset_mm"] is shown["angle_deg"] is None


def test_a_line_that_turns_past_90_degrees_keeps_its_direction() -> None:
    assert steady(-3.0, -88.0, 89.0) == (3.0, 92.0)
    assert steady(-3.0, -50.0, 119.0) == (-3.0, -50.0)  # not beyond 120°
    assert steady(3.0, 80.0, 70.0) == (3.0, 80.0)
    assert steady(3.0, 80.0, None) == (3.0, 80.0)
