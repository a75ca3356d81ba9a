"""Errors of many fingers, on all cores."""

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lumitip.grid import Floats
from lumitip.tasks.bench import workers
from lumitip_fab.errors import BuildError
from lumitip_fab.tolerance.bench import COLUMNS, POSE_SETS, Case, errors_over
from lumitip_fab.tolerance.draws import Draws

_CHUNK = 20  # fingers
Indices = NDArray[np.intp]
Errors = Callable[[Draws, tuple[str, ...]], Floats]
"""Errors of fingers as `Bench.errors` has them."""
Part = tuple[tuple[Case, ...], int, Draws, tuple[str, ...], Indices]
"""Fingers of one set of poses: its number, their deviations, the columns, and their places."""
Run = Callable[[Callable[[Part], tuple[Indices, Floats]], list[Part]], Iterable[Any]]
"""`map`, here or on several processes."""


@contextmanager
def on_cores(cases: tuple[Case, ...], cores: int | None) -> Iterator[Errors]:
    """A function like `Bench.errors` on several processes; one finger after the other is tried at
    the next of `POSE_SETS`."""
    if cores == 1:
        yield partial(_errors, cases, map)
        return
    with workers(cores or 1_000) as pool:
        try:
            yield partial(_errors, cases, pool.map)
        except BrokenProcessPool as error:
            raise BuildError("a worker was stopped from outside; run it again") from error


def _errors(
    cases: tuple[Case, ...], run: Run, drawn: Draws, columns: tuple[str, ...] = COLUMNS
) -> Floats:
    count = len(drawn["gap"])
    parts: list[Part] = [
        (cases, number, {name: rows[some] for name, rows in drawn.items()}, columns, some)
        for number in range(min(POSE_SETS, count))
        for all_ in [np.arange(number, count, POSE_SETS)]
        for some in np.split(all_, range(_CHUNK, len(all_), _CHUNK))
    ]
    found = np.empty((len(columns), count, 5))
    for some, errors in run(_errors_of, parts):
        found[:, some] = errors
    return found


def _errors_of(part: Part) -> tuple[Indices, Floats]:
    cases, number, drawn, columns, some = part
    return some, errors_over(cases, number, drawn, columns)
