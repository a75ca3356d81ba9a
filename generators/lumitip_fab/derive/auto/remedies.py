"""The smallest changes of a refused file that work, each tried against the rules before it is
named."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from lumitip_fab.config.automatic import AUTO, FOLLOWING, automatic_fields
from lumitip_fab.config.messages import brief
from lumitip_fab.config.parts import NAMED
from lumitip_fab.derive.auto import search
from lumitip_fab.derive.auto.judge import Rule, Verdict
from lumitip_fab.derive.auto.resolve import accepted_with

MOST_STEPS = 12
STEPS = {"_mm": 0.05, "_mm2": 0.01, "_deg": 0.5, "_ma": 0.5, "_w": 0.05, "_v": 0.5}
"""Resolution of a search, by the unit of the field."""
OWNED = ("coupling.gripper", "printer.profile")
"""Things that a user owns: another one is no small change."""
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
    """The changes to make."""

    steps: tuple[Step, ...]
    complete: bool
    """Whether the file is accepted with all first remedies."""


def plan_of(verdict: Verdict) -> Plan:
    """Changes that mend every broken rule: alternatives of one change where one is enough."""
    now, steps = verdict, []
    for _ in range(MOST_STEPS):
        found = next(_mended(now, verdict), None)
        if found is None:
            break
        step, now = found
        steps.append(step)
    if len(steps) > 1 or now.design is None:
        enough = list(_each_enough(verdict, steps))
        if enough:
            return Plan((Step(steps[0].message, tuple(enough)),), True)
    if not _accepted(verdict, [step.remedies[0] for step in steps]):
        return Plan(tuple(steps), False)
    return Plan(_smallest(verdict, _needed(verdict, steps)), True)


def _each_enough(verdict: Verdict, steps: list[Step]) -> Iterator[Remedy]:
    """Single changes that are sufficient, one for each field; switches of boards come last."""
    broken = {problem.field for problem in verdict.rules.values()}
    common = set.intersection(*(set(search.menders(field)) for field in broken))
    found = (remedy for step in steps for remedy in step.remedies)
    for remedy in sorted(found, key=lambda remedy: remedy.field in SWITCHES):
        if remedy.field in common and _accepted(verdict, [remedy]):
            common.remove(remedy.field)
            yield _nearest(verdict, remedy)


def _smallest(verdict: Verdict, steps: tuple[Step, ...]) -> tuple[Step, ...]:
    """The steps, each with its first change as small as the others allow."""
    firsts = [step.remedies[0] for step in steps]
    for at, remedy in enumerate(firsts):
        firsts[at] = _nearest(verdict, remedy, [*firsts[:at], *firsts[at + 1 :]])
    return tuple(
        replace(step, remedies=(first, *step.remedies[1:]))
        for step, first in zip(steps, firsts, strict=True)
    )


def _nearest(verdict: Verdict, remedy: Remedy, others: Sequence[Remedy] = ()) -> Remedy:
    """The accepted value nearest to the file's own, with other changes made: the search kept
    automatic values as they were, and with new ones a smaller change can be enough."""
    step = (
        automatic_fields()[remedy.field].step
        if remedy.field in automatic_fields()
        else _step_of(remedy.field)
    )
    value, was = remedy.value, remedy.was
    if not step or not isinstance(value, int | float) or not isinstance(was, int | float):
        return remedy
    found, refused = 0, int(abs(was - value) / step + 1e-6)
    while refused - found > 1:
        middle = (found + refused) // 2
        nearer = type(value)(round(value + math.copysign(middle * step, was - value), 6))
        if _accepted(verdict, [Remedy(remedy.field, nearer, was), *others]):
            found, remedy = middle, Remedy(remedy.field, nearer, was)
        else:
            refused = middle
    return remedy


def _step_of(field: str) -> float:
    """Resolution of a search of a field that is not automatic; 0 where it is no length, angle,
    current, power or voltage."""
    return next((step for unit, step in STEPS.items() if field.endswith(unit)), 0.0)


def _needed(verdict: Verdict, steps: list[Step]) -> tuple[Step, ...]:
    """The steps without redundant ones, whose rule the others fix too."""
    kept = list(steps)
    for step in steps:
        others = [other for other in kept if other is not step]
        if others and _accepted(verdict, [other.remedies[0] for other in others]):
            kept = others
    return tuple(kept)


def _accepted(verdict: Verdict, remedies: list[Remedy]) -> bool:
    return accepted_with(verdict.config, {r.field: r.value for r in remedies})


def _mended(now: Verdict, first: Verdict) -> Iterator[tuple[Step, Verdict]]:
    for rule, problem in now.rules.items():
        changes = list(_changes(now, rule, problem.field))
        if changes:
            remedies = tuple(
                Remedy(change.field, change.value, first.config.value(change.field))
                for change in changes
            )
            yield Step(problem.message, remedies), changes[0].verdict


def _changes(now: Verdict, rule: Rule, about: str) -> Iterator[search.Change]:
    """One change of each field that can mend a rule, the field of the rule first."""
    for field in search.menders(about):
        if field in OWNED:
            continue
        change = _change(now, rule, field, search.FINE if field == about else search.COARSE)
        if change:
            yield change


def _change(now: Verdict, rule: Rule, field: str, fineness: int) -> search.Change | None:
    if field in automatic_fields():
        change = search.change_of(now, rule, field, fineness)
        if change:
            return change
    elif field in NAMED:
        return search.first_of(now, rule, field, search.catalogue_names(now, NAMED[field], field))
    if field in SWITCHES:
        return search.first_of(now, rule, field, iter([not now.config.value(field)]))
    step, found = _step_of(field), None
    if step and isinstance(now.config.value(field), int | float):
        found = search.smallest_number(now, rule, field, step, fineness)
    if found is None and field in FOLLOWING:
        return search.first_of(now, rule, field, iter([AUTO]))
    return found


def remedy_lines(plan: Plan) -> list[str]:
    """The changes as text, for a terminal."""
    if not plan.steps:
        return []
    together = "together " * (plan.complete and len(plan.steps) > 1)
    lines = [f"Smallest changes that {together}work, each tried:"]
    for step in plan.steps:
        first, *others = map(str, step.remedies)
        lines.append(f"  {first}")
        lines += [f"    or {other}" for other in others]
    if not plan.complete:
        lines.append("  These do not mend every fault: the others need another design.")
    return lines
