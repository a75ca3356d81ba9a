"""The pages on ROS 2: their calls of the xacro macros, tried with xacro itself."""

import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import xacro

from lumitip_fab.scenes.robot import FingerModel, Weight, pair_xacro

ROOT = Path(__file__).parents[2]
TUTORIAL, README = ROOT / "docs/tutorials/ros2.md", ROOT / "readout/ros2/README.md"


@pytest.fixture
def described(tmp_path: Path) -> Path:
    """A package of a robot, with the folder of macros that the tutorial asks for."""
    weight = Weight(20.0, np.zeros(3), np.eye(3))
    pair = tuple(
        FingerModel(
            name=name,
            weight=weight,
            visuals=((f"{name}_backing.stl", (0.1, 0.1, 0.1, 1.0)),),
            collisions=(f"{name}_collision_plate.stl",),
            to_base=np.eye(4),
            opening=np.array([0.0, 0.0, -1.0]),
        )
        for name in ("receiver", "emitter")
    )
    (tmp_path / "lumitip").mkdir()
    (tmp_path / "lumitip/lumitip.xacro").write_bytes(pair_xacro(pair, "meshes"))
    return tmp_path


def robot(folder: Path, calls: str) -> ElementTree.Element:
    path = folder / "arm.xacro"
    jaws = '<link name="left_jaw"/><link name="right_jaw"/>'
    path.write_text(
        f'<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">{jaws}{calls}</robot>'
    )
    return ElementTree.fromstring(xacro.process_file(str(path)).toxml())


def calls_of_the_tutorial() -> str:
    return TUTORIAL.read_text("utf-8").partition("```xml\n")[2].partition("```")[0]


def test_the_calls_of_the_tutorial_hang_both_fingers_on_the_jaws(described: Path) -> None:
    made = robot(described, calls_of_the_tutorial())
    joints = {
        joint.attrib["name"]: (
            joint.attrib["type"],
            joint.find("parent").attrib["link"],  # type: ignore[union-attr]
            joint.find("child").attrib["link"],  # type: ignore[union-attr]
        )
        for joint in made.iter("joint")
    }
    assert set(joints.values()) == {
        ("fixed", "left_jaw", "lumitip_receiver"),
        ("fixed", "right_jaw", "lumitip_emitter"),
    }
    meshes = [mesh.attrib["filename"] for mesh in made.iter("mesh")]
    assert len(meshes) == 4 and all(
        re.match(r"package://my_robot/lumitip/meshes/\w+\.stl", mesh) for mesh in meshes
    )


def test_two_fingertips_have_frames_of_their_own(described: Path) -> None:
    page = README.read_text("utf-8")
    (launched,) = re.findall(r"name:=left .*line_frame_id:=\S+", page)
    (frame,) = re.findall(r"(?<!_)frame_id:=(\S+)", launched)
    (prefix, _) = re.findall(r'prefix="(\w+)"', page)
    assert f'prefix="{prefix}"' in TUTORIAL.read_text("utf-8")
    calls = calls_of_the_tutorial()
    again = calls.partition("\n")[2].replace('parent="', f'prefix="{prefix}" parent="')
    links = [link.attrib["name"] for link in robot(described, calls + again).iter("link")]
    assert len(links) == len(set(links)), "two pairs have links of their own"
    assert frame in links and frame != "lumitip_receiver"
