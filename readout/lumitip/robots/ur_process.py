"""The process that drives a UR arm: `python -m lumitip.robots.ur_process`.

A process of its own, because ur_rtde (C++) may crash when the connection breaks: its receiving
thread closes the socket while a command is sent. Here that does not end the user's program; and
when that program is killed, this process is left to brake the arm.

Lines of JSON on its input and output, from and to `lumitip.robots.ur` alone:

    in    {"host": "…", "timeout_s": 5.0, "mount": {…}, "limits": {…}}     once
    out   {"pose": […], "twist": […]}          once the arm takes commands, then at `RATE_HZ`
    in    {"command": {…}, "seen_s": 17.25}    of `URArm.move`
    in    {"close": true}                      once; the end of the input is the same
    out   {"stopped": "force", "detail": "…", "trace": "…"}    once, before it brakes
    out   {"warning": "…"}                     of what failed while it brakes

Instead of the first state: {"missing": true} without ur_rtde, or {"failed": "…"}. The process ends
when the arm stands, `_ENDING_MORE_S` after the longest braking at most.

`seen_s` is of `time.monotonic()`, which is one clock for all processes of a computer: Python says
so since 3.5, on macOS since 3.10. It counts from the computer's start, by `CLOCK_MONOTONIC` on
Linux, `mach_absolute_time` on macOS, `GetTickCount64` or `QueryPerformanceCounter` on Windows.

ur_rtde's script repeats the last speed for ever, whatever its time was. Therefore the watchdog of
the controller stops the program if no register is written. ur_rtde would restore a lost connection
by itself, start its script anew, which has no watchdog then, and send the last speed again.
Therefore this process can open no sockets once it is connected; Windows has no limit for that.
"""

import faulthandler
import math
import os
import signal
import socket
import sys
import time
import traceback
from pathlib import Path
from typing import Any

import numpy as np

from lumitip.control import Command
from lumitip.errors import MissingExtra
from lumitip.grid import Floats
from lumitip.robots.guard import ArmLimits, ArmState, Guard
from lumitip.robots.mount import ArmError, Mount, in_base, in_tool
from lumitip.robots.ramp import Ramp
from lumitip.robots.ur_parent import Parent

RATE_HZ = 125.0
"""Rate of commands and states (Hz)."""
_PORT = 30004
_PLAYING = 2  # RTDE's runtime_state; ur_rtde has no name for it in Python
_VARIABLES = [
    "timestamp",
    "actual_TCP_pose",
    "actual_TCP_speed",
    "actual_TCP_force",
    "runtime_state",
    "safety_status_bits",
]
_FIRST_STATE_S = 2.0
_STILL = 1e-3  # m/s or rad/s
_LONGEST_STEP_S = 2.0 / RATE_HZ  # of the ramp: a process that stood still does not jump
_FASTEST = 2.0  # times the limits of speed; the guard stops an arm before
_REFUSAL_STATES = 10
_BRAKING_MORE_S = 0.5
_CONNECTING_S = 30.0  # ur_rtde waits for ever where the port is open and silent
_HANGS_S = 5.0  # no watchdog waits as long: the controller has stopped the arm by then
_ENDING_MORE_S = 10.0  # beside the braking
_NOWHERE = Path(os.devnull).open("w")  # noqa: SIM115 - open as long as the process


class Driver:
    """Sends the newest command at `RATE_HZ`, checks the arm before each and stops it for any reason
    of `WHY`."""

    def __init__(
        self, parent: Parent, host: str, timeout_s: float, mount: Mount, limits: ArmLimits
    ) -> None:
        """Connect, send the controller its script and set the watchdog; nothing moves yet."""
        self._parent, self._mount, self._limits = parent, mount, limits
        self._ramp, self._sent_s = Ramp(limits, mount), -math.inf
        self._control, self._receive = _connected(host, timeout_s)
        _open_nothing_more()
        try:
            first = self._first_state()
            if not self._control.setWatchdog(limits.watchdog_hz):
                raise ArmError(f"{host}: the controller accepts no watchdog, so nothing moves")
            self._guard = Guard(limits, mount, first, time.monotonic())
            parent.show(first)
        except BaseException:
            self._leave()
            raise

    def run(self) -> None:
        """Drive until there is a reason to stop; then brake, end the script and disconnect."""
        trace = ""
        try:
            reason, detail = self._drive()
        except Exception as problem:  # noqa: BLE001 - whatever goes wrong must stop the arm
            reason, detail, trace = "error", str(problem), traceback.format_exc()
        self._parent.say(stopped=reason, detail=detail, trace=trace)
        _end_in(self._limits.braking_s(_FASTEST) + _ENDING_MORE_S)
        if not self._control.isConnected():
            return  # calls would wait for an answer, some for minutes: the watchdog stops the arm
        if reason == "connection":
            self._try(self._send_at_once, np.zeros(6))
            return
        self._try(self._brake)
        self._try(self._control.speedStop, self._acceleration)
        self._try(self._control.stopScript)
        self._leave()

    def _drive(self) -> tuple[str, str]:
        """Send the newest command until there is a reason to stop: that, and its figures."""
        due_s = time.monotonic()
        bounded_s = -math.inf
        while not self._parent.gone_within(due_s - time.monotonic()):
            state, asked, now_s = self._shown(), self._parent.asked, time.monotonic()
            if now_s > bounded_s + 1.0:
                _end_in(_HANGS_S)
                bounded_s = now_s
            reason, detail = self._guard.reason(state, now_s, asked[1] if asked else None)
            if reason:
                return reason, detail
            if asked and asked[0].state == "stop":
                return asked[0].reason or "closed", ""
            if not self._follow(asked[0] if asked else None, state):
                return self._refusal()
            due_s = max(due_s + 1.0 / RATE_HZ, now_s)
        return "closed", ""

    def _refusal(self) -> tuple[str, str]:
        """Reason why the controller took no command; its state shows it a little later."""
        for _ in range(_REFUSAL_STATES):
            reason, detail = self._guard.reason(self._state(), time.monotonic(), None)
            if reason:
                return reason, detail
            time.sleep(1.0 / RATE_HZ)
        return "error", "the controller took no command"

    def _follow(self, command: Command | None, state: ArmState) -> bool:
        if command is None:
            return bool(self._control.kickWatchdog())
        twist = self._mount.tool_twist(command)
        fingertip_mm_s = math.hypot(command.forward_mm_s, command.lateral_mm_s)
        tool_mm_s = float(np.linalg.norm(twist[:3])) * 1000.0
        twist *= self._limits.share(max(fingertip_mm_s, tool_mm_s), abs(command.rotation_rad_s))
        return self._send(twist, state.pose)

    def _send(self, wanted: Floats, pose: Floats) -> bool:
        """Send the next step towards a twist in the tool frame; whether the controller took it."""
        now_s = time.monotonic()
        twist = self._ramp.toward(wanted, min(now_s - self._sent_s, _LONGEST_STEP_S))
        self._sent_s = now_s
        return self._send_at_once(in_base(pose, twist))

    def _send_at_once(self, twist: Floats) -> bool:
        """Send a twist in the base; whether the controller took it."""
        return bool(self._control.speedL(twist.tolist(), self._acceleration, 1.0 / RATE_HZ))

    @property
    def _acceleration(self) -> float:
        """For `speedl`, which takes one number for m/s² and rad/s²: the larger one. The ramp keeps
        each within its own, if the controller follows it."""
        return max(self._limits.acceleration_mm_s2 / 1000.0, self._limits.rotation_rad_s2)

    def _brake(self) -> None:
        """Send ever slower speeds until the arm stands: with `speedStop` alone the watchdog would
        act."""
        state = self._state()
        measured_s = self._ramp.seconds_of(in_tool(state.pose, state.twist))
        needed_s = max(measured_s, self._ramp.seconds_of(self._ramp.twist))
        until_s = time.monotonic() + needed_s + _BRAKING_MORE_S
        while time.monotonic() < until_s and self._send(np.zeros(6), state.pose):
            state = self._shown()
            if not self._ramp.twist.any() and float(np.abs(state.twist).max()) < _STILL:
                return
            time.sleep(1.0 / RATE_HZ)

    def _leave(self) -> None:
        self._try(self._control.disconnect)
        self._try(self._receive.disconnect)

    def _try(self, call: Any, *arguments: Any) -> None:
        """Call; the next steps of the ending must be tried even if it fails."""
        try:
            call(*arguments)
        except Exception as problem:  # noqa: BLE001 - whatever it is
            self._parent.say(warning=f"while stopping the arm: {problem}")

    def _shown(self) -> ArmState:
        """The state, sent to the parent too."""
        state = self._state()
        self._parent.show(state)
        return state

    def _first_state(self) -> ArmState:
        """The state, once one has arrived: until then poses are empty."""
        until_s = time.monotonic() + _FIRST_STATE_S
        while not ((state := self._state()).pose.size and state.twist.size and state.force_n.size):
            if time.monotonic() > until_s:
                raise ArmError("the controller sends no states, so nothing moves; restart it")
            time.sleep(1.0 / RATE_HZ)
        return state

    def _state(self) -> ArmState:
        arm = self._receive
        return ArmState(
            time_s=arm.getTimestamp(),
            pose=np.array(arm.getActualTCPPose()),
            twist=np.array(arm.getActualTCPSpeed()),
            force_n=np.array(arm.getActualTCPForce()[:3]),
            connected=arm.isConnected(),
            runs=arm.getRuntimeState() == _PLAYING,
            protective=arm.isProtectiveStopped(),
            emergency=arm.isEmergencyStopped(),
        )


def _connected(host: str, timeout_s: float) -> tuple[Any, Any]:
    """Control and state interfaces; first a plain connection, since ur_rtde's has no timeout."""
    try:
        from rtde_control import RTDEControlInterface
        from rtde_receive import RTDEReceiveInterface
    except ImportError:
        raise MissingExtra("ur", "a UR arm") from None
    try:
        socket.create_connection((host, _PORT), timeout_s).close()
        receive = RTDEReceiveInterface(host, RATE_HZ, _VARIABLES)
        return RTDEControlInterface(host, RATE_HZ), receive
    except (OSError, RuntimeError) as problem:
        raise ArmError(
            f"host is {host}; no arm there takes commands at port {_PORT} ({problem}). Switch it "
            "on, unlock the brakes, enable remote control and check the address"
        ) from None


def _open_nothing_more() -> None:
    """Let this process open no more sockets, so that ur_rtde cannot restore a connection."""
    if sys.platform != "win32":
        import resource

        _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
        # Below 1 there is only descriptor 0, which is in use; poll() needs the 1.
        resource.setrlimit(resource.RLIMIT_NOFILE, (1, most))


def _end_in(seconds: float) -> None:
    """End this process then, whatever call of ur_rtde it waits in; a later call counts anew."""
    faulthandler.dump_traceback_later(seconds, exit=True, file=_NOWHERE)


def _serve(parent: Parent, host: str, timeout_s: float, mount: Mount, limits: ArmLimits) -> None:
    _end_in(timeout_s + _CONNECTING_S)
    try:
        driver = Driver(parent, host, timeout_s, mount, limits)
    except MissingExtra:
        parent.say(missing=True)
    except (ArmError, RuntimeError) as problem:
        parent.say(failed=str(problem))
    else:
        driver.run()
    faulthandler.cancel_dump_traceback_later()


def main() -> None:
    """Drive the arm until its program ends, or something stops it."""
    for signal_ in (signal.SIGINT, signal.SIGTERM):
        signal.signal(signal_, signal.SIG_IGN)  # may go to all: the program's end stops the arm
    parent = Parent()
    if settings := parent.settings:
        mount, limits = Mount(**settings["mount"]), ArmLimits(**settings["limits"])
        _serve(parent, settings["host"], settings["timeout_s"], mount, limits)
    parent.close()
    os._exit(0)  # cuts a connection that is left, and leaves threads of ur_rtde that wait


if __name__ == "__main__":
    main()
