"""A whole study: on all cores of this machine, or on a Dask cluster."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from lumitip_fab.config.automatic import AUTO
from lumitip_fab.config.load import Input, load
from lumitip_fab.config.parts import NAMED, NONE
from lumitip_fab.errors import InputError, Problem
from lumitip_fab.explore.accuracy import Sample
from lumitip_fab.explore.evaluate import FIGURES, Job, Journal, Record, evaluate, unpriced
from lumitip_fab.explore.pool import pool
from lumitip_fab.explore.vary import Axis, Changes, axes, changed, combinations
from lumitip_fab.pipeline.build import locked

_PRICED = (
    "leds",
    "current_sources",
    "transistors",
    "resistors",
    "resistor_arrays",
    "photodetectors",
    "multiplexers",
    "capacitors",
    "controllers",
)

Progress = Callable[[int, int], object]


@dataclass(frozen=True)
class Found:
    """One design of a study."""

    changes: Changes
    columns: tuple[int, ...]
    """Cells of each column of its grid."""
    figures: dict[str, float]
    """Empty if it is refused."""
    refused: tuple[str, ...]
    """Every reason why it cannot be."""


@dataclass(frozen=True)
class Study:
    """All designs of a study, in the order in which they were asked for."""

    axes: tuple[Axis, ...]
    designs: tuple[Found, ...]
    currency: str
    evaluated: int
    """How many were evaluated now; the others were known."""


def explore(
    file: Path,
    texts: Sequence[str],
    out: Path,
    points: int,
    keep_size: bool,
    sample: Sample,
    scheduler: str | None,
    progress: Progress,
) -> Study:
    """Evaluate all combinations; what the folder's journal knows is not evaluated again.

    Args:
        file: the parameter file that is varied.
        texts: `FIELD=SPEC`, each.
        out: folder of the journal.
        points: values of a range that has no step.
        keep_size: whether columns follow the pitch, so that the grid keeps its size.
        sample: what is drawn to judge accuracy.
        scheduler: address of a Dask scheduler; all cores of this machine by default.
        progress: called with how many are done, and of how many.

    Raises:
        InputError: if file, prices or texts are refused; then nothing is evaluated.
        OutputError: if the folder cannot be used.
        BuildError: if workers fail.
    """
    config = load(file)
    prices = config.catalogue.prices
    asked = axes(config, texts, points)
    _check(config, asked, keep_size)
    jobs = [
        Job.of(changed(config, changes, keep_size), changes, prices, sample)
        for changes in combinations(asked)
    ]
    keys = [job.key for job in jobs]
    with locked(out), Journal(out) as journal:
        records = dict(journal.known)
        missing = {key: job for key, job in zip(keys, jobs, strict=True) if key not in records}
        known = len(set(keys)) - len(missing)
        progress(known, known + len(missing))
        with pool(evaluate, len(missing), scheduler) as evaluated:
            for done, record in enumerate(evaluated(list(missing.values())), start=1):
                journal.add(record)
                records[record["key"]] = record
                progress(known + done, known + len(missing))
    designs = tuple(_found(job, records[key]) for job, key in zip(jobs, keys, strict=True))
    return Study(asked, designs, prices.currency, len(missing))


def _check(config: Input, asked: Sequence[Axis], keep_size: bool) -> None:
    """Refuse what no design could be judged by."""
    faults = without_price(config, asked)
    if keep_size and any(axis.field == "grid.columns" for axis in asked):
        conflict = "and --keep-size exclude each other: --keep-size counts the columns itself"
        faults.append(Problem("--vary", 0, "grid.columns", conflict))
    if faults:
        raise InputError(faults)


def without_price(config: Input, asked: Sequence[Axis]) -> list[Problem]:
    """A fault for each part without a price that a design may use."""
    varied = {axis.field: axis.values for axis in asked}
    parts = {field: part for field, part in NAMED.items() if part in _PRICED}
    names: set[str] = set()
    for field, part in parts.items():
        left = (AUTO,) if field in config.automatic else (config.value(field),)
        values = set(varied.get(field, left))
        names |= (values - {AUTO}) | set(getattr(config.catalogue, part) if AUTO in values else ())
    return unpriced(config, config.catalogue.prices, names - {NONE})


def _found(job: Job, record: Record) -> Found:
    evaluated = record.get("figures")
    figures = {name: evaluated[name] for name in FIGURES} if evaluated else {}
    columns = job.config.parameters.grid.columns
    return Found(job.changes, columns, figures, tuple(record.get("refused", ())))
