"""Slow tests take an hour and more together: `.ci/run` runs a part of them."""

import os
import re
from collections.abc import Collection
from zlib import crc32

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
    """Those that have their turn another time. Tests of a preset have theirs together, because they
    share the built files; a new test moves no other one."""
    part, parts = turn()
    presets = {item: preset for item in slow if (preset := _preset(item))}
    ranks = {preset: rank for rank, preset in enumerate(sorted({*presets.values()} - ALWAYS))}
    place = {item: ranks.get(preset, part) for item, preset in presets.items()}
    place |= {item: crc32(item.nodeid.encode()) for item in slow if item not in presets}
    return {item for item in slow if place[item] % parts != part}


def _preset(item: pytest.Item) -> str:
    spec = getattr(item, "callspec", None)
    preset = spec.params.get("preset") if spec else None
    return preset if isinstance(preset, str) else ""
