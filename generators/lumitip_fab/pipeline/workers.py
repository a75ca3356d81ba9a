"""Steps of a build, their tasks, and running these: light ones here, heavy ones on all cores."""

import importlib
import multiprocessing
import os
from collections.abc import Iterator
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing.context import BaseContext
from typing import Any

from lumitip_fab.design import Design
from lumitip_fab.design.encoding import canonical
from lumitip_fab.errors import BuildError
from lumitip_fab.pipeline.artefact import Artefact, Files
from lumitip_fab.pipeline.dependencies import Dependencies, RecordedDesign, recorded
from lumitip_fab.pipeline.fingerprint import code_hash, tool_version


@dataclass(frozen=True)
class Step:
    """A generator: a function of the design that returns files with their facts.

    It is called with the design; then with one of `each`, where that is set; then with the files
    of earlier steps, where it is `late`.
    """

    name: str
    function: str
    """Its place below `lumitip_fab`, such as `"parts.backing.backing"`."""
    each: str = ""
    """The field of `Design` that the step runs once for each item of."""
    late: bool = False
    """Whether it uses files of other steps: it runs after those that stand before it."""
    heavy: bool = False
    """Whether it takes long, and so runs in a worker: routing, and what imports the CAD kernel."""
    tools: tuple[str, ...] = ()
    """Distributions whose version its output may depend on."""
    takes_s: int = 1
    """How long a run takes one core, about, of the default design: for the time left alone."""

    @property
    def module(self) -> str:
        """Name of the module that has the function."""
        return f"lumitip_fab.{self.function.rpartition('.')[0]}"

    @property
    def room(self) -> str:
        """Folder of the package with all its code."""
        return self.function.partition(".")[0]


@dataclass(frozen=True)
class Task:
    """One run of a step."""

    name: str
    step: Step
    design: Design
    item: tuple[Any, ...] = ()
    """The one of `each` that it is for; empty if it runs once."""

    def fixed(self) -> tuple[str, ...]:
        """Fixed dependencies: its item, its code and its tools."""
        tools = (tool_version(tool) for tool in self.step.tools)
        return (self.step.name, canonical(self.item), code_hash(self.step.room), *tools)


def tasks(steps: tuple[Step, ...], design: Design) -> Iterator[Task]:
    """Every run of some steps for a design."""
    for step in steps:
        if not step.each:
            yield Task(step.name, step, design)
            continue
        for item in getattr(design, step.each):
            yield Task(f"{step.name}.{item.name}", step, design, (item,))


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
