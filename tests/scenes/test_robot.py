"""The robot's model in the programs that robotics researchers load it with."""

import shutil
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
import xacro
import yourdfpy

from lumitip import Layout
from lumitip.mujoco import LightSensor, fingers, open_fingers
from lumitip.twin import Cable, Model, Twin
from lumitip_fab.design.encoding import read_design

FINGERS = ("receiver", "emitter")


@pytest.fixture
def model(outputs: Path) -> yourdfpy.URDF:
    return yourdfpy.URDF.load(
        str(outputs / "robot/lumitip.urdf"),
        load_collision_meshes=True,
        build_collision_scene_graph=True,
        force_collision_mesh=False,
    )


def test_yourdfpy_moves_both_fingers(model: yourdfpy.URDF, outputs: Path) -> None:
    opening = read_design(outputs / "design.json").closing.max_opening_mm / 1000
    assert model.actuated_joint_names == ["lumitip_receiver_joint"]
    for share in (0.0, 0.5, 1.0):
        model.update_cfg([share * opening / 2])
        places = [model.get_transform(f"lumitip_{f}", "lumitip_base") for f in FINGERS]
        assert places[1][0, 3] - places[0][0, 3] == pytest.approx(
            0.000987 + share * opening, abs=2e-6
        )
    assert model.scene.extents[0] > opening
    assert len(model.collision_scene.geometry) == 4


def test_a_point_of_a_sensor_is_a_point_of_its_link(model: yourdfpy.URDF) -> None:
    """LED i faces detector i: mirrored in x of the frames, they lie on one line across."""
    model.update_cfg([0.01])
    for x_mm, y_mm in ((0.0, 0.0), (10.4, -6.0)):
        seen = [
            model.get_transform(f"lumitip_{f}", "lumitip_base")
            @ (sign * x_mm / 1000, y_mm / 1000, 0, 1)
            for f, sign in zip(FINGERS, (1, -1), strict=True)
        ]
        assert np.allclose(seen[0][1:3], seen[1][1:3], atol=1e-9)


def test_mujoco_loads_and_drops_it(outputs: Path) -> None:
    loaded = mujoco.MjModel.from_xml_path(str(outputs / "robot/lumitip.urdf"))
    data = mujoco.MjData(loaded)
    assert {loaded.joint(i).name for i in range(loaded.njnt)} == {
        f"lumitip_{f}_joint" for f in FINGERS
    }
    assert 0.02 < loaded.body_mass.sum() < 0.1
    for _ in range(100):
        mujoco.mj_step(loaded, data)
    assert np.isfinite(data.qpos).all()


def test_fingers_touch_when_they_are_closed_and_not_before(outputs: Path) -> None:
    """By MuJoCo's own collisions."""
    loaded = mujoco.MjModel.from_xml_path(str(outputs / "robot/lumitip.urdf"))
    data = mujoco.MjData(loaded)
    for opened_mm, touch in ((0.0, True), (0.2, False)):
        data.qpos[:] = (opened_mm - 0.02) / 2000
        mujoco.mj_forward(loaded, data)
        assert (data.ncon > 0) == touch, opened_mm


def test_the_light_between_these_fingers_in_mujoco(outputs: Path) -> None:
    """The gap of the model is that of the light, and the file's own bodies shade nothing."""
    layout = Layout.load(outputs / "layout.json")
    spec = fingers(layout, outputs / "robot/lumitip.urdf")
    model, data = _at_gap(spec.compile(), 3.0)
    assert (LightSensor(model, layout).values(data) > 255.0 - 1e-9).all()
    receiver, emitter = (model.body(f"lumitip_{name}").id for name in FINGERS)
    turn, place = data.xmat[receiver].reshape(3, 3), data.xpos[receiver]
    x_mm, y_mm, gap_mm = 1e3 * turn.T @ (data.xpos[emitter] - place)
    # The fingers lean, and the opening is the smallest distance: in the middle there is more.
    assert abs(x_mm) < 1e-6 and abs(y_mm) < 0.2 and 3.0 < gap_mm < 4.5
    half_m = gap_mm / 2e3
    ends = place + np.array([[-0.08, 0.002, half_m], [0.08, 0.002, half_m]]) @ turn.T
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CAPSULE, fromto=ends.ravel(), size=[0.0015, 0.0, 0.0]
    )
    model, data = _at_gap(spec.compile(), 3.0)
    twin = Twin(layout, Model.from_layout(layout, gap_mm=gap_mm))
    expected = twin.values(Cable(offset_mm=2.0))
    assert np.abs(LightSensor(model, layout).values(data) - expected).max() <= 2.0


@pytest.mark.slow
def test_the_program_of_the_page_on_mujoco(
    outputs: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    page = (Path(__file__).parents[2] / "docs/mujoco.md").read_text(encoding="utf-8")
    (tmp_path / "outputs").symlink_to(outputs)
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    exec(page.partition("```python\n")[2].partition("```")[0], names)
    values, layout = names["values"], names["layout"]
    assert values.min() < 60.0, f"the rod was lost: {values}"
    assert layout.y_mm[values < 100.0].mean() == pytest.approx(0.0, abs=1.0)
    filled = names["data"].sensor("lumitip_light").data
    assert np.allclose(filled, values, atol=1.0)


def _at_gap(model: mujoco.MjModel, gap_mm: float) -> tuple[mujoco.MjModel, mujoco.MjData]:
    data = mujoco.MjData(model)
    open_fingers(model, data, gap_mm)
    return model, data


def test_a_macro_hangs_a_finger_on_another_gripper(outputs: Path, tmp_path: Path) -> None:
    shutil.copy(outputs / "robot/lumitip.xacro", tmp_path)
    (tmp_path / "arm.xacro").write_text(
        '<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:include filename="lumitip.xacro"/><link name="left_jaw"/>'
        '<xacro:lumitip_receiver parent="left_jaw" prefix="left_" meshes="package://arm/meshes">'
        '<origin xyz="0 0 0.1" rpy="0 0 0"/></xacro:lumitip_receiver></robot>'
    )
    told = xacro.process_file(str(tmp_path / "arm.xacro")).toxml()
    assert 'name="left_receiver"' in told
    assert 'filename="package://arm/meshes/receiver_backing.stl"' in told
    assert '<origin rpy="0 0 0" xyz="0 0 0.1"/>' in told
    assert "${" not in told
