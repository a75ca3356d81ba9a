"""Deviations are found again from what the gauge shows."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from acceptance_frames import Bench
from lumitip.acceptance.gauge import Gauge
from lumitip.acceptance.response import NAMES, Response
from lumitip.acceptance.spread import BOARD_MM, DRIFT, LED, PLACEMENT_MM, spread
from lumitip.acceptance.verdict import Judge
from lumitip.links.twin import published_layout
from lumitip.twin import HalfPlane, Misregistration, Model, Twin
from lumitip.twin.built import Piece
from lumitip_fab.config.load import load
from lumitip_fab.derive.making.tolerances import spreads


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "value", "within"),
    [
        ("receiver_x", 0.8, 0.1),
        ("receiver_turn", 2.0, 0.3),
        ("emitter_y", 0.7, 0.2),
        ("gap", 1.2, 0.1),
        ("gap", -0.8, 0.15),
        ("tilt", 2.0, 0.8),
        ("scatter", -0.4, 0.05),
        ("hole", 0.4, 0.15),
        ("finger_x", 0.3, 0.1),
    ],
)
def test_a_deviation_is_found_again(
    bench: Bench, judge: Judge, name: str, value: float, within: float
) -> None:
    found = judge(bench.frames({name: value}))
    assert found.deviations[name] == pytest.approx(value, abs=within)
    assert found.misfit < 1.5
    assert 0.0 < found.sd[name] < 1.0


@pytest.mark.slow
def test_a_single_cell_that_misfits_does_not_bend_the_result(bench: Bench, judge: Judge) -> None:
    frames = bench.frames({"receiver_x": 0.5})
    for part in frames.gauge:
        part[:, 13] = 100.0
    found = judge(frames)
    assert [(f.kind, f.cells) for f in found.findings] == [("odd", (13,))]
    assert found.deviations["receiver_x"] == pytest.approx(0.5, abs=0.12)


@pytest.mark.slow
def test_large_deviations_are_found_from_other_starts(bench: Bench, judge: Judge) -> None:
    off = {"emitter_x": 1.5, "emitter_y": 0.9, "scatter": -0.3}
    found = judge(bench.frames(off))
    for name, value in off.items():
        assert found.deviations[name] == pytest.approx(value, abs=0.15)


def test_the_spread_of_parts_is_that_of_new_fingers(gauge: Gauge) -> None:
    """Of an LED and a detector, computed with single parts moved."""
    response = Response(published_layout(), gauge)
    off, cells = np.zeros(len(response.priors)), len(published_layout())
    rows = spread(response, off, response.drive)
    assert rows.shape == (6 * cells + 4, len(gauge.placements) * cells)
    pair = response.built(off)
    full = response.rays.of(pair).full
    each = np.eye(cells)
    led = replace(pair, led=pair.led + LED * each[12])
    way = np.stack([PLACEMENT_MM * each[12], 0.0 * each[12]])
    detector = replace(pair, detector_mm=pair.detector_mm + way)
    for row, moved in ((12, led), (2 * cells + 1 + 12, detector)):
        light = response.rays.of(moved)
        change = response._read(off, light, response.drive * light.full / full)
        change -= response.values(off, response.drive)
        assert rows[row] == pytest.approx(change.ravel(), abs=0.005)
        assert np.abs(rows[row]).max() > 0.05


def test_spreads_are_those_of_the_catalogue() -> None:
    config = load(Path(__file__).parents[3] / "design" / "presets" / "published.toml")
    of = spreads(config)
    assert of["led"] == LED
    assert of["placement"] == PLACEMENT_MM
    assert of["drift"] / 2.0 == DRIFT
    assert config.catalogue.tolerances.board.distribution == "uniform"
    assert np.hypot(of["board"] / 3**0.5, of["print"]) == pytest.approx(BOARD_MM, abs=0.001)


def test_the_values_of_a_thin_edge_are_those_of_the_twin(gauge: Gauge) -> None:
    """The twin's tables and its rays with every part at its place are two programs."""
    layout = published_layout()
    response = Response(layout, gauge)
    off = np.zeros(len(response.priors))
    off[NAMES.index("finger_x")] = 0.4
    light = response._light(off)
    twin = Twin(layout, Model.from_layout(layout), misregistration=Misregistration(x_mm=0.4))
    for height in (0.2, 0.5, 0.8):
        edge = HalfPlane(1.0, 12.0, height=height)
        own = light.behind(Piece("edge", 1.0, 12.0, 3.0 * height, 3.0 * height + 1e-6))
        assert np.sqrt(np.mean((own - twin.light(edge)) ** 2)) < 0.8 / 255.0


def test_a_strip_is_two_edges_and_thickness_takes_light(gauge: Gauge) -> None:
    response = Response(published_layout(), gauge)
    light = response._light(np.zeros(len(response.priors)))
    thin = light.behind(Piece("strip", 0.0, 30.0, 1.5, 1.5 + 1e-6, 3.0))
    left = light.behind(Piece("edge", 1.5, 30.0, 1.5, 1.5 + 1e-6))
    right = light.behind(Piece("edge", -1.5, 30.0, 1.5, 1.5 + 1e-6))
    assert thin == pytest.approx(1.0 - (right - left), abs=1e-6)
    thick = light.behind(Piece("strip", 0.0, 30.0, 1.1, 1.9, 3.0))
    assert (thick <= thin + 1e-9).all()
    assert (thick < thin - 0.002).any()
