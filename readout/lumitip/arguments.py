"""Checks of arguments that several functions take."""

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
_T = TypeVar("_T")
_NUMBERS = "biufO"  # kinds of numpy arrays that can hold numbers
_PLAIN = {float, int, bool, np.float64}


def seconds(value: object, name: str = "timeout") -> float | None:
    """A time to wait (s); `None` and infinity mean no limit, and return `None`.

    Raises:
        ArgumentError: if it is negative, NaN or no number.
    """
    if value is None:
        return None
    result = as_float(value)
    if not result >= 0.0:
        raise ArgumentError(
            f"{name} is {shown(value)}; seconds from 0 on are needed, or None to wait without limit"
        )
    return None if result == math.inf else result


def count(value: object, name: str, least: int = 1, error: Error = ArgumentError) -> int:
    """A whole number from `least` on.

    Raises:
        ArgumentError: or `error`, if it is not.
    """
    try:
        result = operator.index(value) if isinstance(value, SupportsIndex) else least - 1
    except TypeError:
        result = least - 1
    if result < least:
        raise error(f"{name} is {shown(value)}; a whole number from {least} on is needed")
    return result


def number(
    value: object,
    name: str,
    least: float = -math.inf,
    most: float = math.inf,
    *,
    above: float = -math.inf,
    error: Error = ArgumentError,
) -> float:
    """A finite number from `least` to `most`, and above `above`.

    Raises:
        ArgumentError: or `error`, if it is not.
    """
    result = as_float(value)
    if not (math.isfinite(result) and least <= result <= most and result > above):
        raise error(f"{name} is {shown(value)}; {_needed(least, most, above)} is needed")
    return result


def numbers(value: object, name: str, error: Error = ArgumentError) -> Floats:
    """Numbers as an array of floats, without a copy where possible.

    Raises:
        ArgumentError: or `error`, if they are not numbers, or rows differ in length.
    """
    why: Exception | None = None
    try:
        result = np.asarray(value)
        texts = result.dtype.kind == "O" and any(isinstance(v, str | bytes) for v in result.flat)
        if result.dtype.kind in _NUMBERS and not texts:  # numpy would convert texts
            return result.astype(np.float64, copy=False)
    except (TypeError, ValueError, OverflowError) as caught:
        why = caught
    raise error(
        f"{name} is {shown(value)}; an array of numbers is needed, such as frame.values"
    ) from why


def finite_fields(of: Any, error: Error) -> None:
    """Reject a dataclass whose float fields are not all finite; convert them to plain floats.

    Raises:
        LumitipError: `error`, naming the first such field.
    """
    names, values_of = _float_fields(of.__class__)
    values = values_of(of)
    try:
        # All at once: tens of thousands of scenes are made.
        if _PLAIN.issuperset(map(type, values)) and math.isfinite(sum(values)):
            return
    except OverflowError:
        pass
    for name, value in zip(names, values, strict=True):
        result = number(value, name, error=error)
        if type(value) not in _PLAIN:
            object.__setattr__(of, name, result)


def layout(value: object) -> Layout:
    """Reject anything but a layout.

    Raises:
        LayoutError: if it is not a `Layout`.
    """
    if not isinstance(value, Layout):
        raise LayoutError(
            f"layout is {shown(value)}; a Layout is needed, such as "
            "Layout.load('outputs/layout.json') or tip.layout"
        )
    return value


def layout_or_path(value: object) -> Layout:
    """A layout, or the one in the file at a path.

    Raises:
        LayoutError: if it is neither, or the file cannot be read.
    """
    if isinstance(value, str | Path):
        return Layout.load(value)
    if not isinstance(value, Layout):
        raise LayoutError(f"layout is {shown(value)}; a Layout or the path of one is needed")
    return value


def instance(value: object, kind: type[_T], name: str, error: Error = ArgumentError) -> _T:
    """Reject anything but an instance of a class.

    Raises:
        ArgumentError: or `error`, if it is not.
    """
    if not isinstance(value, kind):
        raise error(f"{name} is {shown(value)}; a {kind.__name__} is needed")
    return value


def function(value: object, name: str) -> None:
    """Reject anything but a function.

    Raises:
        ArgumentError: if it cannot be called.
    """
    if not callable(value):
        raise ArgumentError(f"{name} is {shown(value)}; a function is needed")


def path(value: object, error: Error = ArgumentError) -> Path:
    """The path of a file.

    Raises:
        ArgumentError: or `error`, if it is neither text nor a `Path`.
    """
    if not isinstance(value, str | os.PathLike):
        raise error(f"the path is {shown(value)}; the name of a file is needed")
    return Path(value)


def unwritable(path: Path, error: Exception) -> str:
    """The message for a file that cannot be written."""
    if not path.parent.is_dir():
        return f"{path}: cannot be written: there is no folder {path.parent}. Create it first"
    return f"{path}: cannot be written: {error}"


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
    if len(names) == 1:  # `attrgetter` of one name returns no tuple
        one = operator.attrgetter(*names)
        return names, lambda instance: (one(instance),)
    return names, operator.attrgetter(*names)
