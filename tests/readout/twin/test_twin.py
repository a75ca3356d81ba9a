"""The ways through the twin agree, and every fault of a fingertip shows where it should."""

from collections.abc import Callable

import numpy as np
import pytest

from lumitip import Layout
from lumitip.frame import complement
from lumitip.twin import (
    Cable,
    Corner,
    Disc,
    HalfPlane,
    Image,
    Misregistration,
    Model,
    Polygon,
    Sheet,
    Twin,
    TwinError,
)

TwinAt = Callable[..., Twin]
POSES = [(offset, angle) for offset in (-5.0, 0.3, 4.0) for angle in (-30.0, 0.0, 55.0, 140.0)]
FAR = Disc(60.0, 60.0, 1.0)
"""Covers nothing, but a scene of two objects goes through the raster, and with a cable by rays."""


def rms(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.sqrt(np.mean((one - other) ** 2)))


@pytest.mark.slow
@pytest.mark.parametrize("gap_mm", [2.0, 3.0, 6.0])
def test_table_raster_and_rays_agree(twin_at: TwinAt, gap_mm: float) -> None:
    twin = twin_at(gap_mm)
    rays = FAR, Disc(60.0, 60.0, 1.0, height=0.25)
    for offset_mm, angle_deg in POSES:
        edge, cable = HalfPlane(offset_mm, angle_deg), Cable(offset_mm, angle_deg)
        table = twin.values(edge)
        assert rms(table, twin.values([edge, *rays])) < 1.0
        assert rms(table, twin.values([edge, FAR])) < 4.0, "the raster softens by its pixel"
        assert table == pytest.approx(twin.edges(offset_mm, angle_deg)[0], abs=1e-9)
        assert rms(twin.values(cable), twin.values([cable, FAR])) < 1.2


def test_ways_that_disagree_would_be_seen(twin: Twin) -> None:
    rays = FAR, Disc(60.0, 60.0, 1.0, height=0.25)
    table = twin.values(HalfPlane(0.3, 10.0))
    assert rms(table, twin.values([HalfPlane(0.5, 10.0), *rays])) > 3.0
    assert rms(twin.values(Cable(diameter_mm=3.0)), twin.values([Cable(diameter_mm=3.6), FAR])) > 3


def test_a_curved_line_follows_its_circle(twin: Twin) -> None:
    rays = FAR, Disc(60.0, 60.0, 1.0, height=0.25)
    for radius_mm in (30.0, -30.0):
        edge = HalfPlane(1.0, 20.0, 1.0 / radius_mm)
        assert rms(twin.values(edge), twin.values([edge, *rays])) < 2.0
        assert rms(twin.values(edge), twin.values(HalfPlane(1.0, 20.0))) > 10.0
    x = np.linspace(-20.0, 20.0, 9)
    left, _ = Cable(0.0, 0.0, 0.05).left_of(x, np.full(9, 3.0))
    assert left == pytest.approx(20.0 - np.hypot(x, 17.0)), "a circle of 20 mm around (0, 20)"


def test_a_cylinder_casts_a_wider_shadow_than_a_strip(twin_at: TwinAt) -> None:
    cable, strip = Cable(), Polygon([(-60, -1.5), (60, -1.5), (60, 1.5), (-60, 1.5)])
    for gap_mm in (3.0, 6.0):
        twin = twin_at(gap_mm)
        rays = [strip, FAR, Disc(60.0, 60.0, 1.0, height=0.25)]
        taken = [255.0 * 32 - twin.values(scene).sum() for scene in (cable, rays)]
        assert 1.0 < taken[0] / taken[1] < 1.5


def test_objects_together_shade_as_their_union(twin: Twin) -> None:
    left, right = HalfPlane(-6.0, 90.0), HalfPlane(-6.0, -90.0)
    both = twin.values([left, right])
    assert both == pytest.approx(np.minimum(twin.values([left]), twin.values([right])), abs=6.0)
    low, high = HalfPlane(0.0, 0.0, height=0.3), HalfPlane(0.0, 0.0, height=0.7)
    stacked = twin.values([low, high])
    assert (stacked <= np.minimum(twin.values(low), twin.values(high)) + 2.0).all()
    assert twin.values([Sheet(clear=0.5), Sheet(clear=0.4)]) == pytest.approx(
        twin.values(Sheet(clear=0.2)), abs=0.01
    )


def test_drawn_objects_read_as_those_they_were_drawn_from(twin: Twin) -> None:
    shape = [(-5.0, -7.0), (6.0, -4.0), (2.0, 0.0), (4.0, 8.0), (-3.0, 5.0)]
    drawn = Image.of(Polygon(shape))
    assert rms(twin.values(drawn), twin.values(Polygon(shape))) < 1.2
    angle = np.radians(25.0)
    turned = np.array(shape) @ np.array(
        [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]
    )
    moved = drawn.at(2.0, -3.0, 25.0)
    assert rms(twin.values(moved), twin.values(Polygon(turned + np.array([2.0, -3.0])))) < 1.2
    corner = Corner(0.0, 0.0, -90.0, 90.0)
    far = 80.0
    square = Polygon([(0, 0), (far, -far), (0, -2 * far), (-far, -far)])
    # One on the raster, the other along its outline.
    assert rms(twin.values(corner), twin.values(square)) < 0.6


def test_a_hem_is_darker_than_the_cloth(twin: Twin) -> None:
    plain = twin.values(HalfPlane(clear=0.3))
    hemmed = twin.values(HalfPlane(clear=0.3, hem_mm=4.0))
    beside = (twin.layout.y_mm < -1.0) & (twin.layout.y_mm > -3.5)
    assert (hemmed[beside] < plain[beside] - 20.0).all()
    inner = twin.layout.y_mm < -8.0
    assert hemmed[inner] == pytest.approx(plain[inner], abs=6.0)


def test_height_moves_the_blur_but_not_the_edge(twin: Twin) -> None:
    low, middle, high = (twin.edge_table(h) for h in (0.2, 0.5, 0.8))
    centre = int(np.hypot(twin.layout.x_mm, twin.layout.y_mm).argmin())
    for table in (low, middle, high):
        at_edge = table(np.zeros(32), np.zeros(32))[centre]
        assert at_edge == pytest.approx(0.5, abs=0.01)
    beside = [table(np.zeros(32), np.full(32, 0.5))[centre] for table in (low, middle, high)]
    assert np.ptp(beside) > 0.005


def test_gains_show_and_the_empty_grasp_does_not_hide_them(twin: Twin) -> None:
    gains = np.linspace(0.8, 1.0, 32)
    aged = Twin(twin.layout, twin.model, gains=gains)
    assert aged.values() == pytest.approx(255.0 * gains, abs=12.0)
    assert aged.empty == pytest.approx(twin.empty)


@pytest.mark.slow
def test_misregistration_is_part_of_the_empty_grasp_and_moves_edges(twin: Twin) -> None:
    for astray in (
        Misregistration(x_mm=1.0, y_mm=0.5),
        Misregistration(angle_deg=3.0),
        Misregistration(tilt_deg=4.0),
    ):
        bent = Twin(twin.layout, twin.model, misregistration=astray)
        assert bent.values() == pytest.approx(255.0)
        assert rms(bent.values(HalfPlane()), twin.values(HalfPlane())) > 0.8
        assert rms(bent.drive, twin.drive) > 0.005
    up = Twin(twin.layout, twin.model, misregistration=Misregistration(tilt_deg=4.0))
    tip, root = up.drive[twin.layout.y_mm > 8.0].mean(), up.drive[twin.layout.y_mm < -8.0].mean()
    assert tip < 0.9 * root, "the gap grows towards the tip"
    shifted = Twin(twin.layout, twin.model, misregistration=Misregistration(y_mm=1.0))
    assert shifted.values(HalfPlane(0.5)) == pytest.approx(twin.values(HalfPlane(0.0)), abs=60.0)
    with pytest.raises(TwinError, match="the fingers touch"):
        Twin(twin.layout, twin.model, misregistration=Misregistration(tilt_deg=20.0))


def test_ambient_light_brightens_the_dark(twin: Twin) -> None:
    lit = Twin(twin.layout, twin.model, ambient=0.1)
    expected = 0.1 * twin.model.gain * 255.0 * 255.0 / twin.empty
    assert lit.values(Sheet()) == pytest.approx(expected, abs=0.5)


def test_codes_are_dark_high_truncated_and_noisy_as_told(twin: Twin) -> None:
    for bits in (8, 10, 12):
        still = Twin(twin.layout, twin.model, noise=0.0, bits=bits)
        codes = still.frame(HalfPlane(), t=1e4)
        assert codes.dtype == (np.uint8 if bits == 8 else np.uint16)
        light = still.uncalibrated(still.light(HalfPlane()))
        cut = (1.0 - light / 255.0) * 2**bits - codes
        assert ((cut >= 0.0) & (cut < 1.0) | (light < 0.5)).all(), "an ADC cuts the rest off"
        assert np.ptp(cut[light > 0.5]) > 0.3
    noisy = Twin(twin.layout, twin.model, noise=3.0, bits=12)
    frames = noisy.codes(np.tile(noisy.light(), (500, 1)), 1e4 + np.arange(500) * 0.01)
    assert complement(frames, 12).std(axis=0) == pytest.approx(3.0, rel=0.2)


def test_the_same_seed_and_time_give_the_same_codes(twin: Twin) -> None:
    again = Twin(twin.layout, twin.model)
    other = Twin(twin.layout, twin.model, seed=1)
    one = twin.frame(HalfPlane(), t=1.5)
    assert (one == again.frame(HalfPlane(), t=1.5)).all()
    assert (one != again.frame(HalfPlane(), t=1.51)).any()
    assert (one != other.frame(HalfPlane(), t=1.5)).any()


def test_leds_give_less_as_they_warm_up(twin: Twin) -> None:
    still = Twin(twin.layout, twin.model, noise=0.0, bits=12, warm_up=0.05)
    light = [float(complement(still.frame(t=t), 12).mean()) for t in (0.0, 60.0, 300.0, 3000.0)]
    assert light == sorted(light, reverse=True)
    assert light[0] / light[3] == pytest.approx(1.03, abs=0.02), "the circuit gives way near full"
    assert light[2] - light[3] < 0.1 * (light[0] - light[3])


def test_batches_read_as_single_scenes(twin: Twin) -> None:
    scenes = [(), Sheet(), Cable(1.0, 10.0), [Disc(), Disc(5.0, 5.0, 3.0)]]
    batch = twin.batch(scenes)
    assert batch.shape == (4, 32)
    assert batch == pytest.approx(np.stack([twin.values(scene) for scene in scenes]))
    at = twin.plane()
    discs = [Disc(x, 0.0) for x in (-5.0, 0.0, 5.0)]
    drawn = np.stack([d.coverage(at.x_mm, at.y_mm, at.pixel_mm) for d in discs])
    assert twin.batch(drawn) == pytest.approx(twin.batch(discs), abs=1e-3)
    assert twin.batch([]).shape == (0, 32)


@pytest.mark.parametrize("columns", [(1,), (2, 3, 2), (9, 8, 9, 8, 9, 8, 9, 8, 9)])
def test_every_grid_has_a_twin(make_layout: Callable[..., Layout], columns: tuple[int]) -> None:
    layout = make_layout(columns, 4.0)
    twin = Twin(layout, Model.from_layout(layout, hole_mm=1.5, hole_shape="circle"))
    assert twin.values() == pytest.approx(255.0)
    dense = twin.values([HalfPlane(0.2, 30.0), FAR])
    assert rms(dense, twin.values(HalfPlane(0.2, 30.0))) < 9.0, "small holes, the same pixel"
    assert twin.batch([Sheet(diffuse=0.4)]).max() < 130.0
    drawn = HalfPlane(0.2, 30.0).coverage(
        twin.plane().x_mm, twin.plane().y_mm, twin.plane().pixel_mm
    )
    assert twin.batch(drawn[None])[0] == pytest.approx(dense, abs=1e-2)


@pytest.mark.parametrize(
    "wrong",
    [{"bits": 9}, {"gains": [1.0, 2.0]}, {"noise": -1.0}, {"ambient": -0.1}, {"warm_up": -0.1}],
)
def test_faults_that_cannot_be_are_refused(twin: Twin, wrong: dict[str, object]) -> None:
    with pytest.raises(TwinError):
        Twin(twin.layout, twin.model, **wrong)  # type: ignore[arg-type]
