"""`Guard`: decides from the state of an arm whether it must stop. Needs no arm, clock or thread."""

import math
from dataclasses import dataclass

import numpy as np

from lumitip.grid import Floats
from lumitip.robots.limits import ArmLimits
from lumitip.robots.mount import Mount, rotation_of

_FASTER = 1.5  # times the speed limit; measured speeds overshoot, but not by more
_STILL_MM_S = 20.0


@dataclass(frozen=True, slots=True)
class ArmState:
    """State of an arm."""

    time_s: float
    """Clock of the arm (s); it stands still without new data."""
    pose: Floats
    """Of the tool centre point in the base (m, rad), shape `(6,)`."""
    twist: Floats
    """Of the tool centre point in the base (m/s, rad/s), shape `(6,)`."""
    force_n: Floats
    """On the tool (N), shape `(3,)`."""
    connected: bool = True
    runs: bool = True
    """Whether the control program runs on the controller."""
    protective: bool = False
    emergency: bool = False


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
        speed_mm_s = float(np.linalg.norm(state.twist[:3])) * 1000.0
        if not speed_mm_s <= _FASTER * limits.speed_mm_s + _STILL_MM_S:
            return "speed", f"{speed_mm_s:.0f} mm/s, {limits.speed_mm_s:g} allowed"
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
