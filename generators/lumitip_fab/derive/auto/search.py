"""Mend broken rules one by one, each by the smallest change of one of the fields that may move."""

from collections.abc import Callable, Iterable

from lumitip_fab.automatic import FIELDS
from lumitip_fab.derive.auto.judge import Rule, Verdict
from lumitip_fab.derive.auto.ladder import (
    COARSE,
    Change,
    catalogue_names,
    first_of,
    smallest_number,
)
from lumitip_fab.derive.auto.mends import menders
from lumitip_fab.derive.led_strings import sold_ohm

MOST_CHANGES = 40

Moved = Callable[[Change, str], None]
"""Called with a change that was made and the message of the rule that it mended."""


def search(start: Verdict, free: frozenset[str], moved: Moved) -> Verdict:
    """Change automatic fields until every rule holds, or no change of one of them mends another.

    Args:
        start: where to begin.
        free: fields that may change.
        moved: told of each change.
    """
    now = start
    for _ in range(MOST_CHANGES):
        found = _next(now, free)
        if found is None:
            return now
        change, message = found
        moved(change, message)
        now = change.verdict
    return now


def _next(now: Verdict, free: frozenset[str]) -> tuple[Change, str] | None:
    for rule, problem in now.rules.items():
        for field in menders(problem.field):
            if field in free:
                change = change_of(now, rule, field)
                if change:
                    return change, problem.message
    return None


def change_of(now: Verdict, rule: Rule, field: str, fineness: int = COARSE) -> Change | None:
    """The smallest change of an automatic field that mends a rule; none where none does."""
    automatic = FIELDS[field]
    if automatic.names:
        return first_of(now, rule, field, catalogue_names(now, automatic.names, field))
    if field == "emitter.resistor_side":
        return first_of(now, rule, field, iter(_others(("back", "front"), now, field)))
    if field.endswith("_ohm"):
        return first_of(now, rule, field, iter([sold_ohm(now.given.value(field))]))
    if field == "stack.film_mm":
        film = now.given.catalogue.films[now.given.parameters.mask.film]
        return first_of(now, rule, field, iter([film.thickness_mm]))
    if automatic.step:
        return smallest_number(now, rule, field, automatic.step, fineness)
    return None


def _others(values: Iterable[str], now: Verdict, field: str) -> list[str]:
    return [value for value in values if value != now.given.value(field)]
