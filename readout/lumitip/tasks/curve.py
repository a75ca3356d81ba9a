"""`Curve`: a random smooth line to follow; the same seed gives the same line."""

from dataclasses import dataclass

import numpy as np

from lumitip import arguments
from lumitip.grid import Floats
from lumitip.values import one_line

STEP_MM = 0.25
LONGEST_MM = 1e6
"""Longest curve (mm)."""
REACH_MM = 30.0
"""Distance along a curve within which its nearest point is searched (mm)."""
BEND_DEG = 30.0
"""Largest deviation of a curve's direction from its mean."""
_WAVES, _SHORTEST_MM, _LONGEST_MM = 4, 150.0, 450.0
_BLEND_MM = 60.0


@dataclass(frozen=True, eq=False)
class Curve:
    """A line in the plane of the object, in steps of `STEP_MM`; arrays of shape `(n,)`."""

    x_mm: Floats
    y_mm: Floats
    heading: Floats
    """Direction (rad)."""
    bend_per_mm: Floats
    """Curvature, positive to the left (1/mm)."""

    def __repr__(self) -> str:
        return one_line(self)

    @classmethod
    def random(cls, length_mm: float, seed: int, straight_end_mm: float = 0.0) -> "Curve":
        """A curve whose direction is the sum of four sine waves, straight at both ends.

        Args:
            length_mm: along the curve (mm).
            seed: of its waves.
            straight_end_mm: straight length before its end, as before the corner of a cloth; the
                first 30 mm are always straight (mm).

        Raises:
            ArgumentError: if a length or the seed is invalid.
        """
        length_mm = arguments.number(length_mm, "length_mm", most=LONGEST_MM, above=0.0)
        seed = arguments.count(seed, "seed", 0)
        straight_end_mm = arguments.number(straight_end_mm, "straight_end_mm", 0.0)
        chance = np.random.default_rng((7, seed))
        along = np.arange(0.0, length_mm + STEP_MM, STEP_MM)
        heading = np.zeros(along.size)
        for _ in range(_WAVES):
            wave_mm = chance.uniform(_SHORTEST_MM, _LONGEST_MM)
            heading += chance.uniform(0.3, 1.0) * np.sin(
                2.0 * np.pi * along / wave_mm + chance.uniform(0.0, 2.0 * np.pi)
            )
        heading *= np.radians(BEND_DEG) / max(float(np.abs(heading).max()), 1e-9)
        begin = np.clip((along - 30.0) / _BLEND_MM, 0.0, 1.0)
        end = np.clip((along[-1] - straight_end_mm - along) / _BLEND_MM, 0.0, 1.0)
        smooth = np.minimum(begin, end if straight_end_mm else 1.0)
        heading *= smooth * smooth * (3.0 - 2.0 * smooth)
        x = np.concatenate([[0.0], np.cumsum(np.cos(heading[:-1])) * STEP_MM])
        y = np.concatenate([[0.0], np.cumsum(np.sin(heading[:-1])) * STEP_MM])
        return cls(x, y, heading, np.gradient(heading, STEP_MM))

    @property
    def length_mm(self) -> float:
        """Length along the curve (mm)."""
        return (self.x_mm.size - 1) * STEP_MM

    def nearest(self, x_mm: float, y_mm: float, near: int, reach_mm: float = REACH_MM) -> int:
        """Index of the point nearest to a place, searched around an index."""
        reach = round(reach_mm / STEP_MM)
        low, high = max(near - reach, 0), min(near + reach + 1, self.x_mm.size)
        away = (self.x_mm[low:high] - x_mm) ** 2 + (self.y_mm[low:high] - y_mm) ** 2
        return low + int(away.argmin())
