"""Readings of one's own prints, which the last build of a folder had and a new one has not."""

import tomllib
from pathlib import Path
from typing import Any

from lumitip_fab.paths import read_plain

_NONE = {"printer.fit_mm": 0.0, "mask.measured_ruler_mm": [100.0, 100.0]}
"""The readings of parameter files, and their values where nothing was measured."""


def readings(out: Path) -> dict[str, Any]:
    """What was measured on prints, by field, of the design that a folder was built from."""
    try:
        table = tomllib.loads(read_plain(out / "resolved.toml").decode())
    except (OSError, ValueError):
        return {}  # nothing was built, or what was is unreadable, which its checks report
    found = {name: _value(table, *name.split(".")) for name in _NONE}
    return {name: value for name, value in found.items() if value not in (None, _NONE[name])}


def _value(table: dict[str, Any], section: str, key: str) -> Any:
    fields = table.get(section)
    return fields.get(key) if isinstance(fields, dict) else None


def lost(before: dict[str, Any], file: Path, out: Path) -> list[str]:
    """A line for each reading that a folder had before a file was built into it, and now has not.

    Args:
        before: the readings that it had.
        file: the parameter file.
        out: the folder.
    """
    now = readings(out)
    return [
        f"warning: {out} had {name} = {value}, a reading of your prints; {file} has none. Build "
        "the file that has it, or write it into this one."
        for name, value in before.items()
        if name not in now
    ]
