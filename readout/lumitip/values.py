"""A value of any kind: as one line of text, and as a number."""

import math
from typing import SupportsFloat


def shown(given: object, most: int = 40) -> str:
    """How a message tells it: in one line, of at most so many characters."""
    try:
        told = repr(given)
    except ValueError:  # a whole number of more digits than Python writes
        told = f"<{type(given).__name__}>"
    return " ".join(map(str.strip, told.splitlines()))[:most]


def as_float(given: object) -> float:
    """A number, not a number if it is none or too large."""
    if type(given) is float:  # nearly always, and the protocol is slow to ask
        return given
    try:
        return float(given) if isinstance(given, SupportsFloat) else math.nan
    except (TypeError, ValueError, OverflowError):
        return math.nan
