"""`URArm` as the program uses it, over a process that only plays the one of ur_rtde."""

import subprocess
import sys
from collections.abc import Iterator

import pytest

from lumitip.control import Command
from lumitip.robots import ArmStopped, Mount, URArm, ur

PLAYS = """
import sys
print('{"pose": [0, 0, 0, 0, 0, 0], "twist": [0.03, 0, 0, 0, 0, 0]}', flush=True)
for line in sys.stdin:
    if '"close"' in line or '"stop"' in line:
        reason = "closed" if '"close"' in line else "lost"
        print('{"stopped": "%s", "detail": "", "trace": ""}' % reason, flush=True)
        break
"""


def _plays() -> "subprocess.Popen[str]":
    pipe = subprocess.PIPE
    return subprocess.Popen([sys.executable, "-c", PLAYS], stdin=pipe, stdout=pipe, text=True)


@pytest.fixture
def arm(monkeypatch: pytest.MonkeyPatch) -> Iterator[URArm]:
    monkeypatch.setattr(ur, "_started", _plays)
    with URArm("127.0.0.1", Mount(x=(1, 0, 0), y=(0, 0, 1))) as opened:
        yield opened


def test_an_arm_that_was_stopped_has_no_measured_motion(arm: URArm) -> None:
    assert arm.measured().forward_mm_s == pytest.approx(30.0)
    arm.move(Command(state="stop", reason="lost"), 0.0)
    with pytest.raises(ArmStopped, match="the tracer lost the line"):
        arm.measured()
