"""The smallest change of one field that mends a rule: steps that grow, then bisection."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, get_args

from annotated_types import Ge, Gt, Le, Lt

from lumitip_fab.derive.auto.judge import Rule, Verdict, judge_with
from lumitip_fab.derive.auto.led_current import lowest_ma
from lumitip_fab.parameters import Parameters

DECIMALS = 4
COARSE, FINE = 1, 2
"""Each number of steps is greater than the last by one part in so many of it: values that work may
lie close together, such as holes for a screw."""


@dataclass(frozen=True)
class Change:
    """Another value of a field, and what derivation then says."""

    field: str
    value: Any
    verdict: Verdict


def smallest_number(
    before: Verdict, rule: Rule, field: str, step: float, fineness: int = COARSE
) -> Change | None:
    """The number nearest to a field's value, on multiples of a step from it, that mends a rule."""
    found = [
        change
        for sign in (1, -1)
        if (change := _along(before, rule, field, sign * step, fineness)) is not None
    ]
    start = before.given.value(field)
    return min(found, key=lambda change: abs(change.value - start), default=None)


def first_of(before: Verdict, rule: Rule, field: str, values: Iterator[Any]) -> Change | None:
    """The first of some values that mends a rule."""
    for value in values:
        verdict = judge_with(before.given, {field: value})
        if verdict and verdict.mends(rule, before):
            return Change(field, value, verdict)
    return None


def _along(before: Verdict, rule: Rule, field: str, step: float, fineness: int) -> Change | None:
    start, whole = before.given.value(field), isinstance(before.given.value(field), int)
    low, high = bounds(field)
    if field == "emitter.current_ma":
        low = max(low, lowest_ma(before.given))

    def tried(steps: int) -> Change | None:
        value = start + steps * step if whole else round(start + steps * step, DECIMALS)
        verdict = judge_with(before.given, {field: value})
        mended = verdict is not None and verdict.mends(rule, before)
        return Change(field, value, verdict) if mended and verdict else None

    failed = 0
    for steps in _growing(((low if step < 0 else high) - start) / step, fineness):
        change = tried(steps)
        if change:
            return _bisected(change, failed, steps, tried)
        failed = steps
    return None


def _growing(room: float, fineness: int) -> Iterator[int]:
    """Numbers of steps that grow, up to the last one that is within a field's bounds."""
    last, steps = math.floor(room + 1e-9), 1
    while steps < last:
        yield steps
        steps += max(1, steps // fineness)
    if last > 0:
        yield last


def _bisected(change: Change, failed: int, worked: int, tried: Any) -> Change:
    while worked - failed > 1:
        middle = (failed + worked) // 2
        better = tried(middle)
        if better:
            change, worked = better, middle
        else:
            failed = middle
    return change


def bounds(field: str) -> tuple[float, float]:
    """Least and greatest value that a numeric field allows."""
    section, key = field.split(".")
    table = Parameters.model_fields[section].annotation
    metadata = list(_metadata(table.model_fields[key]))  # type: ignore[union-attr]
    low = max(float(m.ge if isinstance(m, Ge) else m.gt)  # type: ignore[arg-type]
              for m in metadata if isinstance(m, Ge | Gt))  # fmt: skip
    high = min(float(m.le if isinstance(m, Le) else m.lt)  # type: ignore[arg-type]
               for m in metadata if isinstance(m, Le | Lt))  # fmt: skip
    return low, high


def _metadata(of: Any) -> Iterator[Any]:
    """What limits the values of a field, also of one that may be a number or a word."""
    yield of
    for inner in (*getattr(of, "metadata", ()), getattr(of, "annotation", None), *get_args(of)):
        if inner is not None:
            yield from _metadata(inner)


def catalogue_names(before: Verdict, kind: str, field: str) -> Iterator[str]:
    """Other entries of a catalogue file."""
    entries: Mapping[str, Any] = getattr(before.given.catalogue, kind)
    yield from (name for name in entries if name != before.given.value(field))
