"""The way to a new velocity: of tool, fingertip and rotation at once."""

import numpy as np
import pytest

from lumitip.control import Command
from lumitip.robots import ArmLimits, Mount
from lumitip.robots.ramp import Ramp

LIMITS = ArmLimits(acceleration_mm_s2=500.0, rotation_rad_s2=3.0)
STEP_S = 0.008


def _mount(length_mm: float) -> Mount:
    return Mount(x=(1, 0, 0), y=(0, 0, 1), origin_mm=(0.0, 0.0, length_mm))


def _ramped(mount: Mount, wanted: np.ndarray, seconds: float) -> tuple[Ramp, np.ndarray]:
    """A ramp, and its twists until it has arrived, shape `(n, 6)`."""
    ramp = Ramp(LIMITS, mount)
    twists = [np.zeros(6)]
    while not np.allclose(twists[-1], wanted, atol=1e-12):
        twists.append(ramp.toward(wanted, seconds))
        assert len(twists) < 1000
    return ramp, np.array(twists)


def test_a_turn_about_the_fingertip_does_not_move_it_on_the_way() -> None:
    mount = _mount(80.0)
    _, twists = _ramped(mount, mount.tool_twist(Command(rotation_rad_s=0.8)), STEP_S)
    assert len(twists) == pytest.approx(0.8 / 3.0 / STEP_S, abs=2)
    motions = [mount.command(twist) for twist in twists]
    assert max(abs(m.forward_mm_s) + abs(m.lateral_mm_s) for m in motions) < 1e-9
    assert np.diff([m.rotation_rad_s for m in motions]).max() == pytest.approx(3.0 * STEP_S)


@pytest.mark.parametrize(
    ("length_mm", "command", "slowest"),
    [
        (0.0, Command(forward_mm_s=100.0), "tool"),
        (30.0, Command(forward_mm_s=20.0, rotation_rad_s=1.0), "rotation"),
        (400.0, Command(rotation_rad_s=1.0), "tool"),  # a long tool sweeps
        (400.0, Command(forward_mm_s=-100.0, rotation_rad_s=0.1), "fingertip"),
    ],
)
def test_no_acceleration_is_above_its_limit(
    length_mm: float, command: Command, slowest: str
) -> None:
    mount = _mount(length_mm)
    _, twists = _ramped(mount, mount.tool_twist(command), STEP_S)
    changes = np.diff(twists, axis=0) / STEP_S
    fingertip = [mount.command(c) for c in changes]
    found = {
        "tool": np.linalg.norm(changes[:, :3], axis=1).max() * 1000.0 / 500.0,
        "fingertip": max(np.hypot(m.forward_mm_s, m.lateral_mm_s) for m in fingertip) / 500.0,
        "rotation": np.linalg.norm(changes[:, 3:], axis=1).max() / 3.0,
    }
    assert max(found.values()) == found[slowest] == pytest.approx(1.0)


def test_a_new_wish_on_the_way_goes_on_from_there() -> None:
    mount = _mount(80.0)
    ramp = Ramp(LIMITS, mount)
    halfway = ramp.toward(mount.tool_twist(Command(forward_mm_s=100.0)), 0.1)
    assert mount.command(halfway).forward_mm_s == pytest.approx(50.0)
    back = ramp.toward(np.zeros(6), 0.04)
    assert mount.command(back).forward_mm_s == pytest.approx(30.0)
    assert not ramp.toward(np.zeros(6), 0.5).any()
