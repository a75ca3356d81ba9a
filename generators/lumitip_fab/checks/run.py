"""Run the checks over an output folder; reads only. What has not changed is measured only once."""

import importlib
import logging
import math
import multiprocessing
import traceback
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path
from types import ModuleType

from lumitip_fab.checks.memory import Memory, reads
from lumitip_fab.checks.result import Measurement, count
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import read_design
from lumitip_fab.pipeline.dependencies import RecordedDesign
from lumitip_fab.pipeline.manifest import no_files

MODULES = (
    "manifest",
    "derivation",
    "bodies",
    "layout",
    "firmware",
    "mask",
    "mask_picture",
    "mask_sheet",
    "mask_cut",
    "mask_coupon",
    "backing",
    "strength",
    "fit_plate",
    "fit_orientation",
    "tie_lugs",
    "mould",
    "insert",
    "wrap",
    "clamp",
    "gauge_card",
    "assembly",
    "board",
    "models",
    "schematic",
    "libraries",
    "netlists",
    "pictures",
    "assembly_drawing",
    "orders",
    "panels",
    "printing",
    "holder",
    "flange",
    "robot",
    "system",
    "wiring",
    "bending",
    "bom",
    "packs",
    "heat",
    "manual_pages",
)
_LONG = frozenset({"orders", "board", "bodies"})
"""Modules that take longer than another process takes to start."""
_Run = tuple[tuple[Measurement, ...], list[str]]
"""Measurements of a module, and the fields of the design that it read."""
logger = logging.getLogger(__name__)
CRASH = "crash"
"""Second part of the name of the check that fails where a module stops with an exception."""


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
    out: Path, modules: Iterable[str] = MODULES, memory: Memory | None = None, cores: int = 1
) -> Outcome:
    """Measure the files below `out` against its `design.json`.

    Args:
        out: the output folder.
        modules: the check modules to run.
        memory: measurements of earlier runs, used again where nothing changed.
        cores: how many modules measure at a time.

    Raises:
        OutputError: if there is no usable `design.json`, or the memory cannot be written.
    """
    design = read_design(out / "design.json")
    found: dict[str, tuple[Measurement, ...] | None] = dict.fromkeys(modules)
    found |= {name: memory.recalled(name, design) for name in found if memory}
    found |= _blocked(found, out)
    anew = [name for name, known in found.items() if known is None]
    for name, (measured, fields) in _measured(out, design, anew, cores):
        found[name] = measured
        if memory and not any(m.check == f"{name}.{CRASH}" for m in measured):
            memory.keep(name, measured, design, fields)
    return Outcome(tuple(m for measured in found.values() for m in measured or ()))


def _blocked(modules: Iterable[str], out: Path) -> dict[str, tuple[Measurement, ...]]:
    """The failed measurement of each module that would open what nobody can read to an end;
    `manifest` opens plain files alone."""
    odd = no_files(out)
    shut = {name: [p for p in odd if _reads_it(name, p)] for name in modules if name != "manifest"}
    unit = "pipes, devices or folders instead of files: nothing was measured"
    return {name: (count(f"{name}.kinds", ".", p, unit),) for name, p in shut.items() if p}


def _measured(
    out: Path, design: Design, names: list[str], cores: int
) -> Iterator[tuple[str, _Run]]:
    """Run modules, the long ones first; in one process if it would be done before others start."""
    if cores == 1 or len(_LONG & set(names)) < 2:
        yield from ((name, _measure(name, out, design)) for name in names)
        return
    context = multiprocessing.get_context(
        "forkserver" if "forkserver" in multiprocessing.get_all_start_methods() else None
    )
    with ProcessPoolExecutor(min(cores, len(names)), mp_context=context) as pool:
        running = {
            pool.submit(_measure, name, out, design): name
            for name in sorted(names, key=lambda name: name not in _LONG)
        }
        for future in as_completed(running):
            yield running[future], future.result()


def _measure(name: str, out: Path, design: Design) -> _Run:
    seen, module = RecordedDesign(design), _module(name)
    found: list[Measurement] = []
    try:
        for measurement in module.measure(out, seen):
            found.append(measurement)  # what was measured before an exception counts
    except Exception as error:
        logger.exception("lumitip_fab.checks.%s stopped", name)
        found.append(_crash(name, error))
    return tuple(found), sorted(seen.fields)


def _crash(name: str, error: Exception) -> Measurement:
    """The failed measurement of a module that stopped with an exception: where, and why."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if _is_check(f.filename)]
    frame = (frames or traceback.extract_tb(error.__traceback__))[-1]
    place = f"{Path(frame.filename).name}:{frame.lineno} {frame.name}"
    reason = f"{type(error).__name__}: {error!s:.200}"
    note = (
        f"{reason}; the rest of checks.{name} has not run. This is a fault of the check: report it"
    )
    return Measurement(f"{name}.{CRASH}", place, math.nan, 0.0, 0.0, note=note)


def _is_check(filename: str) -> bool:
    path = Path(filename)
    return path.parent == Path(__file__).parent and path != Path(__file__)


def modules_reading(paths: Iterable[str]) -> Iterator[str]:
    """The check modules that open any of these files (relative to the output folder)."""
    touched = tuple(paths)
    for name in MODULES:
        if any(path == "design.json" or _reads_it(name, path) for path in touched):
            yield name


def _reads_it(module: str, path: str) -> bool:
    return any(fnmatch(path, pattern) for pattern in reads(module))


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
