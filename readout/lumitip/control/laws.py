"""Control laws: pure functions of what is seen, `None` where that is nothing to follow.

y ^   /     the finger goes forward along x; the line is at height d, at angle θ
  |  / θ
--+-/---> x
"""

import math
from dataclasses import dataclass
from typing import Protocol

from lumitip import arguments
from lumitip.control.command import Command, ControlError
from lumitip.control.sight import Sight


class Law(Protocol):
    """How to follow what is seen."""

    @property
    def speed_mm_s(self) -> float:
        """Speed along the line where all is well (mm/s)."""

    def __call__(self, sight: Sight) -> Command | None:
        """The command, `None` where there is nothing to follow."""


@dataclass(frozen=True, slots=True)
class CentreLaw:
    """The published law: the dark centre is held at a height in the grid, in proportion."""

    speed_mm_s: float = 20.0
    gain_per_s: float = 6.0
    """Lateral velocity by the height that is missing (1/s)."""
    target_mm: float = 0.0
    """Height that the dark centre is held at (mm)."""

    def __post_init__(self) -> None:
        _check(self)

    def __call__(self, sight: Sight) -> Command | None:
        """See `Law`; needs a `Contact`."""
        if sight.centre_mm is None:
            return None
        return Command(self.speed_mm_s, self.gain_per_s * (sight.centre_mm - self.target_mm))


@dataclass(frozen=True, slots=True)
class LineLaw:
    """The line's height in proportion, and its angle fed forward:

        lateral = K_p d + v tan θ,   rotation = K_θ θ

    so that the finger moves along the line, and turns until the line lies along its way.
    """

    speed_mm_s: float = 80.0
    gain_per_s: float = 8.0
    """K_p (1/s)."""
    turn_per_s: float = 8.0
    """K_θ (1/s)."""
    target_mm: float = 0.0
    """Height that the line is held at (mm)."""

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
