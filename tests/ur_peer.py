"""A stand-in for a UR arm's controller, in a process of its own, on an address of its own."""

import functools
import inspect
import json
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import Any

import pytest

from lumitip.control import Command
from lumitip.robots import ArmError, ArmLimits, ArmStopped, Mount, URArm

MOUNT = Mount(x=(1, 0, 0), y=(0, 0, 1), origin_mm=(0.0, 0.0, 80.0))
# A machine with more to do than it can must not look like a lost sensor here.
CALM = ArmLimits(stale_s=0.5, watchdog_hz=2.0)
STAND_IN = Path(__file__).with_name("ur_stand_in.py")
_numbers = count(1)
WAIT_S = 20.0


class Peer:
    """A running stand-in: what it told, and a way to do it mischief."""

    def __init__(self) -> None:
        pid = os.getpid()
        self.host = f"127.{pid >> 8 & 255}.{pid & 255}.{next(_numbers) % 250 + 2}"
        self._process = subprocess.Popen(
            [sys.executable, str(STAND_IN), self.host],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self.events: list[dict[str, Any]] = []
        self._told = threading.Condition()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        self.wait("listens")

    def _read(self) -> None:
        assert self._process.stdout
        for line in self._process.stdout:
            with self._told:
                self.events.append(json.loads(line))
                self._told.notify_all()

    def of(self, name: str) -> list[dict[str, Any]]:
        """The events of a name so far."""
        with self._told:
            return [e for e in self.events if e["event"] == name]

    def wait(self, name: str, number: int = 1) -> dict[str, Any]:
        """The first event of a name, or a later one, once it came."""
        with self._told:
            found = self._told.wait_for(
                lambda: [e for e in self.events if e["event"] == name][number - 1 :], WAIT_S
            )
        assert found, f"no {name!r} came: {self.events[-5:]}"
        return dict(found[0])

    def does(self, mishap: str) -> None:
        """Let something happen to the arm."""
        assert self._process.stdin
        self._process.stdin.write(mishap + "\n")
        self._process.stdin.flush()

    def order(self) -> list[str]:
        """Names of the events, each once, in the order in which they first came."""
        with self._told:
            return list(dict.fromkeys(e["event"] for e in self.events))

    def end(self) -> None:
        """Let it end by itself."""
        assert self._process.stdin and self._process.stdout
        self._process.stdin.close()
        try:
            self._process.wait(WAIT_S)
        except subprocess.TimeoutExpired:  # on a machine too busy for it: it would slow the next
            self._process.kill()
            self._process.wait()
        self._reader.join(WAIT_S)
        self._process.stdout.close()


def follow(arm: URArm, command: Command, seconds: float) -> None:
    """Give an arm a command with fresh frames for a time."""
    until_s = time.monotonic() + seconds
    while time.monotonic() < until_s:
        arm.move(command, time.monotonic())
        time.sleep(0.01)


def until_stopped(arm: URArm, command: Command | None, most_s: float = 15.0) -> str:
    """Give an arm a command, or none, until it is stopped: the reason."""
    until_s = time.monotonic() + most_s
    with pytest.raises(ArmStopped) as stopped:
        while time.monotonic() < until_s:
            if command or arm.stopped:
                arm.move(command or Command(), time.monotonic())
            time.sleep(0.01)
    return stopped.value.reason


def patient(test: Callable[..., None]) -> Callable[..., None]:
    """Run a test with a `peer`; again with another one if it failed while the machine was so busy
    that threads stood still: an arm is rightly stopped by that. A program that a test starts may
    stand still where this one does not: more work than cores counts too."""

    @functools.wraps(test)
    def run(**given: Any) -> None:
        for left in reversed(range(_ATTEMPTS)):
            peer = Peer()
            watch = _Watch()
            try:
                test(peer=peer, **given)
                return
            except (AssertionError, ArmError, subprocess.TimeoutExpired):
                starved = max(watch.longest_s, *_late_s(peer)) >= _STARVED_S
                if not left or not (starved or os.getloadavg()[0] > (os.cpu_count() or 1)):
                    raise
            finally:
                watch.end()
                peer.end()

    signature = inspect.signature(test)
    kept = [p for name, p in signature.parameters.items() if name != "peer"]
    run.__signature__ = signature.replace(parameters=kept)  # type: ignore[attr-defined]
    return run


_ATTEMPTS = 6
_STARVED_S = 0.1


def _late_s(peer: Peer) -> list[float]:
    return [0.0, *(e["seconds"] for e in peer.of("late"))]


class _Watch:
    """How long a thread that wants to run every 10 ms stood still at most (s)."""

    def __init__(self) -> None:
        self.longest_s = 0.0
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        before_s = time.monotonic()
        while not self._ended.wait(0.01):
            now_s = time.monotonic()
            self.longest_s, before_s = max(self.longest_s, now_s - before_s), now_s

    def end(self) -> None:
        self._ended.set()
        self._thread.join()
