"""Benchmark of all tasks with all laws, on several cores."""

import math
import os
import signal
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from multiprocessing.context import SpawnContext, SpawnProcess
from typing import ParamSpec, TypeVar

from lumitip.interrupt import InterruptsHeld
from lumitip.layout import Layout
from lumitip.tasks.task import Settings, Task
from lumitip.tasks.trial import (
    CONTROLLERS,
    GRIDS,
    SEEDS,
    Bench,
    Summary,
    Team,
    Tuned,
    Tuning,
    search,
    summary,
)
from lumitip.tasks.trial import SPEEDS_MM_S as TUNED_AT_MM_S

_P = ParamSpec("_P")
_T = TypeVar("_T")
_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


class _Worker(SpawnProcess):
    """A process that ignores Ctrl-C from its very start: its parent ends it."""

    def start(self) -> None:
        """Start with SIGINT blocked, which a new process inherits."""
        if not hasattr(signal, "pthread_sigmask"):  # on Windows
            super().start()
            return
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            super().start()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


class _WorkerContext(SpawnContext):
    Process = _Worker


class _Pool(ProcessPoolExecutor):
    """Ctrl-C waits until a worker has started: one that is half started would print a traceback."""

    def submit(self, fn: Callable[_P, _T], /, *args: _P.args, **kwargs: _P.kwargs) -> Future[_T]:
        with InterruptsHeld():
            return super().submit(fn, *args, **kwargs)


@contextmanager
def workers(most: int) -> Iterator[ProcessPoolExecutor]:
    """A pool of new processes, one for each core but at most `most`; unfinished work is cancelled.

    Linear algebra uses a single thread in each, since the processes already use all cores. A
    program that calls this needs `if __name__ == "__main__"`.
    """
    context = _WorkerContext()
    with _single_threaded():
        pool = _Pool(min(most, os.cpu_count() or 1), mp_context=context)
        try:
            yield pool
        finally:
            pool.shutdown(cancel_futures=True)


@contextmanager
def _single_threaded() -> Iterator[None]:
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        yield
    finally:
        for name in _THREADS:
            del os.environ[name]
        os.environ.update({name: value for name, value in before.items() if value is not None})


_EVERY = tuple(float(v) for v in range(40, 401, 20))
_FEW = (80.0, 160.0, *(float(v) for v in range(200, 401, 20)))
SPEEDS_MM_S = {"centre": _EVERY, "line": _EVERY, "pose": _FEW}
"""Speeds to try with each controller, up to the limit of the finger's speed."""
TASKS = {
    "cloth": Settings("cloth"),
    "cable": Settings("cable"),
    "corner": Settings("cloth", corner=True),
}
_ENOUGH = 0.1  # share of lost curves above which no higher speed is tried


@dataclass(frozen=True)
class Result:
    """One controller on one task."""

    task: str
    controller: str
    tuned: Tuned
    rows: tuple[Summary, ...]

    def fastest(self, loss_rate: float = 0.0) -> Summary | None:
        """The highest speed up to which at most this share of the curves was lost."""
        kept = None
        for row in self.rows:
            if row.loss_rate > loss_rate:
                break
            kept = row
        return kept


@dataclass(frozen=True)
class Advantage:
    """Speed of a controller with the line's angle against the published law."""

    task: str
    controller: str
    loss_rate: float
    """Allowed share of lost curves."""
    published_mm_s: float
    """Highest speed of the published law at that loss; NaN if it lost more at every speed."""
    speed_mm_s: float
    """The same of the controller."""

    @property
    def times(self) -> float:
        """Ratio of both speeds; NaN if one is missing."""
        return self.speed_mm_s / self.published_mm_s


def advantages(results: Sequence[Result], loss_rate: float = 0.0) -> list[Advantage]:
    """Every controller against the published law on the same task, at equal loss."""

    def speed_mm_s(result: Result) -> float:
        row = result.fastest(loss_rate)
        return row.speed_mm_s if row else math.nan

    published = {r.task: speed_mm_s(r) for r in results if r.controller == "centre"}
    return [
        Advantage(r.task, r.controller, loss_rate, published[r.task], speed_mm_s(r))
        for r in results
        if r.controller != "centre" and r.task in published
    ]


def bench_tasks(
    layout: Layout,
    trials: int,
    say: Callable[[str], object],
    controllers: Sequence[str] = CONTROLLERS,
    speeds_mm_s: Mapping[str, Sequence[float]] = SPEEDS_MM_S,
    grids: Mapping[str, Sequence[Tuning]] = GRIDS,
    tuning_seeds: Sequence[int] = SEEDS,
    cores: int = 1,
) -> list[Result]:
    """Every controller on cloth, on cable, and on cloth up to its corner.

    Args:
        layout: the cells.
        trials: curves at each speed.
        say: called with each line of the table.
        controllers: of `CONTROLLERS`.
        speeds_mm_s: of each controller, rising (mm/s).
        grids: tunings to choose from; a cloth has one tuning, with and without a corner.
        tuning_seeds: curves for tuning; those of the test begin at 0.
        cores: processes that share the trials; they do not change the results.
    """
    results = []
    tunings: dict[tuple[str, str], Tuned] = {}
    with workers(cores) if cores > 1 else nullcontext() as pool:
        for name, settings in TASKS.items():
            bench = Team(pool, layout, settings) if pool else Bench(Task(layout, settings))
            for controller in controllers:
                known = settings.kind, controller
                if known not in tunings:
                    speed_mm_s = TUNED_AT_MM_S[controller, settings.kind]
                    tunings[known] = search(bench, controller, speed_mm_s, grids, tuning_seeds)
                tuned = tunings[known]
                say(f"{name}, {controller}: {tuning_text(controller, tuned)}")
                speeds = speeds_mm_s[controller]
                rows = _faster(bench, controller, tuned.tuning, speeds, trials, say)
                results.append(Result(name, controller, tuned, rows))
    return results


def tuning_text(controller: str, tuned: Tuned) -> str:
    """A tuning and the trials to find it, as text."""
    tuning = tuned.tuning
    text = f"K_p {tuning.gain_per_s:.3g}/s, "
    if controller == "centre":
        text += f"height {tuning.height_mm:+.2f} mm"
    else:
        text += f"K_θ {tuning.turn_per_s:g}/s, lead {tuning.lead_s:g} s"
    edge = f", at the edge of what was tried: {', '.join(tuned.at_edge)}" if tuned.at_edge else ""
    return f"{text} (best of {tuned.tried}, {tuned.losses} lost at {tuned.speed_mm_s:g} mm/s{edge})"


def _faster(
    bench: Bench | Team,
    controller: str,
    tuning: Tuning,
    speeds_mm_s: Sequence[float],
    trials: int,
    say: Callable[[str], object],
) -> tuple[Summary, ...]:
    rows: list[Summary] = []
    for speed_mm_s in speeds_mm_s:
        rows.append(summary(bench, controller, speed_mm_s, tuning, range(trials)))
        say(line(rows[-1]))
        if rows[-1].loss_rate > _ENOUGH:
            break
    return tuple(rows)


def line(row: Summary) -> str:
    """A row as text."""
    corner = "" if math.isnan(row.corner_rms_mm) else f", corner {row.corner_rms_mm:.2f} mm"
    return (
        f"  {row.speed_mm_s:4.0f} mm/s: {row.losses:3} of {row.trials} lost, "
        f"{row.lateral_rms_mm:.2f} mm, {row.angle_rms_deg:.1f}°{corner}"
    )
