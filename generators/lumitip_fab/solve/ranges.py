"""Values of a parameter in `[vary]`: a list, or a range with a step."""

import math
from typing import Any

from lumitip_fab.config.load import Input
from lumitip_fab.config.messages import brief

RANGE = "{ from = A, to = B, step = C }"
MOST = 1e9
MOST_VALUES = 1000
"""Values of one parameter."""
_DECIMALS = 6


def values_of(spec: Any) -> tuple[Any, ...] | str:
    """The values of a spec, or what is wrong with it."""
    if isinstance(spec, tuple) and not any(isinstance(value, dict) for value in spec):
        return tuple(dict.fromkeys(spec)) or f"is an empty list; write values, or {RANGE}"
    if not isinstance(spec, dict) or spec.keys() != {"from", "to", "step"}:
        return f"is {brief(spec)}; a list of values or {RANGE} is needed"
    low, high, step = (spec[name] for name in ("from", "to", "step"))
    if not all(is_number(v) for v in (low, high, step)):
        return f"is {brief(spec)}; {RANGE} is needed in numbers"
    if not low < high or not step > 0 or (high - low) / step >= MOST_VALUES:
        return (
            f"is {brief(spec)}; from must be below to, and step above 0 with at most "
            f"{MOST_VALUES} values"
        )
    count = math.floor((high - low) / step + 1e-9) + 1
    return tuple(dict.fromkeys(round(low + n * step, _DECIMALS) for n in range(count)))


def as_numbers_of(base: Input, field: str, values: tuple[Any, ...]) -> tuple[Any, ...]:
    """Numbers in the type of the field, so that 4 and 4.0 are one value."""
    value = base.value(field)
    if isinstance(value, float):
        return tuple(float(v) if isinstance(v, int) and is_number(v) else v for v in values)
    return values


def is_number(value: Any) -> bool:
    """Whether a value of TOML is a finite number of a size that a design can have."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < MOST
