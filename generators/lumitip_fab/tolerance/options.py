"""Settings of a study of tolerances, and their limits."""

import math
from dataclasses import astuple, dataclass, field

from lumitip.estimation.estimator import DIAMETER_MM
from lumitip_fab.catalogue.tolerances import MaskConditions
from lumitip_fab.errors import InputError, Problem

GOOD_PERCENT = 90.0
"""Share of the fingers that are good with the largest shift of the masks."""
MASK_FINGERS = 500
"""Largest number of fingers by which the shift of the masks is found."""
_MOST_GOAL_MM, _MOST_GOAL_DEG = 1.0, 5.0  # half of a gross error


@dataclass(frozen=True)
class Goals:
    """A finger is good if its errors, rms over its poses, are within these, and none is gross.
    An error that may have any size is infinite."""

    edge_mm: float
    edge_deg: float
    cable_mm: float
    cable_deg: float

    @classmethod
    def of_both(cls, position_mm: float = 0.6, angle_deg: float = 2.5) -> "Goals":
        """The same goals for edges and cables."""
        return cls(position_mm, angle_deg, position_mm, angle_deg)

    @property
    def set(self) -> dict[str, float]:
        """The goals that are set, by figure."""
        return {name: value for name, value in vars(self).items() if math.isfinite(value)}


@dataclass(frozen=True)
class Grasp:
    """A gap in which fingers are tried with cables of some diameters, and with edges or without."""

    gap_mm: float = 3.0
    """Gap that the estimator expects (mm)."""
    cables_mm: tuple[float, ...] = (DIAMETER_MM,)
    edges: bool = True


@dataclass(frozen=True)
class Options:
    """Settings of a study."""

    goals: Goals = field(default_factory=Goals.of_both)
    grasps: tuple[Grasp, ...] = (Grasp(),)
    """The errors of a finger are those over all of them."""
    fingers: int = 500
    """Built pairs of fingers."""
    poses: int = 16
    """Of edges, and as many of cables of each diameter, in each grasp."""
    seed: int = 0
    file: str = ""
    """The goals file, if goals and grasps are of one."""
    exposure: float | None = 1.0
    """LED current times pull-up, relative to the base of the goals file; `None` if it is not
    known, and then 1 is tried."""
    against: str = ""
    """What that is relative to."""

    def __post_init__(self) -> None:
        limits = [
            *self._limits_of_goals(),
            ("--fingers", self.fingers, 16, 100_000, " fingers"),
            ("--poses", self.poses, 4, 1000, " poses"),
            ("--seed", self.seed, 0, 2**32 - 1, ""),
        ]
        wrong = [
            Problem(
                self.file if name.startswith("goals.") else name,
                0,
                name if name.startswith("goals.") else "",
                f"is {value:g}{unit}; {least:.10g} to {most:.10g} is allowed",
            )
            for name, value, least, most, unit in limits
            if not least <= value <= most
        ]
        if wrong:
            raise InputError(wrong)

    def _limits_of_goals(self) -> list[tuple[str, float, float, float, str]]:
        """Name, value, smallest and largest value, and unit of goals and gaps."""
        by_unit = {"mm": (0.01, _MOST_GOAL_MM, " mm"), "deg": (0.05, _MOST_GOAL_DEG, " degrees")}
        if self.file:
            return [
                (f"goals.{name}", value, *by_unit[name.rpartition("_")[2]])
                for name, value in self.goals.set.items()
            ]
        return [
            ("--position", self.goals.edge_mm, *by_unit["mm"]),
            ("--angle", self.goals.edge_deg, *by_unit["deg"]),
            *(("--gap", grasp.gap_mm, 1.0, 10.0, " mm") for grasp in self.grasps),
        ]

    @property
    def mask_conditions(self) -> MaskConditions | None:
        """Conditions that the shift of the masks is computed for, as the manual quotes it; none
        of a goals file, whose goals no manual knows."""
        if self.file:
            return None
        position_mm, angle_deg, *_ = astuple(self.goals)
        return MaskConditions(
            good_percent=GOOD_PERCENT,
            position_mm=position_mm,
            angle_deg=angle_deg,
            gap_mm=self.grasps[0].gap_mm,
            fingers=min(MASK_FINGERS, self.fingers),
            poses=self.poses,
            seed=self.seed,
        )
