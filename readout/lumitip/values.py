"""A value of any kind: as one line of text, and as a number."""

import math
from dataclasses import fields
from typing import Any, SupportsFloat

import numpy as np


def shown(value: object, most: int = 40) -> str:
    """A value for a message: one line of at most `most` characters."""
    try:
        text = repr(value)
    except ValueError:  # an int with more digits than Python prints
        text = f"<{type(value).__name__}>"
    return " ".join(map(str.strip, text.splitlines()))[:most]


def one_line(record: Any) -> str:
    """The `repr` of a dataclass, with shape, type and range instead of the numbers of arrays."""
    parts = (f"{field.name}={_brief(getattr(record, field.name))}" for field in fields(record))
    return f"{type(record).__name__}({', '.join(parts)})"


def _brief(value: object) -> str:
    if not isinstance(value, np.ndarray):
        return repr(value)
    kind = f"{value.dtype}{list(value.shape)}"
    if not value.size or value.dtype.kind not in "biuf":
        return f"<{kind}>"
    return f"<{kind} from {value.min():g} to {value.max():g}>"


def as_float(value: object) -> float:
    """A value as a float; NaN if it is not a number or too large."""
    if type(value) is float:  # the usual case; the protocol check is slow
        return value
    try:
        return float(value) if isinstance(value, SupportsFloat) else math.nan
    except (TypeError, ValueError, OverflowError):
        return math.nan
