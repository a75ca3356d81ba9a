"""Arguments that several calls take: one rule and one error for each."""

import math
import operator
import os
from collections.abc import Callable
from dataclasses import fields
from functools import lru_cache
from pathlib import Path
from typing import Any, SupportsIndex, TypeVar

import numpy as np

from lumitip.errors import ArgumentError, LayoutError, LumitipError
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.values import as_float, shown

Error = type[LumitipError]
_Wanted = TypeVar("_Wanted")
_NUMBERS = "biufO"  # kinds of arrays that may hold numbers; of texts and of dates never do
_PLAIN = {float, int, bool, np.float64}


def seconds(given: object, name: str = "timeout") -> float | None:
    """A time to wait (s); `None` and infinity are as long as it takes and come back as `None`.

    Raises:
        ArgumentError: if it is negative, NaN or no number.
    """
    if given is None:
        return None
    told = as_float(given)
    if not told >= 0.0:
        raise ArgumentError(
            f"{name}: {shown(given)} given, seconds from 0 on are needed, or None to wait as long "
            "as it takes"
        )
    return None if told == math.inf else told


def count(given: object, name: str, least: int = 1, error: Error = ArgumentError) -> int:
    """A number of things.

    Raises:
        ArgumentError: or `error`, if it is below `least`, or no whole number.
    """
    try:
        told = operator.index(given) if isinstance(given, SupportsIndex) else least - 1
    except TypeError:
        told = least - 1
    if told < least:
        raise error(f"{name}: {shown(given)} given, a whole number from {least} on is needed")
    return told


def number(
    given: object,
    name: str,
    least: float = -math.inf,
    most: float = math.inf,
    *,
    above: float = -math.inf,
    error: Error = ArgumentError,
) -> float:
    """A finite number from `least` to `most`, and above `above`.

    Raises:
        ArgumentError: or `error`, if it is none.
    """
    told = as_float(given)
    if not (math.isfinite(told) and least <= told <= most and told > above):
        raise error(f"{name}: {shown(given)} given, {_needed(least, most, above)} is needed")
    return told


def numbers(given: object, name: str, error: Error = ArgumentError) -> Floats:
    """Numbers as an array of floats, not copied if they are one.

    Raises:
        ArgumentError: or `error`, if they are no numbers, or rows of different lengths.
    """
    why: Exception | None = None
    try:
        told = np.asarray(given)
        texts = told.dtype.kind == "O" and any(isinstance(one, str | bytes) for one in told.flat)
        if told.dtype.kind in _NUMBERS and not texts:  # which would be read as numbers
            return told.astype(np.float64, copy=False)
    except (TypeError, ValueError, OverflowError) as caught:
        why = caught
    raise error(
        f"{name}: {shown(given)} given, numbers of one shape are needed, such as frame.values"
    ) from why


def finite_fields(of: Any, error: Error) -> None:
    """Refuse a dataclass of which a field that is declared a float is no finite number.

    Numbers of other libraries, which floats may not be added to, become floats.

    Raises:
        LumitipError: `error`, naming the first of them.
    """
    names, values_of = _float_fields(of.__class__)
    values = values_of(of)
    try:
        # Of all at once: scenes are made by the ten thousand.
        if _PLAIN.issuperset(map(type, values)) and math.isfinite(sum(values)):
            return
    except OverflowError:
        pass
    for name, given in zip(names, values, strict=True):
        told = number(given, name, error=error)
        if type(given) not in _PLAIN:
            object.__setattr__(of, name, told)


def layout(given: object) -> Layout:
    """A layout that was read.

    Raises:
        LayoutError: if it is none.
    """
    if not isinstance(given, Layout):
        raise LayoutError(
            f"{shown(given)} given, a Layout is needed: Layout.load('outputs/layout.json') or "
            "tip.layout"
        )
    return given


def instance(
    given: object, wanted: type[_Wanted], name: str, error: Error = ArgumentError
) -> _Wanted:
    """Something of a class of this package.

    Raises:
        ArgumentError: or `error`, if it is of another.
    """
    if not isinstance(given, wanted):
        raise error(f"{name}: {shown(given)} given, a {wanted.__name__} is needed")
    return given


def function(given: object, name: str) -> None:
    """Refuse what cannot be called.

    Raises:
        ArgumentError: if it cannot.
    """
    if not callable(given):
        raise ArgumentError(f"{name}: {shown(given)} given, a function is needed")


def path(given: object, error: Error = ArgumentError) -> Path:
    """The path of a file.

    Raises:
        ArgumentError: or `error`, if it is no text and no `Path`.
    """
    if not isinstance(given, str | os.PathLike):
        raise error(f"{shown(given)} given, the path of a file is needed")
    return Path(given)


def _needed(least: float, most: float, above: float) -> str:
    if math.isfinite(most):
        begin = f"above {above:g} up to" if math.isfinite(above) else f"from {least:g} to"
        return f"a number {begin} {most:g}"
    if math.isfinite(above):
        return f"a number above {above:g}"
    return f"a number from {least:g} on" if math.isfinite(least) else "a finite number"


@lru_cache(maxsize=64)
def _float_fields(of: type[Any]) -> tuple[tuple[str, ...], Callable[[Any], tuple[Any, ...]]]:
    names = tuple(field.name for field in fields(of) if field.type is float)
    if len(names) == 1:  # of one name the getter gives no tuple
        one = operator.attrgetter(*names)
        return names, lambda instance: (one(instance),)
    return names, operator.attrgetter(*names)
