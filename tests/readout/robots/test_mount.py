"""Where the fingertip is on the tool, against another implementation of rotations."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lumitip.control import Command
from lumitip.robots import ArmError, Mount
from lumitip.robots.mount import in_base, in_tool, rotation_of

DOWN_THE_FINGER = Mount(x=(1, 0, 0), y=(0, 0, 1), origin_mm=(0.0, -5.0, 120.0))


def test_the_sensor_looks_across_the_gripper() -> None:
    assert np.allclose(DOWN_THE_FINGER.rotation[:, 2], [0, -1, 0])
    assert np.linalg.det(DOWN_THE_FINGER.rotation) == pytest.approx(1.0)


def test_a_straight_command_moves_the_tool_alike() -> None:
    twist = DOWN_THE_FINGER.tool_twist(Command(forward_mm_s=30.0, lateral_mm_s=-4.0))
    assert np.allclose(twist, [0.030, 0, -0.004, 0, 0, 0])


def test_a_turn_is_about_the_fingertip_not_the_tool() -> None:
    twist = DOWN_THE_FINGER.tool_twist(Command(rotation_rad_s=0.5))
    assert np.allclose(twist[3:], [0, -0.5, 0])
    # A step of the motion, done by rotating the tool about the fingertip.
    origin_m = np.array(DOWN_THE_FINGER.origin_mm) / 1000.0
    step = Rotation.from_rotvec(twist[3:] * 1e-6)
    tool_m = origin_m - step.apply(origin_m)
    assert np.allclose(tool_m / 1e-6, twist[:3], atol=1e-6)
    assert np.linalg.norm(twist[:3]) == pytest.approx(0.5 * 0.120)


def test_what_is_measured_is_what_was_told() -> None:
    mount = Mount(x=(0.6, 0.8, 0), y=(0, 0, -1), origin_mm=(10.0, -20.0, 130.0))
    pose = np.array([0.4, 0.1, 0.2, 1.1, -2.0, 0.4])
    told = Command(31.0, -12.0, 0.7)
    twist = in_tool(pose, in_base(pose, mount.tool_twist(told)))
    seen = mount.command(twist)
    assert (seen.forward_mm_s, seen.lateral_mm_s, seen.rotation_rad_s) == pytest.approx(
        (31.0, -12.0, 0.7)
    )


@pytest.mark.parametrize("turn", [(0, 0, 0), (1e-9, 0, 0), (0.3, -0.2, 2.9), (math.pi, 0, 0)])
def test_poses_turn_as_their_vector_says(turn: tuple[float, float, float]) -> None:
    pose = np.array([0.4, 0.1, 0.2, *turn])
    expected = Rotation.from_rotvec(turn).as_matrix()
    assert np.allclose(rotation_of(pose), expected, atol=1e-8)
    assert np.allclose(in_base(pose, np.array([0, 0, 1, 0, 1, 0.0]))[:3], expected[:, 2])
    away_mm = DOWN_THE_FINGER.origin_in_base_mm(pose)
    assert np.allclose(away_mm, [400, 100, 200] + expected @ (0.0, -5.0, 120.0))


@pytest.mark.parametrize(
    "x_and_y", [((1, 0, 0), (1, 0, 0)), ((2, 0, 0), (0, 1, 0)), ((1, 0, math.nan), (0, 1, 0))]
)
def test_axes_that_span_no_frame_are_refused(x_and_y: tuple) -> None:  # type: ignore[type-arg]
    with pytest.raises(ArmError, match=r"length 1|three numbers"):
        Mount(*x_and_y)
