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
        self._slowing = 0.0

    def monotonic(self) -> float:
        return self.now_s

    def sleep(self, seconds: float) -> None:
        self.now_s += seconds
        for axes in (slice(3), slice(3, 6)):
            size = float(np.linalg.norm(self.twist[axes]))
            left = max(0.0, size - self._slowing * seconds)
            self.twist[axes] *= left / size if size else 0.0

    def speedL(self, twist: list[float], acceleration: float, _: float) -> bool:  # noqa: N802
        assert not any(twist)
        self._slowing = acceleration
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


def _braked(monkeypatch: pytest.MonkeyPatch, limits: ArmLimits, twist: list[float]) -> _Arm:
    """An arm that moves and is closed; the time starts with the braking."""
    arm = _Arm(twist)
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
    mount = Mount(x=(1, 0, 0), y=(0, 0, 1))
    ur_process.Driver(parent, "127.0.0.1", 1.0, mount, limits).run()
    return arm


@pytest.mark.parametrize(
    ("limits", "twist", "seconds"),
    [
        (ArmLimits(), [0.1, 0.0, 0.0, 0.0, 0.0, 0.0], 0.2),
        (ArmLimits(), [0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 2.0),
        (ArmLimits(), [0.1, 0.0, 0.0, 0.0, 1.0, 0.0], 2.0),
        (ArmLimits(speed_mm_s=250.0, acceleration_mm_s2=50.0), [0.39, 0, 0, 0, 0, 0.1], 7.8),
        (ArmLimits(rotation_rad_s=2.0, acceleration_mm_s2=50.0), [0, 0, 0, 0, 0, 3.0], 60.0),
    ],
)
def test_it_is_braked_until_it_stands(
    monkeypatch: pytest.MonkeyPatch, limits: ArmLimits, twist: list[float], seconds: float
) -> None:
    arm = _braked(monkeypatch, limits, twist)
    assert arm.stands_at == [True]
    assert arm.now_s - 100.0 == pytest.approx(seconds, abs=0.1)
    assert arm.ends_in_s[-1] > seconds + 2.0  # whatever hangs afterwards ends, too
