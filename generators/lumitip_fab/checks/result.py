"""`Measurement`: what a check found in a file, and what it should have found."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from lumitip_fab.design import Design

# What readers raise on damaged files, beside their own exceptions.
MALFORMED = (
    ValueError, LookupError, TypeError, AttributeError, ArithmeticError, StopIteration,
    RuntimeError,
)  # fmt: skip
NOISE = 1e-5  # of coordinates in files: STL keeps 24 bits, which is 4e-6 mm at 50 mm


@dataclass(frozen=True)
class Measurement:
    """One figure measured in a file, with the range that it must lie in."""

    check: str
    """Name of the promise, like `"mask.position"`."""
    subject: str
    """The file, relative to the output folder, and where needed the place in it."""
    measured: float
    """The figure; NaN where it could not be taken, which fails."""
    low: float = -math.inf
    high: float = math.inf
    unit: str = ""
    note: str = ""

    @property
    def margin(self) -> float:
        """Distance to the nearer limit, below zero outside the range.

        Of a magnitude, which may be 0 at best, only the upper limit can be neared.
        """
        if self.low == 0 <= self.measured:
            return self.high - self.measured
        return min(self.measured - self.low, self.high - self.measured)

    @property
    def passed(self) -> bool:
        """Whether the figure lies in its range."""
        return self.low - NOISE <= self.measured <= self.high + NOISE

    @property
    def limit(self) -> str:
        """The range in words."""
        if self.low == self.high:
            return f"= {self.low:g}"
        if math.isinf(self.low) or (self.low == 0 and not math.isinf(self.high)):
            return "any" if math.isinf(self.high) else f"≤ {self.high:g}"
        return f"≥ {self.low:g}" if math.isinf(self.high) else f"{self.low:g} … {self.high:g}"


Check = Callable[[Path, Design], Iterator[Measurement]]
"""A check reads files below the output folder and holds them against `design.json`."""


def unreadable(check: str, subject: str, reason: str) -> Measurement:
    """The failed measurement for a file that is missing or cannot be read."""
    return Measurement(check, subject, math.nan, 0.0, 0.0, note=reason)
