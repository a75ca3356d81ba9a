"""Designs that are built whole take minutes each: a landing tests a part of them, in turn."""

import os
import re
from collections.abc import Sequence

import pytest

VARIABLE = "LUMITIP_TURN"
ALWAYS = frozenset({"fingertip", "small"})
"""Presets with a place in every turn: the design that a user edits, and one that is quick."""


def turn() -> tuple[int, int]:
    """Which part of how many is tested, from 0; `(0, 1)` is everything.

    Raises:
        UsageError: if the variable holds something else.
    """
    text = os.environ.get(VARIABLE, "0/1")
    found = re.fullmatch(r"(\d{1,3})/(\d{1,3})", text)
    if not found or int(found[1]) >= int(found[2]):
        raise pytest.UsageError(
            f"{VARIABLE} is {text!r}; a part of all parts, such as 0/3, 1/3 or 2/3 is needed"
        )
    return int(found[1]), int(found[2])


def waiting(items: Sequence[pytest.Item]) -> set[pytest.Item]:
    """Cases that have their turn another time. Tests of a preset have it together: they share the
    built files."""
    part, parts = turn()
    keys = {item: _key(item) for item in items if item.get_closest_marker("in_turn")}
    ranks = {key: rank for rank, key in enumerate(sorted({*keys.values()} - ALWAYS))}
    return {item for item, key in keys.items() if ranks.get(key, part) % parts != part}


def _key(item: pytest.Item) -> str:
    spec = getattr(item, "callspec", None)
    return str(spec.params.get("preset", item.nodeid)) if spec else item.nodeid
