"""The robot's model in the programs that robotics researchers load it with."""

import shutil
from pathlib import Path

import mujoco
import numpy as np
import pytest
import xacro
import yourdfpy

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
