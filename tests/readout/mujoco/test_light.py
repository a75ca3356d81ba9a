"""The light of rigid bodies in MuJoCo, against scenes of the twin."""

import mujoco
import numpy as np
import pytest

from lumitip.mujoco import LightSensor
from lumitip.twin import Cable, Corner, Disc, HalfPlane, Model, Polygon, Scene, Twin
from mujoco_bodies import (
    GEOM,
    LAYOUT,
    MOST_COUNTS,
    TWIN,
    Add,
    ball,
    both,
    corner,
    direction,
    disc,
    quat,
    rod,
    sheet,
    state,
    values,
)


@pytest.mark.slow_cases
@pytest.mark.parametrize("seed", range(8))
def test_rigid_shapes_give_the_light_of_the_twin(seed: int) -> None:
    chance = np.random.default_rng(seed)
    offset, angle = chance.uniform(-7.0, 7.0), chance.uniform(-180.0, 180.0)
    x, y = chance.uniform(-8.0, 8.0, 2)
    pairs: list[tuple[Add, Scene]] = [
        (sheet(offset, angle), HalfPlane(offset_mm=offset, angle_deg=angle)),
        (corner(x, y, angle), Corner(x_mm=x, y_mm=y, angle_deg=angle)),
        (rod(offset, angle, GEOM.mjGEOM_CAPSULE), Cable(offset_mm=offset, angle_deg=angle)),
        (rod(offset, angle, GEOM.mjGEOM_CYLINDER), Cable(offset_mm=offset, angle_deg=angle)),
        (disc(x, y), Disc(x_mm=x, y_mm=y, diameter_mm=12.0)),
        (ball(x, y), Disc(x_mm=x, y_mm=y, diameter_mm=3.0)),
    ]
    for add, scene in pairs:
        expected = TWIN.values(scene)
        assert expected.min() < 250.0, "the scene shades nothing"
        assert np.abs(values(add) - expected).max() <= MOST_COUNTS, scene


def test_a_small_plate_and_two_bodies_are_outlines() -> None:
    points = [(x, y) for x, y in ((-4.0, -3.0), (4.0, -3.0), (4.0, 3.0), (-4.0, 3.0))]

    def plate(spec: mujoco.MjSpec) -> None:
        spec.worldbody.add_geom(type=GEOM.mjGEOM_BOX, size=[0.004, 0.003, 2e-4])

    assert np.abs(values(plate) - TWIN.values(Polygon(points))).max() <= MOST_COUNTS
    scene = [Polygon(points), Disc(x_mm=12.0, y_mm=4.0, diameter_mm=12.0)]
    assert np.abs(values(both(plate, disc(12.0, 4.0))) - TWIN.values(scene)).max() <= MOST_COUNTS


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_any_gap_and_any_height(seed: int) -> None:
    chance = np.random.default_rng(seed)
    gap_mm = chance.uniform(2.0, 9.0)
    z_mm = chance.uniform(-0.3, 0.3) * gap_mm
    offset, angle = chance.uniform(-6.0, 6.0), chance.uniform(-90.0, 90.0)
    twin = Twin(LAYOUT, Model.from_layout(LAYOUT, gap_mm=gap_mm))
    height = 0.5 + z_mm / gap_mm
    line = {"offset_mm": offset, "angle_deg": angle, "height": height}
    for add, scene in (
        (rod(offset, angle, GEOM.mjGEOM_CAPSULE, z_mm), Cable(**line)),
        (sheet(offset, angle, z_mm), HalfPlane(**line)),
        (disc(offset, 2.0, z_mm), Disc(x_mm=offset, y_mm=2.0, diameter_mm=12.0, height=height)),
    ):
        error = np.abs(values(add, gap_mm) - twin.values(scene)).max()
        assert error <= 1.5 * MOST_COUNTS, (gap_mm, z_mm, scene)


def test_what_is_not_between_the_fingers_shades_nothing() -> None:
    """Links of a robot: capsules and discs behind and beside the fingers."""
    for add in (
        rod(0.0, 0.0, GEOM.mjGEOM_CAPSULE, -50.0),
        rod(0.0, 0.0, GEOM.mjGEOM_CAPSULE, 50.0),
        lambda spec: spec.worldbody.add_geom(
            type=GEOM.mjGEOM_CYLINDER, size=[0.04, 1e-3, 0.0], pos=[0.0, 0.0, -0.03]
        ),
        disc(45.0, 0.0),
        lambda spec: spec.worldbody.add_geom(type=GEOM.mjGEOM_BOX, size=[0.01] * 3, rgba=[0] * 4),
    ):
        assert (values(add) > 255.0 - 1e-9).all()
    partly = values(disc(21.0, 4.0))
    assert np.abs(partly - TWIN.values(Disc(x_mm=21.0, y_mm=4.0, diameter_mm=12.0))).max() <= 2.0
    assert partly.min() < 150.0


def test_several_cables_stay_round() -> None:
    pair = both(rod(3.0, 0.0, GEOM.mjGEOM_CAPSULE), rod(-3.0, 0.0, GEOM.mjGEOM_CAPSULE))
    scene = [Cable(offset_mm=3.0), Cable(offset_mm=-3.0)]
    assert np.abs(values(pair) - TWIN.values(scene)).max() <= MOST_COUNTS
    crossing = both(rod(0.0, 20.0, GEOM.mjGEOM_CAPSULE), rod(0.0, -50.0, GEOM.mjGEOM_CAPSULE))
    scene = [Cable(angle_deg=20.0), Cable(angle_deg=-50.0)]
    assert np.abs(values(crossing) - TWIN.values(scene)).max() <= MOST_COUNTS


@pytest.mark.parametrize("turn_deg", [90.0, 150.0])
def test_a_sharp_bend_has_two_legs(turn_deg: float) -> None:
    """Two capsules that meet: each shades as alone, away from the bend."""

    def leg(angle_deg: float) -> Add:
        ends = [0.0, 0.0, 0.0, *(0.08 * direction(angle_deg)), 0.0]
        return lambda spec: spec.worldbody.add_geom(
            type=GEOM.mjGEOM_CAPSULE, fromto=ends, size=[0.0015, 0.0, 0.0]
        )

    bent = values(both(leg(0.0), leg(180.0 - turn_deg)))
    for angle in (0.0, 180.0 - turn_deg):
        alone = values(leg(angle))
        darkest = int(alone.argmin())
        assert bent[darkest] <= alone[darkest] + MOST_COUNTS


def test_nothing_between_the_fingers_is_full_light() -> None:
    def beside(spec: mujoco.MjSpec) -> None:
        spec.worldbody.add_geom(type=GEOM.mjGEOM_BOX, size=[0.01, 0.01, 0.01], pos=[0.1, 0.0, 0.0])
        spec.worldbody.add_geom(type=GEOM.mjGEOM_PLANE, size=[1.0, 1.0, 0.1], pos=[0.0, 0.0, -0.2])

    assert (values(beside) > 255.0 - 1e-9).all()


def test_an_ellipsoid_is_the_ellipse_that_is_seen() -> None:
    def ellipsoid(spec: mujoco.MjSpec) -> None:
        spec.worldbody.add_geom(type=GEOM.mjGEOM_ELLIPSOID, size=[8e-3, 4e-3, 1e-3], quat=quat(30))

    turn = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
    rim = np.stack([8.0 * np.cos(turn), 4.0 * np.sin(turn)], axis=1)
    way = np.stack([direction(30.0), direction(120.0)])
    assert np.abs(values(ellipsoid) - TWIN.values(Polygon(rim @ way))).max() <= MOST_COUNTS


def test_sizes_that_change_are_followed() -> None:
    model, data = state(sheet(0.0, 0.0))
    sensor = LightSensor(model, LAYOUT)
    wide = sensor.values(data)
    model.geom_size[0, 1] = 1e-3
    mujoco.mj_forward(model, data)
    assert (sensor.values(data) - wide).max() > 200.0
