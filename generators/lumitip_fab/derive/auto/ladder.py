"""The smallest change of one field that mends a rule: steps that double, then bisection."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from annotated_types import Ge, Gt, Le, Lt

from lumitip_fab.derive.auto.judge import Rule, Verdict, judge_with
from lumitip_fab.parameters import Parameters

DECIMALS = 4


@dataclass(frozen=True)
class Change:
    """Another value of a field, and what derivation then says."""

    field: str
    value: Any
    verdict: Verdict


def smallest_number(before: Verdict, rule: Rule, field: str, step: float) -> Change | None:
    """The number nearest to a field's value, on multiples of a step from it, that mends a rule."""
    found = [
        change
        for sign in (1, -1)
        if (change := _along(before, rule, field, sign * step)) is not None
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


def _along(before: Verdict, rule: Rule, field: str, step: float) -> Change | None:
    start, whole = before.given.value(field), isinstance(before.given.value(field), int)
    low, high = bounds(field)

    def tried(steps: int) -> Change | None:
        value = start + steps * step if whole else round(start + steps * step, DECIMALS)
        verdict = judge_with(before.given, {field: value})
        mended = verdict is not None and verdict.mends(rule, before)
        return Change(field, value, verdict) if mended and verdict else None

    steps, failed = 1, 0
    while low <= start + steps * step <= high:
        change = tried(steps)
        if change:
            return _bisected(change, failed, steps, tried)
        steps, failed = 2 * steps, steps
    return None


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
    metadata = table.model_fields[key].metadata  # type: ignore[union-attr]
    low = max((float(m.ge if isinstance(m, Ge) else m.gt)  # type: ignore[arg-type]
               for m in metadata if isinstance(m, Ge | Gt)), default=float("-inf"))  # fmt: skip
    high = min((float(m.le if isinstance(m, Le) else m.lt)  # type: ignore[arg-type]
                for m in metadata if isinstance(m, Le | Lt)), default=float("inf"))  # fmt: skip
    return low, high


def catalogue_names(before: Verdict, kind: str, field: str) -> Iterator[str]:
    """Other entries of a catalogue file."""
    entries: Mapping[str, Any] = getattr(before.given.catalogue, kind)
    yield from (name for name in entries if name != before.given.value(field))
