"""Runs the tasks of a build: light ones here, heavy ones on all cores."""

import importlib
import multiprocessing
import os
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.context import BaseContext
from typing import Any

from lumitip_fab.errors import BuildError
from lumitip_fab.pipeline.artefact import Artefact
from lumitip_fab.pipeline.graph import Step, Task

Batch = tuple[str, tuple[Artefact, ...]]
"""What a task made, with its name."""


def made(stale: list[Task]) -> Iterator[Batch]:
    """Run tasks: light ones here, heavy ones in workers of which each has the kernel ready.

    Raises:
        BuildError: if an artefact could not be made.
    """
    for task in stale:
        if not task.step.heavy:
            yield task.name, _make(task)
    heavy = [task for task in stale if task.step.heavy]
    if not heavy:
        return
    context = _workers_context({task.step for task in heavy})
    workers = min(len(heavy), os.cpu_count() or 1)
    with ProcessPoolExecutor(workers, mp_context=context) as pool:
        running: dict[Future[tuple[Artefact, ...]], str] = {
            pool.submit(_make, task): task.name for task in heavy
        }
        for future in as_completed(running):
            try:
                yield running[future], future.result()
            except BrokenProcessPool as error:
                raise BuildError(
                    f"{running[future]}: its worker was stopped from outside; if the machine ran "
                    "out of memory, close other programs and build again"
                ) from error


def _workers_context(steps: set[Step]) -> BaseContext:
    """Workers forked from a server that has imported the kernel once and never used it: a process
    in which the kernel has run cannot be forked safely."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context()
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(sorted(_module(step) for step in steps))
    return context


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
    return f"lumitip_fab.{step.room}.{step.module}"
