"""`Command`: how the finger should move, in its own sensor frame; and how fast it may."""

from dataclasses import dataclass

from lumitip import arguments
from lumitip.errors import LumitipError


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
    """Why it stops: `"corner"` or `"lost"`."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Largest velocities, either way."""

    forward_mm_s: float = 400.0
    lateral_mm_s: float = 400.0
    rotation_rad_s: float = 8.0

    def __post_init__(self) -> None:
        arguments.finite_fields(self, ControlError)
        for name in ("forward_mm_s", "lateral_mm_s", "rotation_rad_s"):
            arguments.number(getattr(self, name), name, above=0.0, error=ControlError)

    def of(self, command: Command) -> Command:
        """The command within the limits."""
        return Command(
            _within(command.forward_mm_s, self.forward_mm_s),
            _within(command.lateral_mm_s, self.lateral_mm_s),
            _within(command.rotation_rad_s, self.rotation_rad_s),
            command.state,
            command.reason,
        )


def _within(value: float, most: float) -> float:
    return min(max(value, -most), most)
