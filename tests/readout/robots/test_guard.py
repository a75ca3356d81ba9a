"""Limits that are refused, commands that are slowed down, and every reason to stop."""

from dataclasses import replace

import numpy as np
import pytest

from lumitip.robots import ArmError, ArmLimits, ArmState, ArmStopped, Guard, Mount
from lumitip.robots.guard import WHY

MOUNT = Mount(x=(1, 0, 0), y=(0, 0, 1), origin_mm=(0.0, 0.0, 100.0))
FIRST = ArmState(
    time_s=50.0,
    pose=np.array([0.4, 0.0, 0.3, 0.0, 0.0, 0.0]),
    twist=np.zeros(6),
    force_n=np.array([1.0, 2.0, -8.0]),
)


def _reason(later_s: float = 0.01, seen_s: float | None = 0.0, **changes: object) -> str:
    guard = Guard(ArmLimits(), MOUNT, FIRST, 0.0)
    told: dict[str, object] = {"time_s": 50.0 + later_s, **changes}
    state = replace(FIRST, **told)  # type: ignore[arg-type]
    return guard.reason(state, later_s, seen_s)[0]


def test_an_arm_within_its_limits_goes_on() -> None:
    assert _reason() == ""
    assert _reason(later_s=9.0, seen_s=None) == ""  # before the first command
    assert _reason(later_s=9.0, seen_s=8.95) == ""
    assert _reason(force_n=np.array([1.0, 2.0, 20.0])) == ""
    assert _reason(twist=np.array([0.16, 0, 0, 0, 0, 0])) == ""
    assert _reason(twist=np.array([0, 0, 0, 0, 0, 1.5])) == ""


@pytest.mark.parametrize(
    ("reason", "changes"),
    [
        ("emergency", {"emergency": True, "protective": True, "runs": False}),
        ("protective", {"protective": True, "runs": False}),
        ("connection", {"connected": False}),
        ("connection", {"later_s": 0.2, "seen_s": 0.2, "time_s": 50.0}),
        ("program", {"runs": False}),
        ("stale", {"later_s": 0.2}),
        ("force", {"force_n": np.array([1.0, 2.0, 23.0])}),
        ("force", {"force_n": np.array([np.nan, 0.0, 0.0])}),
        ("speed", {"twist": np.array([0.0, 0.2, 0, 0, 0, 0])}),
        ("speed", {"twist": np.array([0.0, 0.0, 0, 0, 0, 1.7])}),
        ("speed", {"twist": np.array([0.0, 0.0, 0, 0, 0, np.nan])}),
        ("travel", {"pose": np.array([0.4, 0.0, -0.01, 0, 0, 0])}),
        ("travel", {"pose": np.array([np.nan, 0.0, 0.3, 0, 0, 0])}),
        ("turn", {"pose": np.array([0.4, 0.0, 0.3, 0, 0, 2.2])}),
    ],
)
def test_every_reason_to_stop(reason: str, changes: dict[str, object]) -> None:
    assert _reason(**changes) == reason  # type: ignore[arg-type]
    assert reason in WHY and WHY[reason] in str(ArmStopped(reason))


def test_travel_is_of_the_fingertip_not_of_the_tool() -> None:
    # Half a turn about x takes the fingertip 200 mm away while the tool stays.
    guard = Guard(ArmLimits(travel_mm=150.0, turn_deg=170.0), MOUNT, FIRST, 0.0)
    turned = replace(FIRST, time_s=50.01, pose=np.array([0.4, 0.0, 0.3, 2.9, 0.0, 0.0]))
    assert guard.reason(turned, 0.01, 0.0)[0] == "travel"


def _speed(limits: ArmLimits, twist: list[float], turn: float = 0.0) -> tuple[str, str]:
    first = replace(FIRST, pose=np.array([0.4, 0.0, 0.3, turn, 0.0, 0.0]))
    guard = Guard(limits, MOUNT, first, 0.0)
    return guard.reason(replace(first, time_s=50.01, twist=np.array(twist)), 0.01, 0.0)


def test_a_rotation_faster_than_its_limit_is_a_reason_to_stop() -> None:
    limits = ArmLimits(rotation_rad_s=0.2)
    assert _speed(limits, [0, 0, 0, 0, 0, 0.39]) == ("", "")
    assert _speed(limits, [0, 0, 0, 0, 0, 5.0]) == ("speed", "5.0 rad/s, 0.2 allowed")


def test_speed_is_of_the_fingertip_too() -> None:
    limits = ArmLimits(speed_mm_s=10.0, rotation_rad_s=2.0)
    expected = ("speed", "200 mm/s, 10 allowed")
    assert _speed(limits, [0, 0, 0, 0, 2.0, 0]) == expected
    # With the tool turned by a quarter about x the fingertip is at -y of the tool centre point.
    assert _speed(limits, [0, 0, 0, 0, 0, 2.0], np.pi / 2) == expected
    assert _speed(limits, [0, 0, 0, 0, 2.0, 0], np.pi / 2) == ("", "")
    # The tool goes around the fingertip, which stands still.
    around = ArmLimits(speed_mm_s=120.0, rotation_rad_s=2.0)
    assert _speed(around, [-0.19, 0, 0, 0, 1.9, 0]) == ("", "")


def test_fast_commands_are_slowed_down_as_a_whole() -> None:
    limits = ArmLimits(speed_mm_s=100.0, rotation_rad_s=1.0)
    assert limits.share(50.0, 0.5) == 1.0
    assert limits.share(200.0, 0.5) == pytest.approx(0.5)
    assert limits.share(200.0, 4.0) == pytest.approx(0.25)
    assert limits.share(0.0, 0.0) == 1.0


def test_absurd_limits_are_refused_all_at_once() -> None:
    with pytest.raises(ArmError) as refused:
        ArmLimits(speed_mm_s=900.0, force_n=-1.0, stale_s=float("nan"), watchdog_hz=1.0)
    told = str(refused.value)
    assert "speed_mm_s is 900.0; allowed is above 0 up to 250 (the reduced speed" in told
    assert "force_n is -1.0" in told and "stale_s is nan" in told
    assert "watchdog_hz is 1.0; allowed is 2 to 50" in told
    assert ArmLimits(speed_mm_s=250.0, watchdog_hz=2.0).acceleration_mm_s2 == 500.0
