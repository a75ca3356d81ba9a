"""Run the checks over an output folder; reads only."""

import importlib
import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path
from types import ModuleType

from lumitip_fab.checks.memory import Memory, Watched, reads
from lumitip_fab.checks.result import Measurement
from lumitip_fab.encoding import read_design

MODULES = (
    "manifest", "layout", "firmware", "mask", "backing", "fit_plate", "mould", "assembly", "board",
    "schematic", "orders", "printing", "holder", "robot", "wiring", "bom", "manual",
)  # fmt: skip


@dataclass(frozen=True)
class Outcome:
    """Everything that was measured."""

    measurements: tuple[Measurement, ...]

    @property
    def failed(self) -> tuple[Measurement, ...]:
        """The measurements outside their range."""
        return tuple(m for m in self.measurements if not m.passed)

    @property
    def names(self) -> frozenset[str]:
        """Names of all checks."""
        return frozenset(m.check for m in self.measurements)


def run_checks(
    out: Path, modules: Iterable[str] = MODULES, memory: Memory | None = None
) -> Outcome:
    """Measure the files below `out` against its `design.json`.

    Args:
        out: the output folder.
        modules: the check modules to run.
        memory: measurements of earlier runs, told again where nothing changed.

    Raises:
        OutputError: if there is no usable `design.json`.
    """
    design = read_design(out / "design.json")
    measurements: list[Measurement] = []
    for name in modules:
        known = memory.recalled(name, design) if memory else None
        if known is None:
            watched = Watched(design)
            known = tuple(_module(name).measure(out, watched))
            if memory:
                memory.keep(name, known, watched)
        measurements += known
    return Outcome(tuple(measurements))


def modules_reading(paths: Iterable[str]) -> Iterator[str]:
    """The check modules that open any of these files (relative to the output folder)."""
    touched = tuple(paths)
    for name in MODULES:
        patterns = (*reads(name), "design.json")
        if any(fnmatch(path, pattern) for path in touched for pattern in patterns):
            yield name


def _module(name: str) -> ModuleType:
    return importlib.import_module(f"lumitip_fab.checks.{name}")


def as_json(outcome: Outcome) -> list[dict[str, object]]:
    """The measurements as plain values; what is not finite becomes null."""
    return [
        {
            "check": m.check,
            "subject": m.subject,
            "measured": _finite(m.measured),
            "low": _finite(m.low),
            "high": _finite(m.high),
            "unit": m.unit,
            "margin": _finite(m.margin),
            "passed": m.passed,
            "note": m.note,
        }
        for m in outcome.measurements
    ]


def _finite(value: float) -> float | None:
    return round(value, 6) if math.isfinite(value) else None
