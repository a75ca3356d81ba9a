"""`URArm`: a Universal Robots arm through RTDE, with ur_rtde (extra `[ur]`).

A process of its own (`ur_process`) drives the arm and stops it for any reason of `WHY`. A stop is
final: somebody must look at the arm and open it again.
"""

import json
import logging
import signal
import subprocess
import threading
import time
from contextlib import suppress
from dataclasses import asdict
from types import TracebackType
from typing import Any

import numpy as np

from lumitip import arguments, child_process
from lumitip.control import Command
from lumitip.errors import MissingExtra
from lumitip.robots.guard import ArmLimits, ArmStopped
from lumitip.robots.mount import ArmError, Mount, in_tool

_LONGEST_S = 600.0
_AHEAD_S = 0.1  # `Frame.t` is later than its arrival by 0.05 s, or a period of a legacy device
_UNOPENED_S = 5.0  # an arm that was not opened does not move; its process may be killed
_SIGNALS = {-number: number.name for number in signal.Signals}
_log = logging.getLogger(__name__)


class URArm:
    """An open arm, which stands still until its first command. Thread-safe."""

    def __init__(
        self, host: str, mount: Mount, limits: ArmLimits | None = None, timeout: float = 5.0
    ) -> None:
        """Connect, send the controller its script and set the watchdog; nothing moves yet.

        The arm must be on, in remote control and free to move, with payload and tool centre point
        set.

        Args:
            host: address of the controller.
            mount: of the fingertip on the tool.
            limits: of speed, force and travel.
            timeout: to find the controller (s).

        Raises:
            MissingExtra: if ur_rtde is not installed.
            ArmError: if the controller does not answer or does not run the script, if ur_rtde
                fails, or an argument is invalid.
        """
        self.host = arguments.instance(host, str, "host", ArmError)
        self.mount = arguments.instance(mount, Mount, "mount", ArmError)
        limits = ArmLimits() if limits is None else limits
        self.limits = arguments.instance(limits, ArmLimits, "limits", ArmError)
        within_s = arguments.number(timeout, "timeout", most=_LONGEST_S, above=0.0, error=ArmError)
        self._stop: ArmStopped | None = None
        self._lock = threading.Lock()  # of the process's input
        self._process = _started()
        try:
            place = {name: [float(v) for v in axis] for name, axis in asdict(mount).items()}
            limits_of = asdict(self.limits)
            self._say(host=host, timeout_s=within_s, mount=place, limits=limits_of)
            self._state = self._first_state()
            # No daemon: any program that ends waits until the arm stands still.
            self._thread = threading.Thread(target=self._listen, name="lumitip-ur")
            self._thread.start()
        except BaseException:
            self._end(_UNOPENED_S)
            raise

    @property
    def stopped(self) -> str:
        """Reason of the stop, a key of `WHY`; empty while the arm takes commands."""
        return self._stop.reason if self._stop else ""

    def __repr__(self) -> str:
        return f"<URArm {self.host}: {self.stopped or 'takes commands'}, {self.limits!r}>"

    def move(self, command: Command, seen_s: float) -> None:
        """Set the command; it holds until the next one, or until the frame is too old. Returns at
        once; a command to stop waits until the arm stands.

        Args:
            command: of the tracer; too fast ones are slowed down as a whole.
            seen_s: time of the frame behind the command, `Frame.t` (s).

        Raises:
            ArmStopped: if the arm was stopped before, with the reason.
            ArmError: if a velocity or the time is no number, or the time is in the future; leave
                the `with` block then.
        """
        self._require_open()
        arguments.finite_fields(arguments.instance(command, Command, "command", ArmError), ArmError)
        seen_s = arguments.number(seen_s, "seen_s", error=ArmError)
        now_s = time.monotonic()
        if seen_s > now_s + _AHEAD_S and command.state != "stop":
            raise ArmError(
                f"seen_s is {seen_s:.2f}, {seen_s - now_s:.2f} s in the future; at most "
                f"{_AHEAD_S:g} s is allowed, by time.monotonic() of this computer. Pass the "
                "frame's arrival frame.t_host, or min(frame.t, frame.t_host)"
            )
        # A time in the future would let a frame move the arm for longer than `stale_s`.
        self._say(command=asdict(command), seen_s=min(seen_s, now_s))
        if command.state == "stop":
            self._thread.join()

    def measured(self) -> Command:
        """Motion of the fingertip now, as reported by the arm's controller.

        Raises:
            ArmStopped: if the arm was stopped: no states arrive then.
        """
        self._require_open()
        pose, twist = self._state
        return self.mount.command(in_tool(pose, twist))

    def close(self) -> None:
        """Stop the arm, wait until it stands still, and disconnect. May be called repeatedly."""
        self._hang_up()
        self._thread.join()

    def _require_open(self) -> None:
        if self._stop:
            raise self._stop.with_traceback(None)

    def _first_state(self) -> tuple[Any, Any]:
        assert self._process.stdout
        answer = json.loads(self._process.stdout.readline() or "null")
        if answer is None:
            raise ArmError(
                f"host is {self.host}; {self._crash()} while it connected. Look at what it "
                "printed, and try again"
            )
        if "missing" in answer:
            raise MissingExtra("ur", "a UR arm")
        if "failed" in answer:
            raise ArmError(answer["failed"])
        return _state(answer)

    def _listen(self) -> None:
        """Take what the process says, at the rate of the arm's states, until it has ended."""
        assert self._process.stdout
        try:
            for line in self._process.stdout:
                self._take(json.loads(line))
                if not threading.main_thread().is_alive():
                    self._hang_up()
        finally:
            self._end()
            if not self._stop:
                self._set_stop("connection", f"{self._crash()}; the watchdog stops the arm")
            elif self._process.returncode:
                _log.warning("%s while stopping; the watchdog stops the arm", self._crash())

    def _take(self, message: dict[str, Any]) -> None:
        if "pose" in message:
            self._state = _state(message)
        elif "stopped" in message:
            if message["trace"]:
                _log.debug("reason of the stop: %s", message["trace"])
            self._set_stop(message["stopped"], message["detail"])
        else:
            _log.warning("%s", message["warning"])

    def _set_stop(self, reason: str, detail: str) -> None:
        self._stop = ArmStopped(reason, detail)
        _log.log(logging.INFO if reason == "closed" else logging.WARNING, "%s", self._stop)

    def _crash(self) -> str:
        """How the process of ur_rtde ended without a word."""
        code = self._process.wait()
        return f"ur_rtde crashed or hung ({_SIGNALS.get(code, f'exit code {code}')})"

    def _say(self, **message: object) -> None:
        """Send a line to the process, unless it has ended: `_listen` finds out why."""
        assert self._process.stdin
        with self._lock, suppress(BrokenPipeError):
            if not self._process.stdin.closed:
                self._process.stdin.write(json.dumps(message) + "\n")
                self._process.stdin.flush()

    def _hang_up(self) -> None:
        """Let the process stop the arm and end."""
        # Closing is not enough where a process that this one forked holds the pipe open.
        self._say(close=True)
        assert self._process.stdin
        with self._lock, suppress(BrokenPipeError):
            self._process.stdin.close()

    def _end(self, within_s: float | None = None) -> None:
        """Let the process end, and wait for it; kill it then."""
        assert self._process.stdout
        self._hang_up()
        try:
            self._process.wait(within_s)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._process.stdout.close()

    def __enter__(self) -> "URArm":
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        self.close()


def _started() -> "subprocess.Popen[str]":
    try:
        return child_process.start("lumitip.robots.ur_process")
    except OSError as problem:
        raise ArmError(f"the process that drives the arm does not start: {problem}") from None


def _state(message: dict[str, Any]) -> tuple[Any, Any]:
    """Pose and twist of the tool centre point in the base, each `(6,)`."""
    return np.array(message["pose"]), np.array(message["twist"])
