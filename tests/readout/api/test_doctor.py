"""`lumitip doctor`: what is wrong with a cell shows, what is right does not."""

import numpy as np
import pytest

from lumitip import Layout
from lumitip.doctor import _gains, examine
from lumitip.intake import complement
from lumitip.links.shapes import Matter
from lumitip.links.twin import Scene, packet_at, published_layout


@pytest.fixture(scope="module")
def twin() -> Layout:
    return published_layout()


def _light(layout: Layout, shape: str = "disc", seconds: float = 20.0) -> np.ndarray:
    scene = Scene(shape, 30.0, 1.5, 40.0, 8, 0, matter=Matter(diameter_mm=9.0))
    return complement(packet_at(layout, scene, 0, int(40 * seconds)).values, 8)


@pytest.mark.parametrize("shape", ["disc", "corner", "cable", "demo"])
def test_a_sound_fingertip_is_found_sound(twin: Layout, shape: str) -> None:
    report = examine(_light(twin, shape), twin)
    assert report.findings == ()
    assert report.moved
    assert report.noise.min() > 0.7, "codes of the dark end at 255, which halves their noise"
    assert report.noise.max() < 2.4, "edges that pass count a little"


def test_noise_is_told_as_it_is(twin: Layout) -> None:
    report = examine(_light(twin, "empty", 60.0), twin)
    assert report.noise == pytest.approx(np.full(32, 1.5), rel=0.2), "whole codes cost accuracy"


@pytest.mark.parametrize(
    ("kind", "damage"),
    [
        ("dark", lambda light: light * 0.02),
        ("saturated", lambda light: light * 0.0 + 255.0),
        ("stuck", lambda light: light * 0.0 + 131.0),
        ("noisy", lambda light: light + np.random.default_rng(1).normal(0, 12, light.shape)),
    ],
)
def test_a_damaged_cell_is_named(twin: Layout, kind: str, damage) -> None:
    light = _light(twin)
    light[:, 13] = damage(light[:, 13])
    findings = examine(light, twin).findings
    assert [(f.kind, f.cells) for f in findings] == [(kind, (13,))]
    assert "of 255" in findings[0].detail


@pytest.mark.parametrize("pair", [(0, 31), (5, 20), (9, 22), (2, 15)])
def test_swapped_cells_are_named(twin: Layout, pair: tuple[int, int]) -> None:
    light = _light(twin)
    light[:, pair] = light[:, pair[::-1]]
    assert [(f.kind, f.cells) for f in examine(light, twin).findings] == [("swapped", pair)]


def test_two_pairs_and_a_dead_cell_at_once(twin: Layout) -> None:
    light = _light(twin, seconds=40.0)
    for i, j in [(1, 28), (6, 24)]:
        light[:, [i, j]] = light[:, [j, i]]
    light[:, 16] = 1.0
    found = {(f.kind, f.cells) for f in examine(light, twin).findings}
    assert found == {("dark", (16,)), ("swapped", (1, 28)), ("swapped", (6, 24))}


def test_without_movement_nothing_is_said_of_swaps(twin: Layout) -> None:
    light = _light(twin, "empty")
    light[:, [0, 31]] = light[:, [31, 0]]
    report = examine(light, twin)
    assert not report.moved
    assert report.findings == ()


def test_frames_of_other_cells_are_refused(twin: Layout) -> None:
    with pytest.raises(ValueError, match=r"\(2 or more, 32\) is needed"):
        examine(np.zeros((5, 31), np.float32), twin)


def test_the_gain_of_a_swap_is_what_swapping_gives(twin: Layout) -> None:
    alike = np.corrcoef(np.random.default_rng(2).normal(size=(32, 60)))
    beside = np.zeros((32, 32))
    for a, b in twin.neighbours:
        beside[a, b] = beside[b, a] = 1.0
    gains = _gains(alike, beside)
    for i, j in [(0, 1), (3, 8), (0, 31), (12, 20)]:
        place = np.arange(32)
        place[[i, j]] = place[[j, i]]
        swapped = alike[np.ix_(place, place)]
        whole = ((swapped - alike) * beside).sum() / 2.0
        assert gains[i, j] == pytest.approx(whole / (beside[i].sum() + beside[j].sum()))
        assert gains[j, i] == pytest.approx(gains[i, j])
