"""The smallest changes of a refused file that work, each tried against the rules before it is
named."""

from collections.abc import Iterator
from dataclasses import dataclass

from lumitip_fab.config.automatic import FIELDS
from lumitip_fab.config.load import NAMED
from lumitip_fab.config.messages import brief
from lumitip_fab.derive.auto.search import (
    Change,
    Rule,
    Verdict,
    catalogue_names,
    change_of,
    first_of,
    menders,
    smallest_number,
)

MOST_STEPS = 12
STEPS = {"_mm": 0.05, "_deg": 0.5, "_ma": 0.5, "_w": 0.05, "_v": 0.5}
"""Resolution of a search, by the unit of the field."""
SWITCHES = ("flange.enabled", "breakout.enabled")


@dataclass(frozen=True)
class Remedy:
    """One change of the file."""

    field: str
    value: object
    was: object

    def __str__(self) -> str:
        return f"{self.field} = {brief(self.value)} (now {brief(self.was)})"


@dataclass(frozen=True)
class Step:
    """Changes that each mend the same rule."""

    message: str
    remedies: tuple[Remedy, ...]
    """The first is the one that later steps build on."""


@dataclass(frozen=True)
class Plan:
    """What to change."""

    steps: tuple[Step, ...]
    complete: bool
    """Whether all first remedies together make a design."""


def plan_of(verdict: Verdict) -> Plan:
    """Changes that mend every broken rule, one after the other."""
    now, steps = verdict, []
    for _ in range(MOST_STEPS):
        found = next(_mended(now), None)
        if found is None:
            break
        step, now = found
        steps.append(step)
    return Plan(tuple(steps), now.design is not None)


def _mended(now: Verdict) -> Iterator[tuple[Step, Verdict]]:
    for rule, problem in now.rules.items():
        changes = list(_changes(now, rule, problem.field))
        if changes:
            remedies = tuple(
                Remedy(change.field, change.value, now.config.value(change.field))
                for change in changes
            )
            yield Step(problem.message, remedies), changes[0].verdict


def _changes(now: Verdict, rule: Rule, about: str) -> Iterator[Change]:
    """One change of each field that can mend a rule, the field of the rule first."""
    for field in menders(about):
        change = _change(now, rule, field)
        if change:
            yield change


def _change(now: Verdict, rule: Rule, field: str) -> Change | None:
    if field in FIELDS:
        return change_of(now, rule, field)
    if field in NAMED:
        return first_of(now, rule, field, catalogue_names(now, NAMED[field], field))
    if field in SWITCHES:
        return first_of(now, rule, field, iter([not now.config.value(field)]))
    step = next((step for unit, step in STEPS.items() if field.endswith(unit)), None)
    if step is None or not isinstance(now.config.value(field), int | float):
        return None
    return smallest_number(now, rule, field, step)


def remedy_lines(verdict: Verdict) -> list[str]:
    """The changes as text, for a terminal."""
    plan = plan_of(verdict)
    if not plan.steps:
        return []
    lines = ["Smallest changes that work, each tried:"]
    for step in plan.steps:
        first, *others = map(str, step.remedies)
        lines.append(f"  {first}")
        lines += [f"    or {other}" for other in others]
    if not plan.complete:
        lines.append("  These do not mend everything: the other faults need another design.")
    return lines
