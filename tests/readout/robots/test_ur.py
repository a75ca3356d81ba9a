"""ur_rtde's own client against a stand-in that speaks RTDE: motion, limits and every stop."""

import math
import re
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lumitip.control import Command
from lumitip.robots import ArmError, ArmLimits, ArmStopped, URArm
from ur_peer import CALM, MOUNT, Peer, follow, patient, until_stopped

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[3]


def _fingertip(pose: list[float]) -> tuple[np.ndarray, Rotation]:
    turn = Rotation.from_rotvec(pose[3:])
    return np.array(pose[:3]) * 1000.0 + turn.apply([0.0, 0.0, 80.0]), turn


@patient
def test_it_moves_along_the_sensors_axes_and_stands_at_the_end(peer: Peer) -> None:
    with URArm(peer.host, MOUNT, CALM) as arm:
        follow(arm, Command(forward_mm_s=40.0, lateral_mm_s=-15.0), 0.6)
        measured = arm.measured()
    assert (measured.forward_mm_s, measured.lateral_mm_s) == pytest.approx((40, -15), abs=1.0)
    first, last = peer.wait("speedl"), peer.wait("stands")
    begin, turn = _fingertip(first["pose"])
    moved = turn.inv().apply(_fingertip(last["pose"])[0] - begin)
    assert moved[0] > 15.0 and moved[2] / moved[0] == pytest.approx(-15.0 / 40.0, abs=0.02)
    assert abs(moved[1]) < 0.2
    wait_for = ["script", "watchdog", "speedl", "stands", "speed stop", "stop script"]
    assert [n for n in peer.order() if n in wait_for] == wait_for
    assert peer.wait("program ended")["why"] == "script" and arm.stopped == "closed"
    assert peer.wait("watchdog")["hz"] == 2.0
    with pytest.raises(ArmStopped, match="the program closed it"):
        arm.move(Command(), time.monotonic())
    arm.close()


@patient
def test_a_turn_leaves_the_fingertip_where_it_is(peer: Peer) -> None:
    with URArm(peer.host, MOUNT, CALM) as arm:
        follow(arm, Command(rotation_rad_s=0.8), 0.8)
    begin, turned = _fingertip(peer.wait("speedl")["pose"])
    end, turn = _fingertip(peer.wait("stands")["pose"])
    spin = (turned.inv() * turn).as_rotvec()
    assert spin[1] < -0.3 and abs(spin[0]) + abs(spin[2]) < 0.01  # the sensor's z is the tool's -y
    assert np.linalg.norm(end - begin) < 2.0  # the tool itself went about 80 mm times the angle
    assert (
        np.linalg.norm(np.subtract(*(peer.wait(e)["pose"][:3] for e in ("speedl", "stands"))))
        * 1000.0
        > 20.0
    )


@patient
def test_commands_that_are_too_fast_are_slowed_down_as_a_whole(peer: Peer) -> None:
    limits = ArmLimits(speed_mm_s=50.0, rotation_rad_s=0.4, stale_s=0.5, watchdog_hz=2.0)
    with URArm(peer.host, MOUNT, limits) as arm:
        follow(arm, Command(300.0, -400.0, 0.0), 0.4)
        straight = peer.of("speedl")[-1]
        follow(arm, Command(10.0, 0.0, 5.0), 0.4)
        turning = peer.of("speedl")[-1]
    assert np.linalg.norm(straight["twist"][:3]) == pytest.approx(0.050)
    assert straight["acceleration"] == 3.0  # the larger number: of the rotation
    assert np.linalg.norm(turning["twist"][3:]) == pytest.approx(0.4)
    assert np.linalg.norm(turning["twist"][:3]) < 0.050


@patient
def test_it_stands_still_until_its_first_command(peer: Peer) -> None:
    with URArm(peer.host, MOUNT, CALM) as arm:
        time.sleep(1.2)  # longer than frames may be old, and than the watchdog waits
        assert arm.stopped == ""
    assert not [e for e in peer.of("speedl") if any(e["twist"])]


@patient
def test_it_stops_when_no_fresh_frame_comes(peer: Peer) -> None:
    with URArm(peer.host, MOUNT, ArmLimits(stale_s=0.2, watchdog_hz=2.0)) as arm:
        arm.move(Command(forward_mm_s=30.0), time.monotonic())
        assert until_stopped(arm, None) == "stale"
    assert peer.wait("stands") and peer.wait("program ended")["why"] == "script"


@patient
def test_frames_that_claim_to_be_of_later_do_not_move_it_on(peer: Peer) -> None:
    with URArm(peer.host, MOUNT, ArmLimits(stale_s=0.2, watchdog_hz=2.0)) as arm:
        arm.move(Command(forward_mm_s=30.0), time.monotonic())
        with pytest.raises(ArmError, match="in the future"):
            arm.move(Command(forward_mm_s=30.0), time.monotonic() + 60.0)
        assert until_stopped(arm, None) == "stale"


@pytest.mark.parametrize(
    ("mishap", "reason", "why"),
    [
        ("force 60", "force", "script"),
        ("protective", "protective", "protective"),
        ("emergency", "emergency", "emergency"),
        ("pause", "program", "pause"),
        pytest.param("freeze", "connection", "watchdog", marks=pytest.mark.slow),
        ("drop", "connection or error", "watchdog"),  # by who sees it first: reader or sender
        ("cut", "connection or error", "watchdog"),
    ],
)
@patient
def test_it_stops_whatever_happens_to_the_arm(
    peer: Peer, mishap: str, reason: str, why: str
) -> None:
    with URArm(peer.host, MOUNT, CALM) as arm:
        follow(arm, Command(forward_mm_s=20.0), 0.3)
        peer.does(mishap)
        assert until_stopped(arm, Command(forward_mm_s=20.0)) in reason.split(" or ")
        assert arm.stopped in reason.split(" or ")
    assert peer.wait("program ended")["why"] == why
    assert peer.wait("stands")
    after = peer.events[peer.events.index(peer.wait("stands")) :]
    assert not [e for e in after if e["event"] == "speedl" and any(e["twist"])]


@patient
def test_it_stops_beyond_its_travel(peer: Peer) -> None:
    with URArm(peer.host, MOUNT, ArmLimits(travel_mm=10.0, stale_s=0.5, watchdog_hz=2.0)) as arm:
        assert until_stopped(arm, Command(forward_mm_s=40.0)) == "travel"


@patient
def test_a_tracer_that_stops_waits_until_the_arm_stands(peer: Peer) -> None:
    with URArm(peer.host, MOUNT, CALM) as arm:
        follow(arm, Command(forward_mm_s=40.0), 0.2)
        arm.move(Command(state="stop", reason="lost"), time.monotonic())
        assert arm.stopped == "lost"
        assert peer.wait("program ended")["why"] == "script" and peer.of("stands")


@patient
def test_an_error_in_the_program_stops_it(peer: Peer) -> None:
    with pytest.raises(ZeroDivisionError), URArm(peer.host, MOUNT, CALM) as arm:
        follow(arm, Command(forward_mm_s=40.0), 0.2)
        _ = 1 / 0
    assert peer.of("stands") and peer.wait("program ended")["why"] == "script"


@patient
def test_numbers_that_are_none_are_refused_and_stop_it(peer: Peer) -> None:
    with pytest.raises(ArmError, match="finite number"), URArm(peer.host, MOUNT, CALM) as arm:
        arm.move(Command(forward_mm_s=math.nan), time.monotonic())
    assert arm.stopped == "closed"


def test_no_arm_is_told_in_time() -> None:
    with pytest.raises(ArmError, match="; no arm there takes commands at port 30004"):
        URArm("127.0.0.77", MOUNT, CALM, timeout=2.0)


def test_the_example_says_in_one_line_that_no_arm_answers() -> None:
    done = subprocess.run(
        [sys.executable, "examples/trace_cable_ur.py", "127.0.0.77", "40"],
        capture_output=True,
        text=True,
        timeout=100,
        cwd=ROOT,
        check=False,
    )
    assert (done.returncode, done.stdout) == (1, "")
    (line,) = done.stderr.splitlines()
    assert "; no arm there takes commands at port 30004" in line


@patient
def test_the_example_traces_a_simulated_cable_with_the_arm(peer: Peer) -> None:
    done = subprocess.run(
        [sys.executable, "-W", "error", "examples/trace_cable_ur.py", peer.host, "40"],
        capture_output=True,
        text=True,
        timeout=100,
        cwd=ROOT,
        check=False,
    )
    assert done.returncode == 0 and done.stderr == "", done.stderr
    assert done.stdout.startswith("end after ") and "arm: closed" in done.stdout, done.stdout
    told = re.search(r"lateral ([\d.]+) mm rms", done.stdout)
    assert told and float(told[1]) < 3.0
    assert peer.wait("program ended")["why"] == "script" and peer.of("stands")
