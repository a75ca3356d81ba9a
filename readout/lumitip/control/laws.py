"""Control laws: from `Sight`, the line that is followed, to `Command`, the motion of the finger.

y ^   /     the finger goes forward along x; the line is at height d, at angle θ
  |  / θ
--+-/---> x
"""

import math
from dataclasses import dataclass, replace
from typing import Protocol

from lumitip import arguments
from lumitip.errors import LumitipError

_VELOCITIES = ("forward_mm_s", "lateral_mm_s", "rotation_rad_s")


class ControlError(LumitipError, ValueError):
    """A wrong setting or input of a controller."""


@dataclass(frozen=True, slots=True)
class Command:
    """Velocity of the finger in the receiver's sensor frame."""

    forward_mm_s: float = 0.0
    """Along x (mm/s)."""
    lateral_mm_s: float = 0.0
    """Along y, towards the tip (mm/s)."""
    rotation_rad_s: float = 0.0
    """About z, counter-clockwise (rad/s)."""
    state: str = "trace"
    """`"trace"`, `"slow"` where the line was just lost, `"search"`, or `"stop"`."""
    reason: str = ""
    """Reason to stop: `"corner"` or `"lost"`."""

    def scaled(self, share: float) -> "Command":
        """The same motion at a share of its speed."""
        return replace(self, **{name: share * getattr(self, name) for name in _VELOCITIES})


@dataclass(frozen=True, slots=True)
class Limits:
    """Largest velocities, in both directions."""

    forward_mm_s: float = 400.0
    lateral_mm_s: float = 400.0
    rotation_rad_s: float = 8.0

    def __post_init__(self) -> None:
        arguments.finite_fields(self, ControlError)
        for name in _VELOCITIES:
            arguments.number(getattr(self, name), name, above=0.0, error=ControlError)

    def of(self, command: Command) -> Command:
        """The command within the limits."""
        limits = {name: getattr(self, name) for name in _VELOCITIES}
        limited = {n: min(max(getattr(command, n), -most), most) for n, most in limits.items()}
        return replace(command, **limited)


@dataclass(frozen=True, slots=True)
class Sight:
    """The followed line, in the sensor frame."""

    height_mm: float | None = None
    """Height at which the line crosses x = 0 (mm); `None` without a line to follow."""
    angle: float = 0.0
    """Direction of the line from x (rad)."""
    centre_mm: float | None = None
    """Height of the dark centre (mm); only a `Contact` has it."""
    corner_mm: float | None = None
    """Distance in x to the vertex of a corner (mm); `None` without a corner."""


class Law(Protocol):
    """A control law."""

    @property
    def speed_mm_s(self) -> float:
        """Speed along the line (mm/s)."""

    def __call__(self, sight: Sight) -> Command | None:
        """The command, `None` where there is nothing to follow."""


@dataclass(frozen=True, slots=True)
class CentreLaw:
    """The published law: proportional control of the height of the dark centre."""

    speed_mm_s: float = 20.0
    gain_per_s: float = 6.0
    """Lateral velocity for each mm of error (1/s)."""
    target_mm: float = 0.0
    """Target height of the dark centre (mm)."""

    def __post_init__(self) -> None:
        _check(self)

    def __call__(self, sight: Sight) -> Command | None:
        """See `Law`; needs a `Contact`."""
        if sight.centre_mm is None:
            return None
        return Command(self.speed_mm_s, self.gain_per_s * (sight.centre_mm - self.target_mm))


@dataclass(frozen=True, slots=True)
class LineLaw:
    """Proportional control of the line's height, with feed-forward of its angle:

        lateral = K_p d + v tan θ,   rotation = K_θ θ

    The finger moves along the line, and turns until it points along the line.
    """

    speed_mm_s: float = 80.0
    gain_per_s: float = 8.0
    """K_p (1/s)."""
    turn_per_s: float = 8.0
    """K_θ (1/s)."""
    target_mm: float = 0.0
    """Target height of the line (mm)."""

    def __post_init__(self) -> None:
        _check(self)

    def __call__(self, sight: Sight) -> Command | None:
        """See `Law`; needs a line."""
        if sight.height_mm is None:
            return None
        forward = self.speed_mm_s * math.cos(sight.angle)
        lateral = self.gain_per_s * (sight.height_mm - self.target_mm)
        return Command(
            forward, lateral + forward * math.tan(sight.angle), self.turn_per_s * sight.angle
        )


def _check(law: Law) -> None:
    arguments.finite_fields(law, ControlError)
    arguments.number(law.speed_mm_s, "speed_mm_s", 0.0, error=ControlError)
