"""The process that drives an arm: programs that are killed, and an ur_rtde that crashes."""

import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from lumitip.control import Command
from lumitip.errors import MissingExtra
from lumitip.robots import ArmError, ArmStopped, URArm
from ur_peer import CALM, MOUNT, Peer, follow, patient, until_stopped

pytestmark = pytest.mark.slow

OPENS = """
import os, sys, time
from lumitip.control import Command
from lumitip.robots import ArmLimits, Mount, URArm
arm = URArm(sys.argv[1], Mount((1, 0, 0), (0, 0, 1)), ArmLimits(stale_s=0.5, watchdog_hz=4.0))
"""
FORKS = """
if os.fork() == 0:
    os.close(2)
    time.sleep(60.0)  # holds the pipes of its parent open
    os._exit(0)
"""
MOVES = """
with arm:
    while True:
        arm.move(Command(forward_mm_s=30.0), time.monotonic())
        time.sleep(0.01)
"""
FORGETS = """
for _ in range(50):
    arm.move(Command(forward_mm_s=30.0), time.monotonic())
    time.sleep(0.01)
"""


@contextmanager
def _running(code: str, peer: Peer) -> "Iterator[subprocess.Popen[str]]":
    """A program in a group of its own, which is killed in the end."""
    with subprocess.Popen(
        [sys.executable, "-c", code, peer.host],
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as program:
        try:
            yield program
        finally:
            with suppress(ProcessLookupError):
                os.killpg(program.pid, signal.SIGKILL)


@pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
@patient
def test_it_brakes_when_the_program_is_interrupted_or_killed(
    peer: Peer, by: signal.Signals
) -> None:
    with _running(OPENS + MOVES, peer) as program:
        peer.wait("speedl", 20)
        os.killpg(program.pid, by)
        assert peer.wait("program ended")["why"] == "script"
        assert peer.order().index("stands") < peer.order().index("program ended")
        _, errors = program.communicate(timeout=30.0)
        assert ("KeyboardInterrupt" in errors) == (by is signal.SIGINT)


@patient
def test_it_brakes_when_the_program_stands_still(peer: Peer) -> None:
    with _running(OPENS + MOVES, peer) as program:
        peer.wait("speedl", 20)
        program.send_signal(signal.SIGSTOP)
        assert peer.wait("program ended")["why"] == "script"
        program.send_signal(signal.SIGCONT)
        _, errors = program.communicate(timeout=30.0)
        assert "no fresh frame came" in errors and "0.5 allowed" in errors


@patient
def test_states_that_nobody_reads_do_not_stop_it(peer: Peer) -> None:
    """A pipe holds two seconds of them."""
    with _running(OPENS + "time.sleep(60.0)", peer) as program:
        peer.wait("watchdog")
        time.sleep(0.5)
        program.send_signal(signal.SIGSTOP)
        time.sleep(5.0)
        assert not peer.of("program ended")
        program.send_signal(signal.SIGCONT)
        time.sleep(0.5)  # a thread that stands may not be woken: another one would get the signal
        program.send_signal(signal.SIGINT)
        assert peer.wait("program ended")["why"] == "script"


@patient
def test_a_program_that_ends_without_closing_it_waits_until_it_stands(peer: Peer) -> None:
    with _running(OPENS + FORKS + FORGETS, peer) as program:
        _, errors = program.communicate(timeout=30.0)
        assert program.returncode == 0 and errors == ""
        assert peer.wait("program ended")["why"] == "script" and peer.of("stands")


@patient
def test_it_ends_when_a_killed_program_leaves_others_behind(peer: Peer) -> None:
    with _running(OPENS + FORKS + "time.sleep(60.0)", peer) as program:
        peer.wait("watchdog")
        time.sleep(0.5)
        program.kill()
        assert peer.wait("program ended")["why"] == "script"
        assert program.communicate(timeout=30.0)[1] == ""


@pytest.mark.parametrize("by", [signal.SIGSEGV, signal.SIGKILL])
@patient
def test_a_crash_of_ur_rtde_ends_the_arm_alone(peer: Peer, by: signal.Signals) -> None:
    with URArm(peer.host, MOUNT, CALM) as arm:
        follow(arm, Command(forward_mm_s=30.0), 0.3)
        os.kill(arm._process.pid, by)
        assert until_stopped(arm, Command(forward_mm_s=30.0)) == "connection"
        with pytest.raises(ArmStopped, match=f"ur_rtde crashed or hung .{by.name}.; the watchdog"):
            arm.move(Command(), time.monotonic())
    assert peer.wait("program ended")["why"] == "watchdog"
    assert peer.wait("stands")


HANGS = """
import ctypes
import sys
if sys.argv[0] == "-m":
    import rtde_control
    class Hanging(rtde_control.RTDEControlInterface):
        def speedL(self, *_):
            ctypes.PyDLL(None).pause()  # and no other Python thread runs
    rtde_control.RTDEControlInterface = Hanging
"""


@patient
def test_a_call_of_ur_rtde_that_hangs_ends_the_arm_alone(
    peer: Peer, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "sitecustomize.py").write_text(HANGS)
    monkeypatch.syspath_prepend(str(tmp_path))
    with URArm(peer.host, MOUNT, CALM) as arm:
        assert until_stopped(arm, Command(forward_mm_s=30.0)) == "connection"
        with pytest.raises(ArmStopped, match=r"hung .exit code 1.; the watchdog"):
            arm.move(Command(), time.monotonic())
    assert peer.wait("program ended")["why"] == "watchdog"


PRINTS = """
import os, sys
if sys.argv[0] == "-m":
    import rtde_control
    class Printing(rtde_control.RTDEControlInterface):
        def speedL(self, *values):
            os.write(1, b"Printed by C++")
            return super().speedL(*values)
    rtde_control.RTDEControlInterface = Printing
"""


@patient
def test_prints_of_ur_rtde_go_to_stderr(
    peer: Peer,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
) -> None:
    (tmp_path / "sitecustomize.py").write_text(PRINTS)
    monkeypatch.syspath_prepend(str(tmp_path))
    with URArm(peer.host, MOUNT, CALM) as arm:
        follow(arm, Command(forward_mm_s=30.0), 0.3)
        assert arm.stopped == ""
    assert "Printed by C++" in capfd.readouterr().err


@patient
def test_a_crash_while_it_connects_is_one_clear_error(
    peer: Peer, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "rtde_control.py").write_text("import os; os.abort()")
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(ArmError, match=r"^host is .*; ur_rtde crashed or hung .SIGABRT. while it"):
        URArm(peer.host, MOUNT, CALM)


def test_a_controller_that_never_answers_can_be_interrupted() -> None:
    with socket.create_server(("127.0.0.78", 30004)):
        begun_s = time.monotonic()
        threading.Timer(2.0, os.kill, [os.getpid(), signal.SIGINT]).start()
        with pytest.raises(KeyboardInterrupt):
            URArm("127.0.0.78", MOUNT, CALM)
        assert time.monotonic() - begun_s < 20.0


def test_without_ur_rtde_it_tells_what_to_install(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "rtde_control.py").write_text("raise ImportError")
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(MissingExtra, match=r"'\.\[ur\]'"):
        URArm("127.0.0.77", MOUNT)
