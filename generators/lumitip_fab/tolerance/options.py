"""Settings of a study of tolerances, and their limits."""

from dataclasses import dataclass

from lumitip_fab.catalogue.tolerances import MaskConditions
from lumitip_fab.errors import InputError, Problem

GOOD_PERCENT = 90.0
"""Share of the fingers that are good with the largest shift of the masks."""
MASK_FINGERS = 500
"""Largest number of fingers by which the shift of the masks is found."""
_MOST_GOAL_MM, _MOST_GOAL_DEG = 1.0, 5.0  # half of a gross error


@dataclass(frozen=True)
class Goals:
    """A finger is good if edges and cables are both estimated within these, rms over its poses,
    and none of its errors is gross."""

    position_mm: float = 0.6
    angle_deg: float = 2.5


@dataclass(frozen=True)
class Options:
    """Settings of a study."""

    goals: Goals = Goals()
    gap_mm: float = 3.0
    """Expected gap of a grasp (mm)."""
    fingers: int = 500
    """Built pairs of fingers."""
    poses: int = 16
    """Of edges, and as many of cables, with each."""
    seed: int = 0

    def __post_init__(self) -> None:
        limits = {
            "--position": (self.goals.position_mm, 0.01, _MOST_GOAL_MM, " mm"),
            "--angle": (self.goals.angle_deg, 0.05, _MOST_GOAL_DEG, " degrees"),
            "--gap": (self.gap_mm, 1.0, 10.0, " mm"),
            "--fingers": (self.fingers, 16, 100_000, " fingers"),
            "--poses": (self.poses, 4, 1000, " poses"),
            "--seed": (self.seed, 0, 2**32 - 1, ""),
        }
        wrong = [
            Problem(name, 0, "", f"is {value:g}{unit}; {least:.10g} to {most:.10g} is allowed")
            for name, (value, least, most, unit) in limits.items()
            if not least <= value <= most
        ]
        if wrong:
            raise InputError(wrong)

    @property
    def mask_conditions(self) -> MaskConditions:
        """Conditions that the shift of the masks is computed for."""
        return MaskConditions(
            good_percent=GOOD_PERCENT,
            position_mm=self.goals.position_mm,
            angle_deg=self.goals.angle_deg,
            gap_mm=self.gap_mm,
            fingers=min(MASK_FINGERS, self.fingers),
            poses=self.poses,
            seed=self.seed,
        )
