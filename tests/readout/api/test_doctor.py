"""`lumitip doctor`: what is wrong with a cell shows, what is right does not."""

from functools import cache

import numpy as np
import pytest

from lumitip import Layout
from lumitip.frame import complement
from lumitip.health.doctor import examine
from lumitip.health.swaps import gains, offset_classes
from lumitip.links.twin import Matter, Scene, packet_at, published_layout


@pytest.fixture(scope="module")
def twin() -> Layout:
    return published_layout()


def _light(
    layout: Layout, shape: str = "disc", seconds: float = 20.0, diameter_mm: float = 9.0
) -> np.ndarray:
    return _once(layout, shape, seconds, diameter_mm).copy()


@cache
def _once(layout: Layout, shape: str, seconds: float, diameter_mm: float) -> np.ndarray:
    scene = Scene(shape, 30.0, 1.5, 40.0, 8, 0, matter=Matter(diameter_mm=diameter_mm))
    return complement(packet_at(layout, scene, 0, int(40 * seconds)).values, 8)


@pytest.mark.parametrize("shape", ["disc", "corner", "cable", "demo"])
def test_a_sound_fingertip_is_found_sound(twin: Layout, shape: str) -> None:
    report = examine(_light(twin, shape), twin)
    assert report.findings == ()
    assert report.unseen is None
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


@pytest.mark.parametrize("shape", ["disc", "cable", "thin cable"])
@pytest.mark.parametrize("pair", [(0, 31), (5, 20), (9, 22), (2, 15)])
def test_swapped_cells_are_named(twin: Layout, pair: tuple[int, int], shape: str) -> None:
    light = _light(twin, shape.removeprefix("thin "), diameter_mm=3.0 if "thin" in shape else 9.0)
    light[:, pair] = light[:, pair[::-1]]
    [finding] = examine(light, twin).findings
    assert (finding.kind, finding.cells, finding.sure) == ("swapped", pair, True)
    assert "in both halves of the recording" in finding.detail


@pytest.mark.slow
@pytest.mark.parametrize("speed_mm_s", [12.0, 60.0])
@pytest.mark.parametrize("diameter_mm", [2.0, 3.0, 6.0])
def test_under_a_thin_cable_sound_cells_do_not_look_swapped(
    twin: Layout, diameter_mm: float, speed_mm_s: float
) -> None:
    """Thinner than two pitches it darkens hardly two neighbours at once."""
    scene = Scene("cable", speed_mm_s, 1.5, 40.0, 8, 0, matter=Matter(diameter_mm=diameter_mm))
    report = examine(complement(packet_at(twin, scene, 0, 800).values, 8), twin)
    assert (report.unseen, report.findings) == (None, ())


def test_a_swap_that_half_of_the_recording_shows_is_told_as_unsure(twin: Layout) -> None:
    light = _light(twin, seconds=40.0)
    light[:1000, [5, 20]] = light[:1000, [20, 5]]
    [finding] = examine(light, twin).findings
    assert (finding.kind, finding.cells, finding.sure) == ("swapped", (5, 20), False)
    assert "in a part of the recording" in finding.detail and "repeat for longer" in finding.detail


@pytest.mark.parametrize("seed", range(3))
def test_a_wrong_layout_is_told(twin: Layout, seed: int) -> None:
    light = _light(twin)[:, np.random.default_rng(seed).permutation(32)]
    [finding] = examine(light, twin).findings
    assert (finding.kind, finding.cells) == ("astray", ())
    assert "is the layout.json that of this board" in finding.detail


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
    assert report.unseen is not None
    assert "an object moved over 0% of the cells" in report.unseen
    assert report.findings == ()


def test_too_few_cells_are_told(make_layout) -> None:
    few = make_layout((2, 1))
    assert examine(_light(few), few).unseen == "3 cells are too few to find swapped cells"


def test_frames_of_other_cells_are_refused(twin: Layout) -> None:
    with pytest.raises(ValueError, match=r"\(2 or more, 32\) is needed"):
        examine(np.zeros((5, 31), np.float32), twin)


def test_the_gain_of_a_swap_is_what_swapping_gives(twin: Layout) -> None:
    """Against the definition, pair by pair."""
    alike = np.corrcoef(np.random.default_rng(2).normal(size=(32, 60)))
    ways, usable = offset_classes(twin), np.arange(32) != 7
    got, _ = gains(alike, ways, usable)
    others = {(a, b) for a in range(32) for b in range(32) if a != b} - {
        (a, b) for a in range(32) for b in range(32) if 7 in (a, b)
    }
    same = {
        way: [alike[a, b] for a, b in others if a < b and ways[a, b] == way]
        for way in set(ways.ravel())
    }
    usual = {way: np.median(values) for way, values in same.items() if len(values) >= 4}
    assert ways[0, 1] == ways[1, 0] == ways[30, 31] != ways[0, 2]
    for i, j in [(0, 1), (3, 8), (0, 31), (12, 20)]:
        pairs = [(i, k) for k in range(32) if (i, k) in others and k != j]
        pairs += [(j, k) for k in range(32) if (j, k) in others and k != i]
        pairs = [(a, k) for a, k in pairs if ways[a, k] in usual]
        swapped = {i: j, j: i}
        gain = np.mean(
            [
                abs(alike[a, k] - usual[ways[a, k]]) - abs(alike[swapped[a], k] - usual[ways[a, k]])
                for a, k in pairs
            ]
        )
        assert got[i, j] == pytest.approx(gain)
        assert got[j, i] == pytest.approx(gain)
    assert (got[7] == -1.0).all() and (np.diag(got) == -1.0).all()


def test_the_gain_of_some_cells_is_theirs_among_all(twin: Layout) -> None:
    alike = np.corrcoef(np.random.default_rng(3).normal(size=(32, 60)))
    ways, usable, some = offset_classes(twin), np.arange(32) != 7, np.array([4, 7, 20, 9])
    whole, least = gains(alike, ways, usable)
    got, same = gains(alike, ways, usable, some)
    assert got == pytest.approx(whole[np.ix_(some, some)])
    assert same == least
