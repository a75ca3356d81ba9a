"""How an arm is braked, over an arm and a clock that are simulated here."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lumitip.control import Command
from lumitip.robots import ArmLimits, Mount, ur_process


class _Arm:
    """Both interfaces of ur_rtde; `speedl` counts its acceleration in rad/s² for a rotation."""

    def __init__(self, twist: list[float]) -> None:
        self.twist, self.now_s = np.array(twist), 100.0
        self.stands_at: list[bool] = []
        self.ends_in_s: list[float] = []
        self.sent: list[np.ndarray] = []
        self._acceleration = 0.0

    def monotonic(self) -> float:
        return self.now_s

    def sleep(self, seconds: float) -> None:
        self.now_s += seconds
        for axes in (slice(3), slice(3, 6)):
            change = (self.sent[-1] - self.twist)[axes]
            size = float(np.linalg.norm(change))
            most = self._acceleration * seconds
            self.twist[axes] += change * (min(1.0, most / size) if size else 0.0)

    def speedL(self, twist: list[float], acceleration: float, _: float) -> bool:  # noqa: N802
        self.sent.append(np.array(twist))
        self._acceleration = acceleration
        return True

    def speedStop(self, _: float) -> None:  # noqa: N802
        self.stands_at.append(float(np.abs(self.twist).max()) < 2e-3)

    def __getattr__(self, name: str) -> Any:
        answers = {
            "getTimestamp": self.now_s,
            "getActualTCPPose": [0.4, 0.0, 0.3, 0.0, 0.0, 0.0],
            "getActualTCPSpeed": self.twist.tolist(),
            "getActualTCPForce": [0.0] * 6,
            "getRuntimeState": 2,
            "isProtectiveStopped": False,
            "isEmergencyStopped": False,
        }
        return lambda *_: answers.get(name, True)


MOUNT = Mount(x=(1, 0, 0), y=(0, 0, 1), origin_mm=(0.0, 0.0, 80.0))
SLOW = ArmLimits(speed_mm_s=250.0, rotation_rad_s=2.0, acceleration_mm_s2=50.0, rotation_rad_s2=0.5)


def _braked(monkeypatch: pytest.MonkeyPatch, limits: ArmLimits, command: Command) -> _Arm:
    """An arm that follows a command and is closed; the time starts with the braking."""
    twist = MOUNT.tool_twist(command)
    arm = _Arm(twist.tolist())
    monkeypatch.setattr(ur_process, "_connected", lambda *_: (arm, arm))
    monkeypatch.setattr(ur_process, "_open_nothing_more", lambda: None)
    monkeypatch.setattr(ur_process, "_end_in", arm.ends_in_s.append)
    monkeypatch.setattr(ur_process, "time", arm)
    parent: Any = SimpleNamespace(
        asked=(Command(state="stop"), arm.now_s),
        gone_within=lambda _: False,
        say=lambda **_: None,
        show=lambda _: None,
    )
    driver = ur_process.Driver(parent, "127.0.0.1", 1.0, MOUNT, limits)
    driver._ramp.twist = twist
    driver.run()
    return arm


@pytest.mark.parametrize(
    ("limits", "command", "seconds"),
    [
        (ArmLimits(), Command(forward_mm_s=100.0), 0.2),
        (ArmLimits(), Command(rotation_rad_s=1.0), 1.0 / 3.0),
        (ArmLimits(), Command(forward_mm_s=100.0, rotation_rad_s=1.0), 1.0 / 3.0),
        (SLOW, Command(forward_mm_s=250.0, rotation_rad_s=0.1), 5.15),  # the tool: 258 mm/s
        (SLOW, Command(rotation_rad_s=2.0), 4.0),
    ],
)
def test_it_is_braked_until_it_stands(
    monkeypatch: pytest.MonkeyPatch, limits: ArmLimits, command: Command, seconds: float
) -> None:
    arm = _braked(monkeypatch, limits, command)
    assert arm.stands_at == [True]
    assert arm.now_s - 100.0 == pytest.approx(seconds, abs=0.1)
    assert arm.ends_in_s[-1] > seconds + 2.0  # whatever hangs afterwards ends, too


def test_the_fingertip_keeps_its_direction_while_it_is_braked(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    command = Command(forward_mm_s=50.0, lateral_mm_s=-20.0, rotation_rad_s=0.5)
    arm = _braked(monkeypatch, ArmLimits(), command)
    for twist in arm.sent:
        left = MOUNT.command(twist)
        share = left.forward_mm_s / 50.0
        assert 0.0 <= share < 1.0
        assert left.lateral_mm_s == pytest.approx(-20.0 * share)
        assert left.rotation_rad_s == pytest.approx(0.5 * share)


def test_the_time_to_brake_is_that_of_the_slower_part() -> None:
    assert SLOW.braking_s(1.0) == pytest.approx(5.0)
    turning = ArmLimits(speed_mm_s=10.0, rotation_rad_s=2.0, rotation_rad_s2=0.5)
    assert turning.braking_s(2.0) == pytest.approx(8.0)
