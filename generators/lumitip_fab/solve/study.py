"""A whole study: search, points of the front, and the estimator's errors with each."""

from collections import Counter
from collections.abc import Sequence
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from lumitip.grid import Floats
from lumitip.tasks.bench import workers
from lumitip_fab.derive import resolve
from lumitip_fab.errors import BuildError
from lumitip_fab.explore.accuracy import Sample, gross, rms
from lumitip_fab.explore.evaluate import rounded
from lumitip_fab.pipeline.fingerprint import made_with
from lumitip_fab.solve import confirm
from lumitip_fab.solve.goals import Task
from lumitip_fab.solve.information import Expected, expected
from lumitip_fab.solve.judge import excesses
from lumitip_fab.solve.judged import Judged
from lumitip_fab.solve.search import Progress, Search, search

MOST_GROSS_PERCENT = 1.0
"""Largest share of the estimator's poses with a gross error where goals are met (%): these hardly
move an rms error, and a robot acts on each."""


@dataclass(frozen=True)
class Options:
    """Settings of a study."""

    designs: int = 600
    """Judged, about."""
    points: int = 5
    """Of the front, that the estimator tries."""
    seed: int = 0
    sample: Sample = field(default_factory=Sample)


@dataclass(frozen=True, eq=False)
class Point:
    """The base, or one point of the front."""

    name: str
    """`"base"`, or `"point-1"` for the least error, and so on."""
    judged: Judged
    confirmed: dict[str, float]
    """Errors of the estimator, see `confirm.figures`."""
    tried: tuple[dict[str, Any], ...]
    """Errors of each trial: kind, gap, diameter of a cable, rms errors, gross errors."""
    expected: Expected


@dataclass(frozen=True, eq=False)
class Study:
    """Results of a study."""

    task: Task
    options: Options
    search: Search
    points: tuple[Point, ...]
    """The base first."""

    def meets(self, point: Point) -> bool:
        """Whether a point keeps all limits, and the estimator's errors with it all goals and
        `MOST_GROSS_PERCENT`."""
        goals = self.task.targets.errors | {"gross_percent": MOST_GROSS_PERCENT}
        return point.judged.allowed and all(
            point.confirmed[name] <= goal for name, goal in goals.items()
        )

    @property
    def nearest(self) -> Judged | None:
        """Without any design that keeps all limits: the one that is closest to them."""
        possible = [one for one in self.search.designs if one.figures]
        return None if self.search.front else min(possible, key=_excess, default=None)

    @property
    def refused(self) -> list[tuple[str, int]]:
        """Reasons why designs are refused, and how many each, the most frequent first."""
        return Counter(text for one in self.search.designs for text in one.refused).most_common()


def _excess(one: Judged) -> float:
    return one.excess


def study(
    task: Task, out: Path, options: Options, scheduler: str | None, progress: Progress
) -> Study:
    """Search, then confirm; see `search.search` for the errors."""
    found = search(task, out, options.designs, options.seed, scheduler, progress)
    chosen = {"base": found.base}
    chosen |= {f"point-{n}": one for n, one in enumerate(_spread(found.front, options.points), 1)}
    layouts = {
        name: resolve(task.design(one.changes)).design.layout for name, one in chosen.items()
    }
    trials = {
        name: confirm.trials(layouts[name], task.targets, one.figures["exposure"], options.sample)
        for name, one in chosen.items()
    }
    every = [trial for each in trials.values() for trial in each]
    with workers(len(every)) as pool:
        try:
            misses = iter(list(pool.map(confirm.Trial.misses, every)))
        except BrokenProcessPool as error:
            raise BuildError("a worker was stopped from outside; run it again") from error
    points = []
    for name, one in chosen.items():
        rows = [(trial.kind, next(misses)) for trial in trials[name]]
        figures = {n: rounded(v) for n, v in confirm.figures(rows, task.targets).items()}
        tried = tuple(map(_tried, trials[name], (missed for _, missed in rows)))
        gain = trials[name][0].grasp.gain
        known = expected(layouts[name], task.grasps, gain)
        points.append(Point(name, one, figures, tried, known))
    return Study(task, options, found, tuple(points))


def _tried(trial: confirm.Trial, missed: Floats) -> dict[str, Any]:
    grasp = trial.grasp
    width = {"diameter_mm": grasp.diameter_mm} if trial.kind == "cable" else {}
    figures = {
        "error_mm": rms(missed[:, 0]),
        "error_deg": rms(missed[:, 1]),
        "gross_percent": 100.0 * float(gross(missed).mean()),
    }
    return {
        "kind": trial.kind,
        "gap_mm": grasp.gap_mm,
        **width,
        **{name: rounded(value) for name, value in figures.items()},
    }


def _spread(front: Sequence[Judged], count: int) -> list[Judged]:
    """Some points of a front, evenly over it, both ends among them."""
    if len(front) <= count:
        return list(front)
    at = np.unique(np.linspace(0, len(front) - 1, count).round().astype(int))
    return [front[n] for n in at]


def _nearest(found: Study) -> dict[str, Any] | None:
    """The design that is closest to the limits, and by what share it is beyond them; none where a
    design keeps them all, or all are refused."""
    if (one := found.nearest) is None:
        return None
    beyond = excesses(one.figures, found.task.limits).items()
    return {
        "changes": dict(one.changes),
        "columns": list(one.columns),
        "figures": dict(sorted(one.figures.items())),
        "beyond": {name: rounded(share) for name, share in beyond if share > 0.0},
    }


def summary(found: Study) -> dict[str, Any]:
    """The study as plain JSON."""
    return {
        "made_with": made_with("solve", "numpy", "scipy", "pymoo"),
        "base": found.task.base.sources[0].path.name,
        "fixed": dict(found.task.fixed),
        "well_exposed": str(found.search.reference),
        "keep_size": found.task.keep_size,
        "goals": found.task.targets.model_dump(exclude_none=True),
        "limits": {
            name: value
            for name, value in found.task.limits.model_dump().items()
            if np.isfinite(value) and value
        },
        "vary": {axis.field: list(axis.values) for axis in found.task.axes},
        "designs": found.task.designs,
        "judged": len(found.search.designs),
        "refused": [{"reason": text, "designs": count} for text, count in found.refused],
        "nearest": _nearest(found),
        "complete": found.search.complete,
        "seed": found.options.seed,
        "evidence": {
            "expected": "simulated with our own model, Fisher information, optics unknown",
            "confirmed": confirm.EVIDENCE,
        },
        "currency": found.task.base.catalogue.prices.currency,
        "points": [
            {
                "name": point.name,
                "changes": dict(point.judged.changes),
                "columns": list(point.judged.columns),
                "figures": dict(sorted(point.judged.figures.items())),
                "confirmed": point.confirmed,
                "confirmed_meets_goals": found.meets(point),
                "tried": list(point.tried),
            }
            for point in found.points
        ],
    }
