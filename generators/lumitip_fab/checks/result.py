"""`Measurement`: what a check found in a file, and what it should have found."""

import math
import unicodedata
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from numbers import Real
from pathlib import Path

import numpy as np

from lumitip_fab.design import Design

_UNPRINTABLE = frozenset({"Cc", "Cs", "Cn"})  # control, half of a surrogate pair, unassigned
NOISE = 1e-5  # of coordinates in files: STL keeps 24 bits, which is 4e-6 mm at 50 mm


@dataclass(frozen=True)
class Measurement:
    """One figure measured in a file, with the range that it must lie in.

    Figures become Python floats and texts become printable, whatever a reader found them as, so
    that every report can write every measurement.

    Raises:
        TypeError: if a figure is not a real number, or a text is not a string.
        ValueError: if a limit is NaN.
    """

    check: str
    """Name of the promise, like `"mask.position"`."""
    subject: str
    """The file, relative to the output folder, and where needed the place in it."""
    measured: float
    """The figure; NaN where it could not be measured. NaN fails in every range."""
    low: float = -math.inf
    high: float = math.inf
    unit: str = ""
    note: str = ""

    def __post_init__(self) -> None:
        for name in ("measured", "low", "high"):
            object.__setattr__(self, name, _number(self.check, name, getattr(self, name)))
        for name in ("check", "subject", "unit", "note"):
            object.__setattr__(self, name, _printable(self.check, name, getattr(self, name)))
        if math.isnan(self.low) or math.isnan(self.high):
            raise ValueError(f"{self.check}: limits {self.low} … {self.high}; a limit is never NaN")

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


def _number(check: str, name: str, value: object) -> float:
    """A Python float of any real number, of numpy as well."""
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if not isinstance(value, (Real, np.bool_)):
        raise TypeError(f"{check}: {name} is {value!r:.80}; a real number is needed")
    return float(value)


def _printable(check: str, name: str, text: object) -> str:
    """A Python string without what XML, a terminal or UTF-8 cannot carry: it is escaped."""
    if not isinstance(text, str):
        raise TypeError(f"{check}: {name} is {text!r:.80}; a string is needed")
    return "".join(map(_escaped, text))


def _escaped(c: str) -> str:
    if c in "\n\t" or unicodedata.category(c) not in _UNPRINTABLE:
        return c
    return c.encode("unicode_escape").decode()


Check = Callable[[Path, Design], Iterator[Measurement]]
"""A check reads files below the output folder and holds them against `design.json`."""


def unreadable(check: str, subject: str, reason: str) -> Measurement:
    """The failed measurement for a file that is missing or cannot be read."""
    return Measurement(check, subject, math.nan, 0.0, 0.0, note=reason)
