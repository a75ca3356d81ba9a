"""`ArmLimits`, and `Guard`, which stops an arm at them. Needs no arm, clock or thread."""

import math
from dataclasses import dataclass, fields

import numpy as np

from lumitip.grid import Floats
from lumitip.robots.mount import ArmError, Mount, rotation_of
from lumitip.values import as_float, one_line, shown

_FASTER = 1.5  # times the limit; measured speeds overshoot, but not by more
_STILL_MM_S = 20.0
_STILL_RAD_S = 0.1
WHY = {
    "closed": "the program closed it",
    "connection": "the connection to the arm is silent or lost",
    "corner": "the tracer reached a corner",
    "emergency": "the emergency stop is pressed",
    "error": "sending to the arm failed",
    "force": "the force on the tool changed by more than `force_n`",
    "lost": "the tracer lost the line",
    "program": "the control program no longer runs on the arm's controller",
    "protective": "the arm is in a protective stop",
    "speed": "the arm is faster than its command",
    "stale": "no fresh frame came within `stale_s`",
    "travel": "the fingertip is further than `travel_mm` from where it began",
    "turn": "the fingertip has turned by more than `turn_deg`",
}
"""Every reason to stop an arm."""


class ArmStopped(ArmError):  # noqa: N818 - named by what happened, as in `lumitip.errors`
    """The arm was stopped and takes no more commands: open it anew."""

    def __init__(self, reason: str, detail: str = "") -> None:
        more = f" ({detail})" if detail else ""
        super().__init__(
            f"the arm was stopped: {WHY.get(reason, reason)}{more}; look at it, then open it anew"
        )
        self.reason = reason
        """A key of `WHY`."""


_ALLOWED: dict[str, tuple[float, float, str]] = {
    "speed_mm_s": (0.0, 250.0, "the reduced speed of ISO 10218-1"),
    "rotation_rad_s": (0.0, 2.0, "a third of a turn in a second"),
    "acceleration_mm_s2": (50.0, 2000.0, "below 50 the stopping distance is long"),
    "rotation_rad_s2": (0.5, 10.0, "below 0.5 the arm turns on for long while it stops"),
    "force_n": (0.0, 100.0, "below the 140 N that ISO/TS 15066 allows on a hand"),
    "travel_mm": (0.0, 1000.0, "the reach of the smaller arms"),
    "turn_deg": (0.0, 170.0, "the finger's cable winds up"),
    "stale_s": (0.0, 0.5, "older frames do not show the present contact"),
    "watchdog_hz": (2.0, 50.0, "the controller waits for one period"),
}


@dataclass(frozen=True, slots=True)
class ArmLimits:
    """Limits of an arm with a fingertip, within a safe range.

    They slow an arm down and stop it. They do not replace its own safety functions: set those of
    the controller as narrow as the task allows.
    """

    speed_mm_s: float = 100.0
    """Limit for fingertip and tool centre point; faster commands are slowed down (mm/s)."""
    rotation_rad_s: float = 1.0
    """Rotation; faster commands are slowed down (rad/s)."""
    acceleration_mm_s2: float = 500.0
    """Acceleration and braking of fingertip and tool centre point (mm/s²)."""
    rotation_rad_s2: float = 3.0
    """Acceleration and braking of the rotation (rad/s²)."""
    force_n: float = 30.0
    """Largest change of the force on the tool since the arm was opened (N)."""
    travel_mm: float = 300.0
    """Largest distance of the fingertip from its start (mm)."""
    turn_deg: float = 120.0
    """Largest rotation of the fingertip from its start (°)."""
    stale_s: float = 0.1
    """Largest age of a frame that may move the arm (s)."""
    watchdog_hz: float = 10.0
    """Lowest rate of commands; below it the controller stops the arm by itself (Hz)."""

    def __post_init__(self) -> None:
        faults = []
        for field in fields(self):
            least, most, why = _ALLOWED[field.name]
            value = getattr(self, field.name)
            number = as_float(value)
            if not (least < number <= most or number == least > 0.0):
                allowed = f"above 0 up to {most:g}" if least == 0.0 else f"{least:g} to {most:g}"
                faults.append(f"{field.name} is {shown(value)}; allowed is {allowed} ({why})")
            object.__setattr__(self, field.name, number)
        if faults:
            raise ArmError("; ".join(faults))

    def braking_s(self, times: float) -> float:
        """Time to brake from a multiple of both speeds (s)."""
        return times * max(
            self.speed_mm_s / self.acceleration_mm_s2, self.rotation_rad_s / self.rotation_rad_s2
        )

    def share(self, speed_mm_s: float, rotation_rad_s: float) -> float:
        """Factor, at most 1, that brings both speeds within the limits."""
        return min(
            1.0,
            self.speed_mm_s / max(speed_mm_s, 1e-9),
            self.rotation_rad_s / max(rotation_rad_s, 1e-9),
        )


@dataclass(frozen=True, slots=True)
class ArmState:
    """State of an arm."""

    time_s: float
    """Clock of the arm (s); it stands still without new data."""
    pose: Floats
    """Pose of the tool centre point in the base (m, rad), shape `(6,)`."""
    twist: Floats
    """Twist of the tool centre point in the base (m/s, rad/s), shape `(6,)`."""
    force_n: Floats
    """On the tool (N), shape `(3,)`."""
    connected: bool = True
    runs: bool = True
    """Whether the control program runs on the controller."""
    protective: bool = False
    emergency: bool = False

    def __repr__(self) -> str:
        return one_line(self)


class Guard:
    """Watches an arm from the state in which it was opened."""

    def __init__(self, limits: ArmLimits, mount: Mount, first: ArmState, now_s: float) -> None:
        """Begin to watch.

        Args:
            limits: of the arm.
            mount: of the fingertip.
            first: the arm now; force, travel and turn are measured from here.
            now_s: the host's clock (s).
        """
        self._limits, self._mount, self._first = limits, mount, first
        self._began_mm = mount.origin_in_base_mm(first.pose)
        self._robot_s, self._changed_s = first.time_s, now_s

    def reason(self, state: ArmState, now_s: float, seen_s: float | None) -> tuple[str, str]:
        """The reason to stop, a key of `WHY`, with its figures; empty while the arm may move.

        Args:
            state: the arm now.
            now_s: the host's clock (s).
            seen_s: time of the frame behind the current command, by the same clock (s); `None`
                before the first command.
        """
        if state.time_s != self._robot_s:
            self._robot_s, self._changed_s = state.time_s, now_s
        silent_s = now_s - self._changed_s
        limits = self._limits
        if state.emergency:
            return "emergency", ""
        if state.protective:
            return "protective", ""
        if not state.connected or silent_s > limits.stale_s:
            return "connection", f"silent for {silent_s:.2f} s"
        if not state.runs:
            return "program", ""
        if seen_s is not None and now_s - seen_s > limits.stale_s:
            return "stale", f"the newest is {now_s - seen_s:.2f} s old, {limits.stale_s:g} allowed"
        return self._beyond(state)

    def _beyond(self, state: ArmState) -> tuple[str, str]:
        limits = self._limits
        force_n = float(np.linalg.norm(state.force_n - self._first.force_n))
        if not force_n <= limits.force_n:
            return "force", f"{force_n:.0f} N, {limits.force_n:g} allowed"
        tool_mm_s = float(np.linalg.norm(state.twist[:3])) * 1000.0
        fingertip_mm_s = self._mount.speed_of_origin_mm_s(state.pose, state.twist)
        for speed_mm_s in (tool_mm_s, fingertip_mm_s):
            if not speed_mm_s <= _FASTER * limits.speed_mm_s + _STILL_MM_S:
                return "speed", f"{speed_mm_s:.0f} mm/s, {limits.speed_mm_s:g} allowed"
        turning_rad_s = float(np.linalg.norm(state.twist[3:]))
        if not turning_rad_s <= _FASTER * limits.rotation_rad_s + _STILL_RAD_S:
            return "speed", f"{turning_rad_s:.1f} rad/s, {limits.rotation_rad_s:g} allowed"
        here_mm = self._mount.origin_in_base_mm(state.pose)
        travel_mm = float(np.linalg.norm(here_mm - self._began_mm))
        if not travel_mm <= limits.travel_mm:
            return "travel", f"{travel_mm:.0f} mm, {limits.travel_mm:g} allowed"
        turned = rotation_of(self._first.pose).T @ rotation_of(state.pose)
        cos = min(max((float(np.trace(turned)) - 1.0) / 2.0, -1.0), 1.0)
        turn_deg = math.degrees(math.acos(cos))
        if not turn_deg <= limits.turn_deg:
            return "turn", f"{turn_deg:.0f}°, {limits.turn_deg:g} allowed"
        return "", ""
