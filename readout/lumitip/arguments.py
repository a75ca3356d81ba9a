"""Arguments that several calls take: one rule and one error for each."""

import math
import operator
from typing import SupportsFloat, SupportsIndex

from lumitip.errors import ArgumentError


def seconds(given: object, name: str = "timeout") -> float | None:
    """A time to wait (s); `None` and infinity are as long as it takes and come back as `None`.

    Raises:
        ArgumentError: if it is negative, NaN or no number.
    """
    if given is None:
        return None
    try:
        told = float(given) if isinstance(given, SupportsFloat) else math.nan
    except (TypeError, ValueError, OverflowError):
        told = math.nan
    if not told >= 0.0:
        raise ArgumentError(
            f"{name}: {given!r:.40} given, seconds from 0 on are needed, or None to wait as long "
            "as it takes"
        )
    return None if told == math.inf else told


def count(given: object, name: str) -> int:
    """A number of things, at least one.

    Raises:
        ArgumentError: if it is less, or no whole number.
    """
    try:
        told = operator.index(given) if isinstance(given, SupportsIndex) else 0
    except TypeError:
        told = 0
    if told < 1:
        raise ArgumentError(f"{name}: {given!r:.40} given, a whole number from 1 on is needed")
    return told
