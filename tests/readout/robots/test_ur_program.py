"""`URArm` as the program uses it, over a process that only plays the one of ur_rtde."""

import runpy
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

from lumitip.control import Command
from lumitip.robots import ArmError, ArmStopped, Mount, URArm, ur

PLAYS = """
import sys
print('{"pose": [0, 0, 0, 0, 0, 0], "twist": [0.03, 0, 0, 0, 0, 0]}', flush=True)
for line in sys.stdin:
    if '"close"' in line or '"stop"' in line:
        reason = "closed" if '"close"' in line else "lost"
        print('{"stopped": "%s", "detail": "", "trace": ""}' % reason, flush=True)
        break
"""


STOPS = PLAYS.replace(
    "for line in sys.stdin:",
    """for number, line in enumerate(sys.stdin):
    if number == 20:
        print('{"stopped": "lost", "detail": "", "trace": ""}', flush=True)
        break""",
)


def _plays(program: str = PLAYS) -> "subprocess.Popen[str]":
    pipe = subprocess.PIPE
    return subprocess.Popen([sys.executable, "-c", program], stdin=pipe, stdout=pipe, text=True)


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


@pytest.mark.slow
def test_the_example_says_why_the_arm_was_stopped(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(ur, "_started", partial(_plays, STOPS))
    monkeypatch.setattr(sys, "argv", ["trace_cable_ur.py", "127.0.0.1", "40"])
    runpy.run_path(str(Path(__file__).parents[3] / "examples/trace_cable_ur.py"))
    why, travelled, errors = capsys.readouterr().out.splitlines()
    assert why.startswith("the arm was stopped: the tracer lost the line")
    assert travelled.startswith("lost after ") and travelled.endswith("arm: lost")
    assert errors.startswith("lateral ")


def test_a_frame_of_the_future_does_not_move_it(arm: URArm) -> None:
    moves = Command(forward_mm_s=30.0)
    arm.move(moves, time.monotonic() + 0.05)  # as `Frame.t` may be after a stall
    with pytest.raises(ArmError, match=r"60\.\d\d s in the future; at most 0\.1 s.*frame\.t_host"):
        arm.move(moves, time.monotonic() + 60.05)
    assert arm.stopped == ""


def test_a_stop_is_taken_whatever_its_time_is(arm: URArm) -> None:
    arm.move(Command(state="stop", reason="lost"), time.monotonic() + 60.0)
    assert arm.stopped == "lost"
