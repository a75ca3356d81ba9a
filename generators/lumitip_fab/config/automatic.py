"""The fields that may be `"auto"`: their start values and dependencies.

A field that is left out of a file and of its base is `"auto"` too. `lumitip_fab.derive.auto` makes
the choices. The values here are those of the published sensor.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from lumitip_fab.text import table_of

AUTO = "auto"
ALL_AUTOMATIC = ("finger",)
"""Tables with automatic fields alone: a file may leave them out, as files of before do."""
FOLLOWING = ("tip.angle_deg",)
"""Fields that stay `"auto"`: they follow from others, or those from a value that is written."""

Value = float | int | str


@dataclass(frozen=True)
class Automatic:
    """Choice of the value of a field."""

    start: Value
    """First value; it is kept where every rule passes."""
    follows: str
    """Quantities that the value depends on, in a few words."""
    step: float = 0.0
    """Resolution of a numeric search; 0 for values that are computed or from a list."""
    names: str = ""
    """Catalogue file whose entries are tried, for a field that names a part."""


@lru_cache
def automatic_fields() -> dict[str, Automatic]:
    """The fields that may be `"auto"`, by name."""
    table = table_of("config/automatic.toml")
    return {field: Automatic(**values) for field, values in table.items()}


def filled(table: dict[str, Any]) -> tuple[dict[str, Any], frozenset[str]]:
    """A merged parameter table with a start in place of every automatic value.

    Returns:
        The table, and the fields whose values are to be chosen.
    """
    full, chosen = {section: {} for section in ALL_AUTOMATIC} | table, set()
    starts = {field: automatic.start for field, automatic in automatic_fields().items()}
    for field, start in (starts | dict.fromkeys(FOLLOWING, AUTO)).items():
        section, key = field.split(".")
        values = full.get(section)
        if isinstance(values, dict) and values.get(key, AUTO) == AUTO:
            full[section] = {**values, key: start}
            chosen.add(field)
    return full, frozenset(chosen - {*FOLLOWING})
