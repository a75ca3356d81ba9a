"""Search for the smallest changes that mend every broken rule."""

import dataclasses
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, get_args

from annotated_types import Ge, Gt, Le, Lt

from lumitip_fab.config.automatic import automatic_fields
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.config.parts import NONE, OPTIONAL
from lumitip_fab.derive.auto.judge import Rule, Verdict, judge_with
from lumitip_fab.derive.auto.strings import dimmer, lowest_ma
from lumitip_fab.derive.boards.plug_in import least_inrush_ohm
from lumitip_fab.derive.finger.stack import mask_mm
from lumitip_fab.derive.wiring.ratings import sold_from, sold_ohm
from lumitip_fab.errors import Problem
from lumitip_fab.text import table_of

DECIMALS = 4
COARSE, FINE, FINEST = 1, 2, 32
"""Each trial takes more steps than the last by one of so many parts of them. A valid range may be
narrow, such as that of holes for a screw."""


@dataclass(frozen=True)
class Change:
    """Another value of a field, and what derivation then says."""

    field: str
    value: Any
    verdict: Verdict
    also: Mapping[str, str] = dataclasses.field(default_factory=dict)
    """Reasons of other automatic values that change with it, by field."""


def smallest_number(
    before: Verdict, rule: Rule, field: str, step: float, fineness: int = COARSE
) -> Change | None:
    """The number nearest to a field's value, on multiples of a step from it, that mends a rule."""
    found = [
        change
        for sign in (1, -1)
        if (change := _along(before, rule, field, sign * step, fineness)) is not None
    ]
    start = before.config.value(field)
    return min(found, key=lambda change: abs(change.value - start), default=None)


def first_of(before: Verdict, rule: Rule, field: str, values: Iterator[Any]) -> Change | None:
    """The first of some values that mends a rule."""
    for value in values:
        verdict = judge_with(before.config, {field: value})
        if verdict and verdict.mends(rule, before):
            return Change(field, value, verdict)
    return None


def _dimmed(before: Verdict, rule: Rule) -> Change | None:
    """The greatest current, with its pull-up, that mends a rule."""
    for values in dimmer(before.config):
        verdict = judge_with(before.config, {name: value for name, (value, _) in values.items()})
        if verdict and verdict.mends(rule, before):
            current = "emitter.current_ma"
            also = {name: reason for name, (_, reason) in values.items() if name != current}
            return Change(current, values[current][0], verdict, also)
    return None


def _along(before: Verdict, rule: Rule, field: str, step: float, fineness: int) -> Change | None:
    start, whole = before.config.value(field), isinstance(before.config.value(field), int)
    low, high = bounds(field)
    if field == "emitter.current_ma":
        low = max(low, lowest_ma(before.config))

    def tried(steps: int) -> Change | None:
        value = start + steps * step if whole else round(start + steps * step, DECIMALS)
        verdict = judge_with(before.config, {field: value})
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
    low = max(
        float(m.ge if isinstance(m, Ge) else m.gt)  # type: ignore[arg-type]
        for m in metadata
        if isinstance(m, Ge | Gt)
    )
    high = min(
        float(m.le if isinstance(m, Le) else m.lt)  # type: ignore[arg-type]
        for m in metadata
        if isinstance(m, Le | Lt)
    )
    return low, high


def _metadata(of: Any) -> Iterator[Any]:
    """Limits on the values of a field, including a field that may be a number or a word."""
    yield of
    for inner in (*getattr(of, "metadata", ()), getattr(of, "annotation", None), *get_args(of)):
        if inner is not None:
            yield from _metadata(inner)


def catalogue_names(before: Verdict, kind: str, field: str) -> Iterator[str]:
    """Other entries of a catalogue file."""
    entries: Mapping[str, Any] = getattr(before.config.catalogue, kind)
    yield from (name for name in entries if name != before.config.value(field))


def menders(field: str) -> tuple[str, ...]:
    """Fields to try for a rule about a field, in order, each once."""
    return tuple(dict.fromkeys((field, *table_of("derive/auto/menders.toml").get(field, ()))))


MOST_CHANGES = 40
_EITHER = {
    "emitter.drive": ("source", "resistor"),
    "emitter.resistor_side": ("back", "front"),
    "receiver.load": ("each", "shared"),
}

Moved = Callable[[Change, str], None]
"""Called with each change and what the rule said that it mended."""


def search(start: Verdict, free: frozenset[str], moved: Moved) -> Verdict:
    """Change automatic fields until every rule holds, or no change of one of them mends another.

    Args:
        start: where to begin.
        free: fields that may change.
        moved: called with each change.
    """
    now = start
    for _ in range(MOST_CHANGES):
        found = _next(now, free)
        if found is None:
            return now
        change, problem = found
        subject = "it" if problem.field == change.field else problem.field
        moved(change, f"{subject} {problem.message}")
        now = change.verdict
    return now


def _next(now: Verdict, free: frozenset[str]) -> tuple[Change, Problem] | None:
    for rule, problem in now.rules.items():
        for field in menders(problem.field):
            if field in free:
                change = change_of(now, rule, field)
                if change:
                    return change, problem
    for rule, problem in now.rules.items():
        if problem.field in free and automatic_fields()[problem.field].step:
            change = change_of(now, rule, problem.field, FINEST)
            if change:
                return change, problem
    return None


def change_of(now: Verdict, rule: Rule, field: str, fineness: int = COARSE) -> Change | None:
    """The smallest change of an automatic field that mends a rule; none where none does."""
    automatic = automatic_fields()[field]
    if field in OPTIONAL:  # another part is a choice of the user's
        return first_of(now, rule, field, iter([NONE]))
    if automatic.names:
        return first_of(now, rule, field, catalogue_names(now, automatic.names, field))
    if field in _EITHER:
        return first_of(now, rule, field, iter(_others(_EITHER[field], now, field)))
    if field == "flange.inrush_ohm":
        values = sold_ohm(now.config.value(field)), sold_from(least_inrush_ohm(now.config))
        return first_of(now, rule, field, iter(values))
    if field.endswith("_ohm"):
        return first_of(now, rule, field, iter([sold_ohm(now.config.value(field))]))
    if field == "stack.film_mm":
        return first_of(now, rule, field, iter([mask_mm(now.config)[0]]))
    if not automatic.step:
        return None
    change = smallest_number(now, rule, field, automatic.step, fineness)
    if change is None and field == "emitter.current_ma":
        return _dimmed(now, rule)
    return change


def _others(values: Iterable[str], now: Verdict, field: str) -> list[str]:
    return [value for value in values if value != now.config.value(field)]
