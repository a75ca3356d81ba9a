"""`Measurement`: what a check found in a file, and what it should have found."""

import math
import unicodedata
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from numbers import Real
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from shapely.errors import ShapelyError

from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError

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


def relative_margin(measurement: Measurement) -> float | None:
    """The margin as a share of what it could be, comparable across units.

    0 is at the limit, negative is outside. The scale is

    - half the range, where both limits bind: 1 is in the middle of the tolerance;
    - the upper limit, for a magnitude that is at best 0: 1 is no deviation at all;
    - the limit itself, where there is only one: 1 is twice a lower limit, or 0 for an upper one.

    `None` where there is no such scale: exact values, a limit of 0, no limit, and figures that
    could not be measured.
    """
    low, high, measured = measurement.low, measurement.high, measurement.measured
    if math.isnan(measured) or low == high:
        return None
    if low == 0 <= measured:
        scale = high
    elif math.isfinite(low) and math.isfinite(high):
        scale = (high - low) / 2
    else:
        scale = abs(low if math.isfinite(low) else high)
    if scale == 0 or math.isinf(scale):
        return None
    return float(measurement.margin / scale)


Check = Callable[[Path, Design], Iterator[Measurement]]
"""A check reads files below the output folder and holds them against `design.json`."""


def unreadable(check: str, subject: str, reason: str) -> Measurement:
    """The failed measurement for a file that is missing or cannot be read."""
    return Measurement(check, subject, math.nan, 0.0, 0.0, note=reason)


_NAMED = 4  # of the things that are wrong
_DAMAGED = (ArithmeticError, LookupError, ValueError, OutputError, ShapelyError)
"""Exceptions of a measure on a file that can be read but is not what it should be."""
_Of = TypeVar("_Of", bound="Subject")
Measure = Callable[[_Of], Iterator[Measurement]]
"""A function `measure_NAME` of what was read."""
Clearance = tuple[float, float, float, str]
"""Measured clearance, least, most (mm), and what it is of."""


@dataclass(frozen=True, eq=False)
class Subject:
    """A file, or some that belong together, as it was read: what is measured bears its name."""

    prefix: str
    """First part of the checks' names."""
    subject: str

    def figure(
        self,
        check: str,
        measured: float,
        low: float,
        high: float,
        unit: str = "mm",
        note: str = "",
        at: str = "",
    ) -> Measurement:
        """A measurement of this file, or of a place in it."""
        subject = f"{self.subject}: {at}" if at else self.subject
        return Measurement(
            f"{self.prefix}.{check}", subject, float(measured), low, high, unit, note
        )

    def near(
        self,
        check: str,
        measured: object,
        wanted: ArrayLike,
        by: float,
        note: str = "",
        unit: str = "mm",
        at: str = "",
    ) -> Measurement:
        """The value that strays farthest from what is wanted, of all or of each; NaN if one could
        not be taken."""
        values = np.atleast_1d(np.asarray(measured, dtype=np.float64))
        every = np.asarray(wanted, dtype=np.float64)
        aims = np.broadcast_to(every, values.shape)
        worst, aim = math.nan, float(every.mean()) if every.size else 0.0
        if values.size and np.isfinite(values).all():
            at_worst = int(np.abs(values - aims).argmax())
            worst, aim = float(values[at_worst]), float(aims[at_worst])
        return self.figure(check, worst, aim - by, aim + by, unit, note, at)

    def clear(self, check: str, found: Clearance) -> Measurement:
        """Room round a fastener."""
        measured, low, high, note = found
        return self.figure(check, measured, low, high, note=note)

    def count(self, check: str, wrong: Sequence[str], unit: str) -> Measurement:
        """How many things are wrong, of which there may be none; the first few are named."""
        return count(f"{self.prefix}.{check}", self.subject, wrong, unit)


def farthest(values: NDArray[np.float64], wanted: float) -> float:
    """The value farthest from a nominal one; NaN if any is NaN, or there is none."""
    if not len(values) or not np.isfinite(values).all():
        return math.nan
    return float(values[np.abs(values - wanted).argmax()])


def count(check: str, subject: str, wrong: Sequence[str], unit: str) -> Measurement:
    """How many things are wrong, of which there may be none; the first few are named."""
    note = "; ".join(wrong[:_NAMED]) + (" …" if len(wrong) > _NAMED else "")
    return Measurement(check, subject, len(wrong), 0, 0, unit, note)


def measured(measures: Sequence[Measure[_Of]], of: _Of) -> Iterator[Measurement]:
    """The findings of each measure in turn; one that a damaged file stops fails by its own name."""
    for measure in measures:
        try:
            yield from measure(of)
        except _DAMAGED as error:
            name = measure.__name__.removeprefix("measure_")
            yield unreadable(
                f"{of.prefix}.{name}", of.subject, f"cannot be measured: {error!r:.200}"
            )
