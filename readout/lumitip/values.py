"""A value of any kind: as one line of text, and as a number."""

import math
from typing import SupportsFloat


def shown(value: object, most: int = 40) -> str:
    """A value for a message: one line of at most `most` characters."""
    try:
        text = repr(value)
    except ValueError:  # an int with more digits than Python prints
        text = f"<{type(value).__name__}>"
    return " ".join(map(str.strip, text.splitlines()))[:most]


def as_float(value: object) -> float:
    """A value as a float; NaN if it is not a number or too large."""
    if type(value) is float:  # the usual case; the protocol check is slow
        return value
    try:
        return float(value) if isinstance(value, SupportsFloat) else math.nan
    except (TypeError, ValueError, OverflowError):
        return math.nan
