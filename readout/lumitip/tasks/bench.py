"""The bench of the tasks: every controller tuned on the same grid, then ever faster.

Tuning and tests run on different curves. Speeds rise until a controller loses more than one curve
in ten; its highest speed at a loss is the last one before it loses more.
"""

from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import dataclass

from lumitip.cores import workers
from lumitip.layout import Layout
from lumitip.tasks.task import Settings, Task
from lumitip.tasks.trial import CONTROLLERS, Bench, Summary, Team, Tuning, summary, tune

SPEEDS_MM_S = (30.0, 40.0, 50.0, 60.0, 80.0, 120.0, 160.0, 200.0, 240.0, 280.0, 320.0)
_FIRST_MM_S = {"centre": 0.0, "line": 160.0, "pose": 160.0}
"""Slower speeds are not tried: they take longest, and a law that holds a fast one holds them."""
GRID = tuple(Tuning(gain, turn) for gain in (4.0, 8.0, 12.0) for turn in (6.0, 10.0, 14.0))
TUNING_SEEDS = tuple(range(10_000, 10_006))
_TUNED_AT_MM_S = {"centre": 50.0, "line": 240.0, "pose": 240.0}
"""Near where each begins to fail, where tuning matters."""
TASKS = {
    "cloth": Settings("cloth"), "cable": Settings("cable"),
    "corner": Settings("cloth", corner=True),
}  # fmt: skip
_ENOUGH = 0.1  # share of lost curves above which faster ones are not tried


@dataclass(frozen=True)
class Result:
    """One controller on one task."""

    task: str
    controller: str
    tuning: Tuning
    rows: tuple[Summary, ...]

    def fastest(self, loss_rate: float = 0.0) -> Summary | None:
        """The last speed up to which no more than this share of the curves was lost."""
        kept = None
        for row in self.rows:
            if row.loss_rate > loss_rate:
                break
            kept = row
        return kept


def bench_tasks(
    layout: Layout,
    trials: int,
    say: Callable[[str], object],
    controllers: Sequence[str] = CONTROLLERS,
    speeds_mm_s: Sequence[float] | None = None,
    grid: Sequence[Tuning] = GRID,
    tuning_seeds: Sequence[int] = TUNING_SEEDS,
    cores: int = 1,
) -> list[Result]:
    """Every controller on cloth, on cable, and on cloth up to its corner.

    Args:
        layout: the cells.
        trials: curves at each speed.
        say: called with each line of the table as it is known.
        controllers: of `CONTROLLERS`.
        speeds_mm_s: rising (mm/s); if not given, those at which a controller is worth trying.
        grid: tunings to choose from.
        tuning_seeds: curves to tune on, others than those of the test, which begin at 0.
        cores: processes that share the trials; the results are the same.
    """
    results = []
    with workers(cores) if cores > 1 else nullcontext() as pool:
        for name, settings in TASKS.items():
            bench = Team(pool, layout, settings) if pool else Bench(Task(layout, settings))
            for controller in controllers:
                tuning = tune(bench, controller, _TUNED_AT_MM_S[controller],
                              _distinct(grid, controller), tuning_seeds)  # fmt: skip
                kept = f"K_p {tuning.gain_per_s:g}/s, K_θ {tuning.turn_per_s:g}/s"
                say(f"{name}, {controller}: {kept}")
                speeds = speeds_mm_s or [v for v in SPEEDS_MM_S if v >= _FIRST_MM_S[controller]]
                rows = _faster(bench, controller, tuning, speeds, trials, say)
                results.append(Result(name, controller, tuning, rows))
    return results


def _distinct(grid: Sequence[Tuning], controller: str) -> Sequence[Tuning]:
    """Tunings that differ for a controller: the published law does not turn."""
    if controller != "centre":
        return grid
    return list({tuning.gain_per_s: tuning for tuning in reversed(grid)}.values())[::-1]


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
    corner = (
        "" if row.corner_rms_mm != row.corner_rms_mm else f", corner {row.corner_rms_mm:.2f} mm"
    )
    return (
        f"  {row.speed_mm_s:4.0f} mm/s: {row.losses:3} of {row.trials} lost, "
        f"{row.lateral_rms_mm:.2f} mm, {row.angle_rms_deg:.1f}°{corner}"
    )
