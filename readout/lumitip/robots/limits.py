"""Limits of an arm's motion, the reasons to stop it, and its errors."""

from dataclasses import dataclass, fields

from lumitip.errors import LumitipError
from lumitip.values import as_float, shown

# ruff: noqa: N818 - named by what happened, as in `lumitip.errors`

WHY = {
    "closed": "the program closed it",
    "connection": "the connection to the arm stands still or is cut",
    "corner": "the tracer came to a corner",
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
"""Every reason for which an arm is stopped."""


class ArmError(LumitipError):
    """An arm that cannot be reached, or invalid limits or mount."""


class ArmStopped(ArmError):
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
    "acceleration_mm_s2": (50.0, 2000.0, "slower than 50 no stop is short"),
    "force_n": (0.0, 100.0, "below the 140 N that ISO/TS 15066 allows on a hand"),
    "travel_mm": (0.0, 1000.0, "the reach of the smaller arms"),
    "turn_deg": (0.0, 170.0, "the finger's cable winds up"),
    "stale_s": (0.0, 0.5, "what is older says nothing about now"),
    "watchdog_hz": (2.0, 50.0, "the controller waits for one period of it"),
}


@dataclass(frozen=True, slots=True)
class ArmLimits:
    """Limits of an arm with a fingertip, within a safe range.

    They slow an arm down and stop it. They do not replace its own safety functions: set those of
    the controller as narrow as the task allows.
    """

    speed_mm_s: float = 100.0
    """Of the fingertip and of the tool centre point; faster commands are slowed down (mm/s)."""
    rotation_rad_s: float = 1.0
    """Rotation; faster commands are slowed down (rad/s)."""
    acceleration_mm_s2: float = 500.0
    """Acceleration and braking (mm/s²)."""
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

    def share(self, speed_mm_s: float, rotation_rad_s: float) -> float:
        """Factor, at most 1, that brings both speeds within the limits."""
        return min(
            1.0,
            self.speed_mm_s / max(speed_mm_s, 1e-9),
            self.rotation_rad_s / max(rotation_rad_s, 1e-9),
        )
