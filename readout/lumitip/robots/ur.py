"""`URArm`: a Universal Robots arm through RTDE, with ur_rtde (extra `[ur]`).

A thread sends the current command at `RATE_HZ`, checks the arm before each and stops it for any
reason of `WHY`. A stop is final: somebody must look at the arm and open it again.

ur_rtde's script repeats the last speed for ever, whatever its time was, and ur_rtde restores a lost
connection by itself. Therefore the watchdog of the controller stops the program if no register is
written, and an arm that was silent once is not moved again.
"""

import logging
import math
import socket
import threading
import time
from types import TracebackType
from typing import Any

import numpy as np

from lumitip import arguments
from lumitip.control import Command
from lumitip.errors import MissingExtra
from lumitip.grid import Floats
from lumitip.robots.guard import ArmLimits, ArmState, ArmStopped, Guard
from lumitip.robots.mount import ArmError, Mount, in_base, in_tool

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
_STILL = 1e-3  # m/s or rad/s
_REFUSAL_STATES = 10
_BRAKING_MORE_S = 0.5
_LONGEST_S = 600.0
_ENDING_S = 10.0  # braking takes 5 s where the limits are extreme
_log = logging.getLogger(__name__)


class URArm:
    """An open arm, which stands still until its first command. Thread-safe."""

    def __init__(
        self, host: str, mount: Mount, limits: ArmLimits | None = None, timeout: float = 5.0
    ) -> None:
        """Connect, send the controller its script and set the watchdog; nothing moves yet.

        The arm must be on, in remote control and free to move, with payload and tool centre point
        set. ur_rtde blocks all other Python threads while it connects: open the arm before the
        fingertip.

        Args:
            host: address of the controller.
            mount: of the fingertip on the tool.
            limits: of speed, force and travel.
            timeout: to find the controller (s).

        Raises:
            MissingExtra: if ur_rtde is not installed.
            ArmError: if the controller does not answer or does not run the script, or an argument
                is invalid.
        """
        self.host = arguments.instance(host, str, "host", ArmError)
        self.mount = arguments.instance(mount, Mount, "mount", ArmError)
        limits = ArmLimits() if limits is None else limits
        self.limits = arguments.instance(limits, ArmLimits, "limits", ArmError)
        within_s = arguments.number(timeout, "timeout", most=_LONGEST_S, above=0.0, error=ArmError)
        self._control, self._receive = _connected(host, within_s)
        self._asked: tuple[Command, float] | None = None
        self._stop: ArmStopped | None = None
        self._closing = threading.Event()
        try:
            if not self._control.setWatchdog(self.limits.watchdog_hz):
                raise ArmError(f"{host}: the controller accepts no watchdog, so nothing moves")
            self._guard = Guard(self.limits, mount, self._state(), time.monotonic())
        except BaseException:
            self._leave()
            raise
        # No daemon: any program that ends waits until the arm stands still.
        self._thread = threading.Thread(target=self._run, name="lumitip-ur")
        self._thread.start()

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
            ArmError: if a velocity or the time is no number; leave the `with` block then.
        """
        if self._stop:
            raise self._stop.with_traceback(None)
        arguments.finite_fields(arguments.instance(command, Command, "command", ArmError), ArmError)
        seen_s = arguments.number(seen_s, "seen_s", error=ArmError)
        # A time in the future would keep the arm moving without any frame until then.
        self._asked = (command, min(seen_s, time.monotonic()))
        if command.state == "stop":
            self._thread.join()

    def measured(self) -> Command:
        """Motion of the fingertip now, as reported by the arm's controller."""
        state = self._state()
        return self.mount.command(in_tool(state.pose, state.twist))

    def close(self) -> None:
        """Stop the arm, wait until it stands still, and disconnect. May be called repeatedly."""
        self._closing.set()
        self._thread.join()

    def _run(self) -> None:
        try:
            reason, detail = self._drive()
        except Exception as problem:  # noqa: BLE001 - whatever goes wrong must stop the arm
            reason, detail = "error", str(problem)
            _log.debug("reason of the stop:", exc_info=True)
        self._stop = ArmStopped(reason, detail)
        _log.log(logging.INFO if reason == "closed" else logging.WARNING, "%s", self._stop)
        # Without a connection ur_rtde may wait for ever: then its thread is left behind.
        ending = threading.Thread(target=self._end, args=(reason,), name="lumitip-ur-end")
        ending.daemon = True
        ending.start()
        ending.join(_ENDING_S)
        if ending.is_alive():
            _log.warning("%s: no answer while stopping; the watchdog stops the arm", self.host)

    def _drive(self) -> tuple[str, str]:
        """Send the current command until there is a reason to stop: that, and its figures."""
        due_s = time.monotonic()
        while not self._closing.wait(max(0.0, due_s - time.monotonic())):
            if not threading.main_thread().is_alive():
                break
            state, asked, now_s = self._state(), self._asked, time.monotonic()
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
        twist = self.mount.tool_twist(command)
        fingertip_mm_s = math.hypot(command.forward_mm_s, command.lateral_mm_s)
        tool_mm_s = float(np.linalg.norm(twist[:3])) * 1000.0
        twist *= self.limits.share(max(fingertip_mm_s, tool_mm_s), abs(command.rotation_rad_s))
        return self._send(in_base(state.pose, twist))

    def _send(self, twist: Floats) -> bool:
        """Send a twist in the base; whether the controller took it."""
        speed = twist.tolist()
        return bool(self._control.speedL(speed, self._acceleration_m_s2, 1.0 / RATE_HZ))

    @property
    def _acceleration_m_s2(self) -> float:
        return self.limits.acceleration_mm_s2 / 1000.0

    def _end(self, reason: str) -> None:
        """Brake, end the script and disconnect; each is tried even if another fails."""
        if reason != "connection":
            _try(self._brake)
            _try(self._control.speedStop, self._acceleration_m_s2)
            _try(self._control.stopScript)
        elif self._control.isConnected():
            # Calls that wait for an answer could wait for minutes; the watchdog does the rest.
            _try(self._send, np.zeros(6))
        self._leave()

    def _brake(self) -> None:
        """Send zero speed until the arm stands: with `speedStop` alone the watchdog would act."""
        speed_m_s = float(np.linalg.norm(self._state().twist[:3]))
        until_s = time.monotonic() + speed_m_s / self._acceleration_m_s2 + _BRAKING_MORE_S
        while time.monotonic() < until_s and self._send(np.zeros(6)):
            if float(np.abs(self._state().twist).max()) < _STILL:
                return
            time.sleep(1.0 / RATE_HZ)

    def _leave(self) -> None:
        _try(self._control.disconnect)
        _try(self._receive.disconnect)

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

    def __enter__(self) -> "URArm":
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        self.close()


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


def _try(call: Any, *arguments: Any) -> None:
    try:
        call(*arguments)
    except Exception as problem:  # noqa: BLE001 - the next steps must be tried anyway
        _log.warning("while stopping the arm: %s", problem)
