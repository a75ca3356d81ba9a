"""Parameter file to output folder: only what changed is made again, on all cores."""

import importlib
import multiprocessing
import os
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from itertools import chain
from multiprocessing.context import BaseContext
from pathlib import Path
from typing import Any

from lumitip_fab import manifest
from lumitip_fab.artefact import Artefact
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.documents import documents
from lumitip_fab.errors import BuildError, OutputError
from lumitip_fab.graph import STEPS, Step, Task, tasks
from lumitip_fab.load import Input, load
from lumitip_fab.lock import locked

Progress = Callable[[str, int, int], None]
"""Called with the name of what was just made, how many are done, and how many there are."""


@dataclass(frozen=True)
class Report:
    """What a build did."""

    design: Design
    written: tuple[str, ...]
    """Files whose bytes changed."""
    removed: tuple[str, ...]
    """Files of an earlier build that this design does not have."""
    made: tuple[str, ...]
    """Tasks that ran."""
    kept: tuple[str, ...]
    """Tasks whose files were up to date."""


def build(file: Path, out: Path, progress: Progress | None = None) -> Report:
    """Build a parameter file into an output folder.

    Args:
        file: the parameter file.
        out: the folder; made if missing.
        progress: told of each task that ends.

    Raises:
        InputError: if the input is refused; then nothing is written.
        BuildError: if an artefact could not be made.
        OutputError: if the folder cannot be written.
    """
    given = load(file)
    design = derive(given)
    try:
        with locked(out):
            return _build(given, design, out, progress or _untold)
    except OSError as error:
        raise OutputError(
            f"{error.filename or out}: cannot be written: {error.strerror}"
        ) from error


def _build(given: Input, design: Design, out: Path, progress: Progress) -> Report:
    before = manifest.read(out)
    wanted = {task.name: (task, task.key) for task in tasks(design)}
    kept = [name for name, (_, key) in wanted.items() if before.whole(out, name, key)]
    stale = [task for name, (task, _) in wanted.items() if name not in kept]
    files = {path: e for path, e in before.files.items() if e.task in kept}
    written: list[str] = []
    batches = [("documents", documents(given, design))]
    for done, (name, artefacts) in enumerate(chain(batches, _run(stale)), start=1):
        for artefact in artefacts:
            files[artefact.path] = manifest.entry(artefact, name)
            if manifest.sha256_of(out / artefact.path) != files[artefact.path].sha256:
                written.append(artefact.path)
                manifest.write_file(out / artefact.path, artefact.data)
        progress(name, done, len(stale) + 1)
    removed = _remove(out, set(before.files) - set(files))
    keys = {name: key for name, (_, key) in wanted.items()}
    about = {
        "design_hash": design.layout.design_hash,
        "parameters_hash": design.parameters_hash,
    }
    manifest.write(out, manifest.Manifest(files, keys), about)
    made_names = tuple(task.name for task in stale)
    return Report(design, tuple(sorted(written)), removed, made_names, tuple(kept))


def _untold(_name: str, _done: int, _total: int) -> None:
    """Progress that nobody asked for."""


Batch = tuple[str, tuple[Artefact, ...]]


def _run(stale: list[Task]) -> Iterator[Batch]:
    """Run tasks: light ones here, heavy ones in workers of which each has the kernel ready."""
    for task in stale:
        if not task.step.heavy:
            yield task.name, _make(task)
    heavy = [task for task in stale if task.step.heavy]
    if not heavy:
        return
    context = _workers_context()
    workers = min(len(heavy), os.cpu_count() or 1)
    with ProcessPoolExecutor(workers, mp_context=context) as pool:
        running: dict[Future[tuple[Artefact, ...]], str] = {
            pool.submit(_make, task): task.name for task in _slowest_first(heavy)
        }
        for future in as_completed(running):
            try:
                yield running[future], future.result()
            except BrokenProcessPool as error:
                raise BuildError(
                    f"{running[future]}: its worker was stopped from outside; if the machine ran "
                    "out of memory, close other programs and build again"
                ) from error


def _workers_context() -> BaseContext:
    """Workers forked from a server that has imported the kernel once and never used it: a process
    in which the kernel has run cannot be forked safely."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context()
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([_module(step) for step in STEPS if step.heavy])
    return context


def _slowest_first(heavy: list[Task]) -> list[Task]:
    return sorted(heavy, key=lambda task: STEPS.index(task.step))


def _make(task: Task) -> tuple[Artefact, ...]:
    try:
        made: tuple[Artefact, ...] = _function(task.step)(**task.arguments)
    except Exception as error:  # whatever it was, say which artefact it was
        raise BuildError(f"{task.name}: could not be made: {error!r}") from error
    return made


def _function(step: Step) -> Callable[..., Any]:
    function: Callable[..., Any] = getattr(importlib.import_module(_module(step)), step.name)
    return function


def _module(step: Step) -> str:
    return f"lumitip_fab.{step.folder}.{step.module}"


def _remove(out: Path, paths: set[str]) -> tuple[str, ...]:
    # The manifest may have been edited: never reach outside the folder.
    mine = sorted(p for p in paths if (out / p).resolve().is_relative_to(out.resolve()))
    for path in mine:
        (out / path).unlink(missing_ok=True)
    return tuple(mine)
