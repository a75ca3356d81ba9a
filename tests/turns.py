"""Slow tests take an hour and more together: a landing runs a part of them, in turn."""

import os
import re
from collections.abc import Collection

import pytest

VARIABLE = "LUMITIP_TURN"
ALWAYS = frozenset({"fingertip", "small"})
"""Presets with a place in every turn: the design that a user edits, and one that is quick."""


def turn() -> tuple[int, int]:
    """Which part of how many is run, from 0; `(0, 1)` is everything.

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


def waiting(slow: Collection[pytest.Item]) -> set[pytest.Item]:
    """Those that have their turn another time: each part has tests of nearly every file. What is
    tried on a preset has its turn together, because it shares the built files."""
    part, parts = turn()
    keys = {item: _key(item) for item in slow}
    ranks = {key: rank for rank, key in enumerate(sorted({*keys.values()} - ALWAYS))}
    return {item for item, key in keys.items() if ranks.get(key, part) % parts != part}


def _key(item: pytest.Item) -> str:
    spec = getattr(item, "callspec", None)
    preset = spec.params.get("preset") if spec else None
    return preset if isinstance(preset, str) else item.nodeid
