"""Objects that a model has twice: to be looked at, and to collide."""

import mujoco
import numpy as np
import pytest

from lumitip.mujoco import LightSensor, MujocoError
from lumitip.twin import Cable
from mujoco_bodies import GEOM, LAYOUT, TWIN, Add, both, disc, rod, sheet, state, values

BOX, CAPSULE = GEOM.mjGEOM_BOX, GEOM.mjGEOM_CAPSULE
ENDS = np.array([-0.08, 0.0, 0.0, 0.08, 0.0, 0.0])


def twice(radius_mm: float, collides: bool, begins_at_other_end: bool = False) -> Add:
    """A rod of 3 mm, and another radius on the same axis."""

    def add(spec: mujoco.MjSpec) -> None:
        body = spec.worldbody.add_body(name="rod")
        body.add_geom(type=CAPSULE, fromto=ENDS, size=[0.0015, 0.0, 0.0])
        ends = np.roll(ENDS, 3) if begins_at_other_end else ENDS
        copy = body.add_geom(type=CAPSULE, fromto=ends, size=[radius_mm / 1e3, 0.0, 0.0])
        if not collides:
            copy.contype = copy.conaffinity = 0

    return add


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    "add", [twice(1.5, True), twice(1.5, True, True), twice(1.5, False), twice(1.6, False)]
)
def test_a_rod_that_is_there_twice_is_one_round_cable(add: Add) -> None:
    assert np.abs(values(add) - values(rod(0.0, 0.0, CAPSULE))).max() < 1e-9


def test_two_boxes_at_the_same_place_take_light_once() -> None:
    def boxes(number: int) -> Add:
        def add(spec: mujoco.MjSpec) -> None:
            body = spec.worldbody.add_body(name="cloth")
            for _ in range(number):
                body.add_geom(type=BOX, size=[0.02, 0.01, 2e-4])

        return add

    once, double = (
        LightSensor(model, LAYOUT, materials={"cloth": (0.3, 0.2)}).values(data)
        for model, data in (state(boxes(1)), state(boxes(2)))
    )
    assert once.min() > 100.0 and np.array_equal(once, double)


def test_two_layers_stay_two() -> None:
    """Different heights, and different bodies beside each other."""

    def layers(*heights_mm: float) -> Add:
        def add(spec: mujoco.MjSpec) -> None:
            body = spec.worldbody.add_body(name="cloth")
            for z_mm in heights_mm:
                body.add_geom(type=BOX, size=[0.05, 0.05, 2e-4], pos=[0.0, 0.0, z_mm / 1e3])

        return add

    one, two = (
        LightSensor(model, LAYOUT, materials={"cloth": (0.4, 0.0)}).values(data)
        for model, data in (state(layers(0.0)), state(layers(-0.5, 0.5)))
    )
    assert (two < one - 40.0).all()
    assert values(both(disc(-8.0, 0.0), disc(8.0, 0.0))).min() < 60.0


def body_with(*, drawn: bool, alpha: float = 1.0, pair: bool = False) -> Add:
    """A rod that collides, and a plate without contacts that is larger."""

    def add(spec: mujoco.MjSpec) -> None:
        body = spec.worldbody.add_body(name="rod")
        body.add_geom(
            name="core", type=CAPSULE, fromto=ENDS, size=[0.0015, 0, 0], rgba=[1, 1, 1, alpha]
        )
        if drawn:
            plate = body.add_geom(name="plate", type=BOX, size=[0.05, 0.05, 2e-4])
            plate.contype = plate.conaffinity = 0
        if pair:
            spec.worldbody.add_geom(name="far", type=BOX, size=[0.01] * 3, pos=[0.5, 0.0, 0.0])
            spec.add_pair(geomname1="plate", geomname2="far")

    return add


def test_what_is_drawn_only_shades_nothing_beside_what_collides() -> None:
    assert np.array_equal(values(body_with(drawn=True)), values(body_with(drawn=False)))
    covered = values(sheet(60.0, 0.0))
    assert np.abs(values(body_with(drawn=True, alpha=0.0)) - covered).max() < 1.0, (
        "without a visible one that collides it is the object"
    )
    assert values(body_with(drawn=True, pair=True)).max() < 5.0, "it collides by a pair"


def test_what_is_fixed_to_the_world_is_not_one_object() -> None:
    def add(spec: mujoco.MjSpec) -> None:
        spec.worldbody.add_geom(type=BOX, size=[0.01] * 3, pos=[0.5, 0.0, 0.0])
        hose = spec.worldbody.add_geom(type=CAPSULE, fromto=ENDS, size=[0.0015, 0.0, 0.0])
        hose.contype = hose.conaffinity = 0

    assert np.abs(values(add) - TWIN.values(Cable())).max() <= 2.0


def test_a_material_of_what_shades_nothing_is_rejected() -> None:
    model, _ = state(body_with(drawn=True))
    with pytest.raises(MujocoError, match=r"'plate', a geom without contacts .* body 'rod'"):
        LightSensor(model, LAYOUT, materials={"plate": (0.3, 0.2)})
    LightSensor(model, LAYOUT, materials={"core": (0.3, 0.2), "rod": (0.3, 0.2)})
