"""Physics of the second optical model, which shares nothing with the twin."""

import math
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("numba")

import second_bench
import second_light
from lumitip.links.twin import published_layout
from second_bench import Bound, fingers, trials
from second_light import Light
from second_optics import connected, henyey, henyey_cosine, refracted, transmitted
from second_specimen import Electronics, Specimen, drawn_electronics
from second_tips import DEVIATIONS, Tips, drawn

LAYOUT = published_layout()
FEW = {"straight": 1500, "walks": 3000}
CLEAR = Tips(
    silicone_scatter_per_mm=0.0,
    film_scatter_per_mm=0.0,
    board_albedo=0.0,
    face_albedo=0.0,
    wall_albedo=0.0,
)
MIDDLE = 14
"""A cell inside the grid."""


@pytest.fixture(scope="module")
def lit() -> Light:
    """The nominal fingertips."""
    return Light.of(LAYOUT, Tips(), seed=3, **FEW)


def test_light_is_absorbed_or_leaves(lit: Light) -> None:
    assert lit.ended.sum() == pytest.approx(1.0, abs=0.01)
    white = Light.of(LAYOUT, replace(CLEAR, board_albedo=1.0), straight=1, walks=1000)
    assert white.ended[0] > 0.5


def test_far_fingers_follow_the_inverse_square_law() -> None:
    full = []
    for gap_mm in (40.0, 80.0):
        # Without film and silicone indices, and small dies: a point source and a point receiver.
        tips = replace(CLEAR, gap_mm=gap_mm, silicone_index=1.0, film_index=1.0)
        found = Light.of(LAYOUT, tips, straight=20, walks=1)
        full.append(float(found.single.weight[: found.single.begin[1]].sum(dtype=np.float64)))
        away_mm = gap_mm + 2.0 * (tips.film_mm + tips.led_depth_mm)
        expected = tips.lobe()[0] * tips.response()[0] * tips.detector_mm**2 / away_mm**2
        assert full[-1] == pytest.approx(expected, rel=0.03)
    assert full[0] / full[1] == pytest.approx((82.0 / 42.0) ** 2, rel=0.03)


def test_snell_and_fresnel() -> None:
    u, v, w = refracted(math.sin(0.5), 0.0, -math.cos(0.5), 1.0, 1.41)
    assert 1.41 * u == pytest.approx(math.sin(0.5)) and v == 0.0 and w < 0.0
    assert u * u + w * w == pytest.approx(1.0)
    assert transmitted(1.0, 1.0, 1.5) == pytest.approx(0.96)
    assert transmitted(math.cos(math.radians(50.0)), 1.41, 1.0) == 0.0  # beyond the total angle
    brewster = math.atan(1.5)
    half = 1.0 - transmitted(math.cos(brewster), 1.0, 1.5)
    assert half == pytest.approx(0.5 * ((1.5**2 - 1.0) / (1.5**2 + 1.0)) ** 2, rel=1e-6)


def test_a_connection_obeys_snell_in_every_layer() -> None:
    thick, index = np.array([0.9, 0.1, 3.0, 0.1, 0.9]), np.array([1.41, 1.52, 1.0, 1.52, 1.41])
    for away in (0.0, 0.4, 3.0, 12.0):
        sine, ratio, slope = connected(thick, index, 1.0, away)
        angles = np.arcsin(sine / index)
        assert float(thick @ np.tan(angles)) == pytest.approx(away, abs=1e-6)
        assert sine * ratio == pytest.approx(away, abs=1e-6)
        near = connected(thick, index, 1.0, away + 1e-5)[0]
        assert (near - sine) * slope == pytest.approx(1e-5, rel=0.01)


def test_the_phase_function_is_what_walks_follow() -> None:
    cosines = np.linspace(-1.0, 1.0, 40001)
    density = np.array([henyey(c, 0.8) for c in cosines]) * 2.0 * np.pi
    assert np.sum(density) * (cosines[1] - cosines[0]) == pytest.approx(1.0, abs=1e-3)
    drawn_cosines = [henyey_cosine((n + 0.5) / 4000, 0.8) for n in range(4000)]
    assert np.mean(drawn_cosines) == pytest.approx(0.8, abs=1e-3)


def test_the_lobe_has_the_power_of_one() -> None:
    tips = Tips()
    angles = np.radians(np.arange(0.0, 90.0, 0.01))
    light = np.interp(np.degrees(angles), np.arange(0.0, 92.0, 2.0), tips.lobe())
    assert np.sum(2.0 * np.pi * np.sin(angles) * light) * np.radians(0.01) == pytest.approx(
        1.0, abs=1e-3
    )


def test_an_opaque_sheet_over_everything_is_dark(lit: Light) -> None:
    black = {"passed": 0.0, "albedo": 0.0}
    assert lit.shares(Specimen("edge", offset_mm=60.0, **black)).max() == 0.0
    assert lit.shares(Specimen("edge", offset_mm=-60.0, **black)) == pytest.approx(1.0)
    clear = Specimen("edge", offset_mm=60.0, clear=0.4, **black)
    assert lit.shares(clear) == pytest.approx(0.4, abs=0.01)
    grey = lit.shares(Specimen("edge", offset_mm=60.0, passed=0.03, albedo=0.0))
    assert grey.min() > 0.005 and grey.max() < 0.05


def test_the_far_side_of_an_edge_is_free(lit: Light) -> None:
    shares = lit.shares(Specimen("edge", offset_mm=0.0, angle_deg=0.0))
    assert shares[LAYOUT.y_mm > 5.0].min() > 0.9 and shares[LAYOUT.y_mm < -5.0].max() < 0.1
    corner = lit.shares(Specimen("corner", second_angle_deg=90.0))
    assert corner[(LAYOUT.y_mm < -5.0) & (LAYOUT.x_mm > 5.0)].max() < 0.1
    assert corner[(LAYOUT.y_mm > 5.0) | (LAYOUT.x_mm < -5.0)].min() > 0.85


@pytest.mark.slow
def test_mirror_images_have_mirrored_values() -> None:
    lit = Light.of(LAYOUT, Tips(), seed=5, straight=6000, walks=20_000)
    mirrored = [
        int(np.hypot(LAYOUT.x_mm - x, LAYOUT.y_mm + y).argmin())
        for x, y in zip(LAYOUT.x_mm, LAYOUT.y_mm, strict=True)
    ]
    one = lit.shares(Specimen("cable", 1.3, 15.0, size_mm=3.0))
    two = lit.shares(Specimen("cable", -1.3, -15.0, size_mm=3.0))[mirrored]
    assert one == pytest.approx(two, abs=0.06)
    assert np.sqrt(np.mean((one - two) ** 2)) < 0.015


def test_a_seed_gives_the_same_rays_and_another_one_others(lit: Light) -> None:
    again = Light.of(LAYOUT, Tips(), seed=3, **FEW)
    other = Light.of(LAYOUT, Tips(), seed=4, **FEW)
    specimen = Specimen("edge", 0.7, 10.0)
    assert np.array_equal(lit.shares(specimen), again.shares(specimen))
    assert not np.array_equal(lit.shares(specimen), other.shares(specimen))
    assert lit.shares(specimen) == pytest.approx(other.shares(specimen), abs=0.08)


def test_clear_optics_are_straight_rays_alone() -> None:
    found = Light.of(LAYOUT, CLEAR, **FEW)
    assert found.several.weight.size == 0
    sharp = found.shares(Specimen("edge", LAYOUT.y_mm[MIDDLE] + 3.0, 0.0, passed=0.0, albedo=0.0))
    assert sharp[MIDDLE] == 0.0


def test_scatter_takes_light_and_spreads_it(lit: Light) -> None:
    clear = Light.of(LAYOUT, CLEAR, **FEW)
    assert (lit.full < 0.8 * clear.full).all()
    assert lit.several.weight.size > 0
    beside = Specimen("edge", LAYOUT.y_mm[MIDDLE] + 2.0, 0.0, passed=0.0, albedo=0.0)
    assert lit.shares(beside)[MIDDLE] > clear.shares(beside)[MIDDLE]


def test_too_many_rays_are_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(second_light, "_CAPACITY", 1000)
    with pytest.raises(MemoryError, match="rays more than 1000; trace fewer"):
        Light.of(LAYOUT, CLEAR, **FEW)


def test_electronics_saturate_and_round() -> None:
    chance = np.random.default_rng(0)
    ideal = Electronics(np.ones(3), np.ones(3), exponent=1.0, noise=0.0)
    light = ideal.light(np.array([0.0, 0.5, 10.0]))
    assert light[0] == 0.0 and light[1] == pytest.approx(0.45 * 255.0, rel=1e-3)
    assert light[2] == pytest.approx(255.0, rel=1e-6)
    codes = ideal.codes(np.array([0.0, 0.5, 10.0]), chance)
    assert np.array_equal(codes, np.floor(codes)) and codes.max() <= 255.0
    drawn_gains = drawn_electronics(chance, 4000, 0.06)
    assert drawn_gains.gains.std() == pytest.approx(0.06, rel=0.1)
    assert drawn_gains.drift.std() == pytest.approx(0.06, rel=0.1)
    assert drawn_electronics(chance, 40, 0.0).drift.std() == 0.0


def test_fingertips_are_drawn_around_the_nominal_ones() -> None:
    chance = np.random.default_rng(1)
    many = [drawn(chance) for _ in range(400)]
    for name, deviation in DEVIATIONS.items():
        values = np.array([getattr(tips, name) for tips in many])
        assert values.std() == pytest.approx(deviation, rel=0.25)
        assert abs(values - getattr(Tips(), name)).max() <= 2.0 * deviation + 1e-12


@pytest.mark.slow
def test_frames_are_tared_and_the_bound_grows_with_what_is_unknown(
    lit: Light, monkeypatch: pytest.MonkeyPatch
) -> None:
    chance = np.random.default_rng(2)
    (finger,) = fingers([lit], 1, 0.0)
    empty = finger.values(Specimen("edge", offset_mm=-60.0, passed=0.0, albedo=0.0), chance)
    assert np.median(empty) > 251.0 and empty.std() < 3.0
    (drifted,) = fingers([lit], 1, 0.06)
    changed = drifted.values(Specimen("edge", offset_mm=-60.0, passed=0.0, albedo=0.0), chance)
    assert changed.std() > 2.0 * empty.std()
    shown = trials([finger, drifted], "cable", 4, 1)
    assert all(trial.values.shape == (len(LAYOUT),) for trial in shown)
    monkeypatch.setattr(second_bench, "DEVIATIONS", {"gap_mm": 0.3})
    monkeypatch.setattr(second_light.Light.of.__func__, "__defaults__", (0, *FEW.values()))
    known, unknown = Bound(LAYOUT)("edge", (0.7, 12.0), (0.0, 0.06))
    assert (known > 0.0).all() and (unknown > 1.2 * known).all()
    assert unknown[0] < 1.0 and unknown[1] < 5.0  # below the priors
