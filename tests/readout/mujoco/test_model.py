"""Fingers and sensor as parts of a MuJoCo model."""

import mujoco
import numpy as np
import pytest

from lumitip.mujoco import ACTUATOR, SENSOR, LightSensor, MujocoError, fingers, open_fingers
from lumitip.twin import Cable
from mujoco_bodies import (
    GEOM,
    LAYOUT,
    MOST_COUNTS,
    TWIN,
    moving_rod,
    rope,
    sheet,
    state,
)


def test_mujoco_fills_the_sensor_in_each_step() -> None:
    model = moving_rod().compile()
    data = mujoco.MjData(model)
    open_fingers(model, data, 3.0)
    data.joint("slide").qvel = 0.5
    heights = []
    with LightSensor(model, LAYOUT).installed():
        for _ in range(20):
            mujoco.mj_step(model, data)
            light = 255.0 - data.sensor(SENSOR).data
            heights.append(float(light @ LAYOUT.y_mm / light.sum()))
    assert mujoco.get_mjcb_sensor() is None
    assert np.all(np.diff(heights) > 0.0), "the shadow does not follow the rod"
    assert heights[-1] - heights[0] == pytest.approx(19 * 0.5, rel=0.2)  # 0.5 mm in a step


def test_two_pairs_in_one_model_and_a_callback_of_ones_own() -> None:
    spec = mujoco.MjSpec()
    spec.option.timestep, spec.option.gravity = 0.001, [0.0, 0.0, 0.0]
    for name, place in (("left/", -0.2), ("right/", 0.2)):
        pair = moving_rod()
        spec.worldbody.add_frame(pos=[place, 0.0, 0.0]).attach_body(pair.worldbody, name, "")
    model = spec.compile()
    data = mujoco.MjData(model)
    for name in ("left/", "right/"):
        for side in ("receiver", "emitter"):
            data.joint(f"{name}lumitip_{side}_joint").qpos = 0.0015
    data.joint("right/slide").qpos = 0.008
    mujoco.mj_forward(model, data)
    calls = []
    mujoco.set_mjcb_sensor(lambda *_: calls.append(1))
    try:
        sensors = [
            LightSensor(
                model,
                LAYOUT,
                fingers=(f"{name}lumitip_receiver", f"{name}lumitip_emitter"),
                sensor=f"{name}{SENSOR}",
            )
            for name in ("left/", "right/")
        ]
        with sensors[0].installed(), sensors[1].installed():
            mujoco.mj_forward(model, data)
        assert calls and mujoco.get_mjcb_sensor() is not None
    finally:
        mujoco.set_mjcb_sensor(None)
    left, right = (data.sensor(f"{name}{SENSOR}").data for name in ("left/", "right/"))
    assert left.min() < 150.0 and np.abs(left - right).max() > 50.0


def test_attached_fingers_open_by_their_prefix() -> None:
    spec = mujoco.MjSpec()
    spec.option.timestep = 0.001  # as that of the fingers
    for number, prefix in enumerate(("left/", "right/")):
        spec.attach(
            fingers(LAYOUT), prefix=prefix, frame=spec.worldbody.add_frame(pos=[number, 0.0, 0.0])
        )
    model = spec.compile()
    data = mujoco.MjData(model)
    open_fingers(model, data, 6.0, prefix="right/")
    for prefix, opening_mm in (("left/", 0.0), ("right/", 6.0)):
        for side in ("receiver", "emitter"):
            travel = data.joint(f"{prefix}lumitip_{side}_joint").qpos
            assert 2e3 * float(travel[0]) == pytest.approx(opening_mm)
        assert data.ctrl[model.actuator(f"{prefix}{ACTUATOR}").id] == opening_mm / 2e3
    with pytest.raises(MujocoError, match=r"with the prefix 'left/' or 'right/': pass it as"):
        open_fingers(model, data, 6.0)
    with pytest.raises(MujocoError, match=r"no joints lumitip_receiver_joint .* `fingers` makes"):
        open_fingers(mujoco.MjSpec().compile(), data, 6.0)


@pytest.mark.slow_cases
@pytest.mark.parametrize("radius_mm", [0.5, 2.0])
def test_the_fingers_close_on_a_body_with_their_force(radius_mm: float) -> None:
    spec = fingers(LAYOUT, force_n=10.0)
    spec.option.gravity = [0.0, 0.0, 0.0]
    body = spec.worldbody.add_body(name="rod")
    body.add_freejoint()
    ends, radius_m = [-0.03, 0, 0, 0.03, 0, 0], radius_mm / 1e3
    body.add_geom(type=GEOM.mjGEOM_CAPSULE, fromto=ends, size=[radius_m, 0, 0])
    model = spec.compile()
    data = mujoco.MjData(model)
    open_fingers(model, data, 6.0)
    assert 2e3 * data.qpos[0] == pytest.approx(6.0)
    data.ctrl[model.actuator(ACTUATOR).id] = model.actuator(ACTUATOR).ctrlrange[0]
    mujoco.mj_step(model, data, 1000)
    assert 2e3 * data.qpos[0] == pytest.approx(2.0 * radius_mm, abs=0.2)
    assert data.qpos[0] == pytest.approx(data.qpos[1], abs=2e-4)
    pressed = dict.fromkeys(("receiver", "emitter"), 0.0)
    for number in range(data.ncon):
        force = np.zeros(6)
        mujoco.mj_contactForce(model, data, number, force)
        bodies = {model.body(int(model.geom_bodyid[g])).name for g in data.contact[number].geom}
        for side in pressed:
            pressed[side] += force[0] if f"lumitip_{side}" in bodies else 0.0
    assert pressed == pytest.approx({"receiver": 10.0, "emitter": 10.0}, rel=0.1)
    assert LightSensor(model, LAYOUT).values(data).min() < 200.0


def test_a_model_can_be_saved_as_mjcf() -> None:
    spec = fingers(LAYOUT)
    rope(1.0)(spec)
    before = spec.compile()
    again = mujoco.MjModel.from_xml_string(spec.to_xml())
    assert again.nsensordata == before.nsensordata == len(LAYOUT)
    data = mujoco.MjData(again)
    open_fingers(again, data, 3.0)
    assert LightSensor(again, LAYOUT).values(data).min() < 60.0


def test_materials_by_geom_body_and_chain() -> None:
    def chain(spec: mujoco.MjSpec) -> None:
        body = spec.worldbody.add_body(name="hose")
        for number in range(8):
            begin = -0.08 + 0.02 * number
            body.add_geom(
                name=f"part{number}",
                type=GEOM.mjGEOM_CAPSULE,
                fromto=[begin, 0.0, 0.0, begin + 0.02, 0.0, 0.0],
                size=[0.0015, 0.0, 0.0],
            )

    model, data = state(chain)
    clear = LightSensor(model, LAYOUT, materials={"hose": (0.9, 0.0)}).values(data)
    assert np.abs(clear - TWIN.values(Cable(clear=0.9))).max() <= MOST_COUNTS
    part = LightSensor(model, LAYOUT, materials={"part4": (0.9, 0.0)}).values(data)
    opaque = LightSensor(model, LAYOUT).values(data)
    darker = part < clear - 50.0
    assert darker.any() and (part > opaque + 50.0).any()


def test_wrong_arguments_are_named() -> None:
    model, data = state(sheet(0.0, 0.0))
    for names in (("left", "right"), ("world", "lumitip_emitter"), ("lumitip_emitter",) * 2):
        with pytest.raises(MujocoError, match="two bodies of the model are needed"):
            LightSensor(model, LAYOUT, fingers=names)
    for materials, words in (
        ({"silk": (0.1, 0.1)}, "materials has 'silk'; the model has no such"),
        ({"lumitip_receiver": (0.8, 0.4)}, "whose sum is 1 at most"),
        ({"lumitip_receiver": 0.3}, "whose sum is 1 at most"),
        (["lumitip_receiver"], "names with two numbers are needed"),
    ):
        with pytest.raises(MujocoError, match=words):
            LightSensor(model, LAYOUT, materials=materials)  # type: ignore[arg-type]
    with pytest.raises(MujocoError, match=r"'none\.urdf'; MuJoCo cannot read it"):
        fingers(LAYOUT, "none.urdf")
    with pytest.raises(MujocoError, match="opening_mm is 200"):
        open_fingers(model, data, 200.0)
    bare = mujoco.MjSpec()
    for name in ("lumitip_receiver", "lumitip_emitter"):
        bare.worldbody.add_body(name=name)
    other = bare.compile()
    with (
        pytest.raises(MujocoError, match=f"no sensor '{SENSOR}' of 32 values"),
        LightSensor(other, LAYOUT).installed(),
    ):
        pass
    with pytest.raises(MujocoError, match="data is of another model"):
        LightSensor(other, LAYOUT).values(data)
    with pytest.raises(MujocoError, match="the fingers do not face"):
        LightSensor(other, LAYOUT).values(mujoco.MjData(other))
    data.qpos[0] = np.nan
    with pytest.raises(MujocoError, match="not finite"):
        LightSensor(model, LAYOUT).values(data)
