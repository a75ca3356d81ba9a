"""Trials of a task, and the tuning of a law over many of them."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass, replace
from functools import lru_cache, partial
from itertools import product

import numpy as np

from lumitip.control import CentreLaw, LineLaw, Tracer
from lumitip.estimation import Estimate, PoseEstimator
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.processing import Contact, Processor
from lumitip.tasks.task import Metrics, Settings, Task, TaskError
from lumitip.twin import Cable, HalfPlane, Twin
from lumitip.values import shown

Observer = Callable[[Floats], Contact | Estimate]
CONTROLLERS = ("centre", "line", "pose")
"""`centre`: the published law with the published processing; `line`: angle feed-forward with the
same processing; `pose`: angle feed-forward with the pose estimator."""
_LONGEST_S = 120.0


@dataclass(frozen=True)
class Tuning:
    """Tuning parameters of a controller."""

    gain_per_s: float = 8.0
    turn_per_s: float = 8.0
    lead_s: float = 0.0
    height_mm: float = 0.0
    """For the published law alone: target of the dark centre above its height with a straight line
    in the middle (mm). With a turned line the dark centre is lower."""


class Bench:
    """Task, estimator and processor for trials."""

    def __init__(self, task: Task) -> None:
        self.task = task
        layout, kind = task.layout, task.settings.kind
        self._processor = Processor(layout)
        self._estimator = PoseEstimator(layout, tracking=True)
        self._kind = "cable" if kind == "cable" else None if task.settings.corner else "edge"
        self._centre_mm = centre_height_mm(task.twin, task.settings)

    def observer(self, controller: str) -> Observer:
        """The function that turns values into the controller's input.

        Raises:
            TaskError: if there is no such controller.
        """
        if not isinstance(controller, str) or controller not in CONTROLLERS:
            raise TaskError(
                f"controller is {shown(controller)}; allowed are {', '.join(CONTROLLERS)}"
            )
        if controller != "pose":
            return self._processor
        self._estimator.reset()
        return lambda values: self._estimator(values, self._kind)

    def tracer(self, controller: str, speed_mm_s: float, tuning: Tuning) -> Tracer:
        """A controller without history."""
        corner_at_mm = 0.0 if self.task.settings.corner else None
        if controller == "centre":
            centre_mm = self._centre_mm + tuning.height_mm
            law: CentreLaw | LineLaw = CentreLaw(speed_mm_s, tuning.gain_per_s, centre_mm)
        else:
            target_mm = self.task.settings.target_mm
            law = LineLaw(speed_mm_s, tuning.gain_per_s, tuning.turn_per_s, target_mm)
        return Tracer(law, corner_at_mm=corner_at_mm, lead_s=tuning.lead_s)

    def run(self, controller: str, speed_mm_s: float, tuning: Tuning, seed: int) -> Metrics:
        """One trial on the curve of a seed."""
        tracer, observe = self.tracer(controller, speed_mm_s, tuning), self.observer(controller)
        values, ended = self.task.reset(seed), False
        dt_s = 1.0 / self.task.settings.rate_hz
        for _ in range(round(_LONGEST_S * self.task.settings.rate_hz)):
            values, ended = self.task.step(tracer(observe(values), dt_s))
            if ended:
                return self.task.metrics()
        return replace(self.task.metrics(), reason="lost")

    def run_all(
        self, controller: str, speed_mm_s: float, tuning: Tuning, seeds: Iterable[int]
    ) -> list[Metrics]:
        """One trial on the curve of each seed."""
        return [self.run(controller, speed_mm_s, tuning, seed) for seed in seeds]


class Team:
    """A `Bench` in each process of a pool, with the same results."""

    def __init__(self, pool: Executor, layout: Layout, settings: Settings) -> None:
        self._pool, self._layout, self._settings = pool, layout, settings

    def run_all(
        self, controller: str, speed_mm_s: float, tuning: Tuning, seeds: Iterable[int]
    ) -> list[Metrics]:
        run = partial(_run, self._layout, self._settings, (controller, speed_mm_s, tuning))
        return list(self._pool.map(run, seeds))


def _run(
    layout: Layout, settings: Settings, trial: tuple[str, float, Tuning], seed: int
) -> Metrics:
    return _bench(layout, settings).run(*trial, seed)


@lru_cache(maxsize=4)
def _bench(layout: Layout, settings: Settings) -> Bench:
    return Bench(Task(layout, settings))


def centre_height_mm(twin: Twin, settings: Settings) -> float:
    """Height of the dark centre when the line is at its target (mm)."""
    if settings.kind == "cable":
        values = twin.values(Cable(offset_mm=settings.target_mm))
    else:
        values = twin.values(HalfPlane(offset_mm=-settings.target_mm, angle_deg=180.0))
    centre = Processor(twin.layout)(values).centre_mm
    return centre[1] if centre else settings.target_mm


@dataclass(frozen=True)
class Summary:
    """Many trials of one controller at one speed."""

    speed_mm_s: float
    trials: int
    losses: int
    lateral_rms_mm: float
    angle_rms_deg: float
    corner_rms_mm: float

    @property
    def loss_rate(self) -> float:
        """Share of the trials that lost the line."""
        return self.losses / self.trials


def summary(
    bench: Bench | Team,
    controller: str,
    speed_mm_s: float,
    tuning: Tuning,
    seeds: Iterable[int],
) -> Summary:
    """Run trials; root mean squares are over those that kept the line."""
    done = bench.run_all(controller, speed_mm_s, tuning, seeds)
    kept = [m for m in done if not m.lost]
    corners = [m.corner_error_mm for m in kept if not np.isnan(m.corner_error_mm)]
    return Summary(
        speed_mm_s,
        len(done),
        len(done) - len(kept),
        _rms([m.lateral_rms_mm for m in kept]),
        _rms([m.angle_rms_deg for m in kept]),
        _rms(corners),
    )


def _rms(values: Sequence[float]) -> float:
    return float(np.sqrt(np.mean(np.square(values)))) if values else float("nan")


LINE_GRID = tuple(
    Tuning(*of)
    for of in product((8.0, 12.0, 16.0, 20.0, 24.0, 32.0), (6.0, 10.0, 14.0), (0.0, 0.03, 0.06))
)
_CENTRE_RATIO = 1.75
"""Approximate ratio of the gains of `CENTRE_GRID`."""
CENTRE_GRID = tuple(
    Tuning(gain_per_s, height_mm=height_mm)
    for gain_per_s, height_mm in product(
        (6.0, 10.0, 18.0, 32.0, 56.0, 96.0), (1.0, 0.0, -1.0, -2.0, -3.0)
    )
)
GRIDS = {"centre": CENTRE_GRID, "line": LINE_GRID, "pose": LINE_GRID}
SEEDS = tuple(range(10_000, 10_012))
"""Curves for tuning; those of the test begin at 0."""
SPEEDS_MM_S = {
    ("centre", "cloth"): 200.0,
    ("centre", "cable"): 160.0,
    ("line", "cloth"): 320.0,
    ("line", "cable"): 320.0,
    ("pose", "cloth"): 320.0,
    ("pose", "cable"): 320.0,
}
"""Speed at which each controller begins to fail, by controller and kind of task."""
_NAMES = {"gain_per_s": "K_p", "turn_per_s": "K_θ", "lead_s": "lead", "height_mm": "height"}


@dataclass(frozen=True)
class Tuned:
    """The best of the tried tunings."""

    tuning: Tuning
    speed_mm_s: float
    """Speed of the curves for tuning (mm/s)."""
    losses: int
    """Number of these curves that it lost."""
    tried: int
    """Number of tried tunings."""
    at_edge: tuple[str, ...]
    """Parameters whose best value is the smallest or largest that was tried; a better one may be
    beyond."""


def search(
    bench: Bench | Team,
    controller: str,
    speed_mm_s: float,
    grids: Mapping[str, Sequence[Tuning]] = GRIDS,
    seeds: Sequence[int] = SEEDS,
) -> Tuned:
    """The tuning with fewest losses, and of these with least lateral rms, on curves for tuning.

    Args:
        bench: runs the trials.
        controller: of `CONTROLLERS`.
        speed_mm_s: on the curves for tuning (mm/s).
        grids: tunings to try; those of the published law are refined around the best.
        seeds: curves for tuning.
    """
    tried = list(grids[controller])
    scores = {tuning: _score(bench, controller, speed_mm_s, tuning, seeds) for tuning in tried}
    if controller == "centre":
        for tuning in around(min(tried, key=scores.__getitem__)):
            scores[tuning] = _score(bench, controller, speed_mm_s, tuning, seeds)
    best = min(scores, key=scores.__getitem__)
    return Tuned(best, speed_mm_s, scores[best][0], len(scores), at_edge(best, list(scores)))


def around(best: Tuning) -> list[Tuning]:
    """The 24 tunings of the published law between one of `CENTRE_GRID` and its neighbours."""
    return [
        replace(
            best,
            gain_per_s=best.gain_per_s * _CENTRE_RATIO ** (i / 3.0),
            height_mm=best.height_mm + j / 3.0,
        )
        for i, j in product(range(-2, 3), repeat=2)
        if (i, j) != (0, 0)
    ]


def at_edge(best: Tuning, tried: Sequence[Tuning]) -> tuple[str, ...]:
    """Names of the parameters at the end of their tried range."""
    ends = {name: {min(of), max(of)} for name in _NAMES if len(of := _values(tried, name)) > 1}
    return tuple(_NAMES[name] for name, of in ends.items() if asdict(best)[name] in of)


def _values(tried: Sequence[Tuning], name: str) -> set[float]:
    return {float(getattr(tuning, name)) for tuning in tried}


def _score(
    bench: Bench | Team, controller: str, speed_mm_s: float, tuning: Tuning, seeds: Sequence[int]
) -> tuple[int, float]:
    result = summary(bench, controller, speed_mm_s, tuning, seeds)
    return result.losses, result.lateral_rms_mm if result.losses < result.trials else math.inf
