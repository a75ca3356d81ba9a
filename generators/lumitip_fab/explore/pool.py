"""Evaluate designs on all cores of this machine, or on a Dask cluster."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import partial
from typing import Protocol, TypeVar

from lumitip.errors import how_to_install
from lumitip.tasks.bench import workers
from lumitip_fab.errors import BuildError, OutputError
from lumitip_fab.explore.evaluate import Record


class Keyed(Protocol):
    """A job with its key."""

    @property
    def key(self) -> str:
        """SHA-256 of everything that the result depends on."""


Job = TypeVar("Job", bound=Keyed)


@contextmanager
def pool(
    evaluate: Callable[[Job], Record], most: int, scheduler: str | None
) -> Iterator[Callable[[Sequence[Job]], Iterator[Record]]]:
    """A function that evaluates jobs, and gives each record as soon as it is there.

    Args:
        evaluate: called with each job, in another process.
        most: largest number of jobs at a time; without any, nothing is started.
        scheduler: address of a Dask scheduler; all cores of this machine by default.

    Raises:
        OutputError: if the scheduler cannot be used.
        BuildError: if workers fail.
    """
    if not most:
        yield lambda _: iter(())
    elif scheduler:
        with _on_cluster(evaluate, scheduler) as evaluated:
            yield evaluated
    else:
        with workers(most) as processes:
            yield partial(_here, processes.submit, evaluate)


def _here(
    submit: Callable[..., Future[Record]],
    evaluate: Callable[[Job], Record],
    jobs: Sequence[Job],
) -> Iterator[Record]:
    try:
        for future in as_completed([submit(evaluate, job) for job in jobs]):
            yield future.result()
    except BrokenProcessPool as error:
        raise BuildError(
            "a worker was stopped from outside; the same command again goes on from here"
        ) from error


@contextmanager
def _on_cluster(
    evaluate: Callable[[Job], Record], scheduler: str
) -> Iterator[Callable[[Sequence[Job]], Iterator[Record]]]:
    try:
        from distributed import Client
        from distributed import as_completed as as_gathered
    except ModuleNotFoundError as error:
        raise OutputError(
            f"--scheduler {scheduler}: needs Dask: {how_to_install('fab,dask')}"
        ) from error
    try:
        client = Client(scheduler, timeout=10)
    except (OSError, ValueError) as error:
        raise OutputError(
            f"--scheduler {scheduler}: no scheduler answers there ({error}); start one with `dask "
            "scheduler`, and workers with `dask worker ADDRESS`"
        ) from error

    def evaluated(jobs: Sequence[Job]) -> Iterator[Record]:
        futures = client.map(evaluate, jobs, key=[job.key for job in jobs], retries=2)
        try:
            for _, record in as_gathered(futures, with_results=True):
                yield record
        finally:
            client.cancel(futures)

    with client:
        yield evaluated
