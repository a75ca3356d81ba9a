"""`design.json` follows from `resolved.toml`: neither was changed without the other.

The derivation is run again, by the same code: a fault of it is not seen here."""

import json
import tomllib
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lumitip_fab.checks.result import Measurement, Subject, unreadable
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.resolved import resolved_text
from lumitip_fab.design import Choice, Design
from lumitip_fab.design.encoding import encoded
from lumitip_fab.errors import FabError

READS = ("resolved.toml", "design.json", "parts/*.toml")
_PARAMETERS, _DESIGN = READS[:2]
_CHOICES = "choices"


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Derive the design again, and count the figures that differ.

    What was chosen automatically is a plain value in `resolved.toml`, and is compared with that.
    """
    try:
        config = load(outputs / _PARAMETERS, outputs)
        again = encoded(derive(config))
        text = (outputs / _PARAMETERS).read_text(encoding="utf-8")
        values = tomllib.loads(text)
        written = json.loads((outputs / _DESIGN).read_text(encoding="utf-8"))
    except (FabError, OSError, ValueError) as error:
        yield unreadable("derivation.design", _PARAMETERS, f"cannot be derived: {error!s:.300}")
        return
    of = Subject("derivation", _DESIGN)
    wrong = list(_differing(again | {_CHOICES: []}, written | {_CHOICES: []}, ""))
    yield of.count("design", wrong, "figures do not follow from resolved.toml: build again")
    odd = [c.field for c in design.choices if not _has(values, c)]
    yield of.count("choices", odd, "automatic values are not in resolved.toml")
    lines, wanted = Counter(text.splitlines()), Counter(resolved_text(config).splitlines())
    changed = sorted(((lines - wanted) + (wanted - lines)).elements())
    yield Subject("derivation", _PARAMETERS).count(
        "values", changed, "lines differ from the design derived again"
    )


def _differing(one: Any, other: Any, place: str) -> Iterator[str]:
    """Places at which two JSON values differ."""
    if isinstance(one, dict) and isinstance(other, dict):
        for key in sorted(one.keys() | other.keys()):
            yield from _differing(one.get(key), other.get(key), f"{place}.{key}".lstrip("."))
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for k, pair in enumerate(zip(one, other, strict=True)):
            yield from _differing(*pair, f"{place}[{k}]")
    elif type(one) is not type(other) or one != other:
        yield place


def _has(values: dict[str, Any], choice: Choice) -> bool:
    """Whether a field of a parameter file has the value that was chosen for it."""
    section, _, key = choice.field.partition(".")
    try:
        chosen = tomllib.loads(f"value = {choice.value}")["value"]
        return bool(values[section][key] == chosen)
    except (ValueError, LookupError, TypeError):
        return False
