"""Runs the tasks of a build: light ones here, heavy ones on all cores."""

import importlib
import multiprocessing
import os
from collections.abc import Iterator
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing.context import BaseContext

from lumitip_fab.errors import BuildError
from lumitip_fab.pipeline.artefact import Artefact, Files
from lumitip_fab.pipeline.dependencies import Dependencies, RecordedDesign, recorded
from lumitip_fab.pipeline.graph import Step, Task


@dataclass(frozen=True)
class Result:
    """Files that a task made, and what it read for them."""

    task: str
    artefacts: tuple[Artefact, ...]
    dependencies: Dependencies


def run_tasks(stale: list[Task], files: Files) -> Iterator[Result]:
    """Run tasks: light ones here, heavy ones in workers of which each has the kernel ready.

    Raises:
        BuildError: if an artefact could not be made.
    """
    for task in stale:
        if not task.step.heavy:
            yield run_task(task, files)
    heavy = [task for task in stale if task.step.heavy]
    if not heavy:
        return
    context = _workers_context({task.step for task in heavy})
    workers = min(len(heavy), os.cpu_count() or 1)
    with ProcessPoolExecutor(workers, mp_context=context) as pool:
        running: dict[Future[Result], str] = {
            pool.submit(run_task, task, files): task.name for task in heavy
        }
        for future in as_completed(running):
            try:
                yield future.result()
            except BrokenProcessPool as error:
                raise BuildError(
                    f"{running[future]}: its worker was stopped from outside; if the machine ran "
                    "out of memory, close other programs and build again"
                ) from error


def run_task(task: Task, files: Files) -> Result:
    """Run one task in this process.

    Raises:
        BuildError: if an artefact could not be made.
    """
    function = getattr(importlib.import_module(task.step.module), task.step.function.split(".")[-1])
    design, used = RecordedDesign(task.design), Files.of(files)
    try:
        artefacts = function(design, *task.item, *([used] if task.step.late else []))
    except Exception as error:  # whatever it was, say which artefact it was
        raise BuildError(f"{task.name}: could not be made: {error!r}") from error
    return Result(task.name, tuple(artefacts), recorded(design, used.used))


def _workers_context(steps: set[Step]) -> BaseContext:
    """Workers forked from a server that has imported the kernel once and never used it: a process
    in which the kernel has run cannot be forked safely."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context()
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(sorted(step.module for step in steps))
    return context
