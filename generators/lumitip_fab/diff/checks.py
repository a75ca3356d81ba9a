"""Checks that pass in one design alone, and those whose margins differ most."""

import math
import os
import shutil
import tempfile
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

from lumitip_fab.checks.memory import Memory
from lumitip_fab.checks.result import Measurement, relative_margin
from lumitip_fab.checks.run import MODULES, Outcome, run_checks
from lumitip_fab.diff.folder import Folder
from lumitip_fab.pipeline.manifest import REPORTS

MEMORY = ".checked.json"
"""Results that `make outputs` keeps in the output folder."""
_MOST = 12  # margins that are listed
_LEAST = 0.005  # change of a margin, as a share


def outcomes(a: Folder, b: Folder) -> tuple[Outcome, Outcome]:
    """Both designs checked. Results that an output folder keeps, and those of A for B, are used
    again for unchanged files; neither folder is written to."""
    with tempfile.TemporaryDirectory() as work:
        memory = Path(work) / MEMORY
        measured = []
        for folder in (a, b):
            if (folder.out / MEMORY).is_file():
                shutil.copyfile(folder.out / MEMORY, memory)
            known = Memory(memory, folder.out, [folder.out / name for name in (MEMORY, *REPORTS)])
            outcome = run_checks(folder.out, MODULES, known, os.cpu_count() or 1)
            measured.append(Outcome(tuple(_unplaced(m, a, b) for m in outcome.measurements)))
    return measured[0], measured[1]


def _unplaced(m: Measurement, *folders: Folder) -> Measurement:
    """A measurement without the paths of both folders: reports are the same wherever they are."""
    note = m.note
    for folder in folders:
        note = note.replace(f"{folder.out}/", "")
    return replace(m, note=note)


def check_differences(a: Outcome, b: Outcome) -> dict[str, Any]:
    """Checks by how they differ, each with its tightest measurements.

    Returns:
        `fails_a` and `fails_b`: checks that fail there and not in the other. `fails_both`: their
        number. `only_a`, `only_b`: names of checks that one alone has. `margins`: those of both
        whose relative margin (see `relative_margin`) differs most.
    """
    one, other = _worst(a.measurements), _worst(b.measurements)
    entries: list[dict[str, Any]] = [
        {"check": name, "a": _record(one.get(name)), "b": _record(other.get(name))}
        for name in sorted(one.keys() | other.keys())
    ]
    common = [entry for entry in entries if entry["a"] and entry["b"]]
    changed = [entry for entry in common if _change(entry) >= _LEAST]
    return {
        "fails_a": [entry for entry in entries if _fails(entry["a"]) and not _fails(entry["b"])],
        "fails_b": [entry for entry in entries if _fails(entry["b"]) and not _fails(entry["a"])],
        "fails_both": sum(_fails(e["a"]) and _fails(e["b"]) for e in entries),
        "only_a": [name for name in sorted(one) if name not in other],
        "only_b": [name for name in sorted(other) if name not in one],
        "margins": sorted(changed, key=lambda e: (-_change(e), e["check"]))[:_MOST],
    }


def _worst(measurements: Iterable[Measurement]) -> dict[str, Measurement]:
    """The measurement of each check that fails, else that with the smallest margin."""
    found: dict[str, Measurement] = {}
    for m in measurements:
        if m.check not in found or _rank(m) < _rank(found[m.check]):
            found[m.check] = m
    return found


def _rank(m: Measurement) -> tuple[bool, float]:
    margin = relative_margin(m)
    return m.passed, math.inf if margin is None else margin


def _record(m: Measurement | None) -> dict[str, Any] | None:
    if m is None:
        return None
    margin = relative_margin(m)
    return {
        "subject": m.subject,
        "measured": round(m.measured, 6) if math.isfinite(m.measured) else None,
        "unit": m.unit,
        "limit": m.limit,
        "passed": m.passed,
        "margin": None if margin is None else round(margin, 4),
        "note": m.note,
    }


def _fails(record: dict[str, Any] | None) -> bool:
    return record is not None and not record["passed"]


def _change(entry: dict[str, Any]) -> float:
    """Change of the relative margin; beyond 100 % more room makes no difference."""
    margins = [entry[side]["margin"] for side in "ab"]
    return 0.0 if None in margins else abs(min(margins[1], 1.0) - min(margins[0], 1.0))
