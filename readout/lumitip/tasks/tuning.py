"""The search for a controller's tuning: as many tunings for each, on the same curves, by one rule.

The law of the line has three parameters and one grid of 54 tunings. The published law has two, its
gain and the height at which it holds the dark centre: a grid of 30, then 24 around the best.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import product

from lumitip.tasks.trial import Bench, Team, Tuning, summary

LINE_GRID = tuple(Tuning(*of) for of in product((8.0, 12.0, 16.0, 20.0, 24.0, 32.0),
                                                (6.0, 10.0, 14.0), (0.0, 0.03, 0.06)))  # fmt: skip
_CENTRE_RATIO = 1.75
"""About this much apart are the gains of `CENTRE_GRID`."""
CENTRE_GRID = tuple(
    Tuning(gain_per_s, height_mm=height_mm)
    for gain_per_s, height_mm in product((6.0, 10.0, 18.0, 32.0, 56.0, 96.0),
                                         (1.0, 0.0, -1.0, -2.0, -3.0))
)  # fmt: skip
GRIDS = {"centre": CENTRE_GRID, "line": LINE_GRID, "pose": LINE_GRID}
SEEDS = tuple(range(10_000, 10_012))
"""Curves to tune on, others than those of the test, which begin at 0."""
SPEEDS_MM_S = {
    ("centre", "cloth"): 200.0, ("centre", "cable"): 160.0,
    ("line", "cloth"): 320.0, ("line", "cable"): 320.0,
    ("pose", "cloth"): 320.0, ("pose", "cable"): 320.0,
}  # fmt: skip
"""Where each begins to fail, where tuning matters, by controller and kind of task."""
_NAMES = {"gain_per_s": "K_p", "turn_per_s": "K_θ", "lead_s": "lead", "height_mm": "height"}


@dataclass(frozen=True)
class Tuned:
    """The best of the tunings that were tried."""

    tuning: Tuning
    speed_mm_s: float
    """Speed of the curves that it was chosen on (mm/s)."""
    losses: int
    """How many of these curves it lost."""
    tried: int
    """How many tunings were tried."""
    at_edge: tuple[str, ...]
    """Parameters whose best value is the least or the largest that was tried: a better one may
    lie beyond."""


def search(
    bench: Bench | Team,
    controller: str,
    speed_mm_s: float,
    grids: Mapping[str, Sequence[Tuning]] = GRIDS,
    seeds: Sequence[int] = SEEDS,
) -> Tuned:
    """The tuning with fewest losses, among these of least lateral rms, on curves for tuning.

    Args:
        bench: what runs the trials.
        controller: of `CONTROLLERS`.
        speed_mm_s: on the curves for tuning (mm/s).
        grids: tunings to begin with; those of the published law are refined around the best.
        seeds: curves to tune on.
    """
    tried = list(grids[controller])
    scores = {tuning: _score(bench, controller, speed_mm_s, tuning, seeds) for tuning in tried}
    if controller == "centre":
        for tuning in around(min(tried, key=scores.__getitem__)):
            scores[tuning] = _score(bench, controller, speed_mm_s, tuning, seeds)
    best = min(scores, key=scores.__getitem__)
    return Tuned(best, speed_mm_s, scores[best][0], len(scores), at_edge(best, list(scores)))


def around(best: Tuning) -> list[Tuning]:
    """The 24 tunings of the published law that lie between one of `CENTRE_GRID` and the next."""
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
    """Names of the parameters that are at the end of what was tried of them."""
    ends = {name: {min(of), max(of)} for name in _NAMES if len(of := _values(tried, name)) > 1}
    return tuple(_NAMES[name] for name, of in ends.items() if asdict(best)[name] in of)


def _values(tried: Sequence[Tuning], name: str) -> set[float]:
    return {float(getattr(tuning, name)) for tuning in tried}


def _score(
    bench: Bench | Team, controller: str, speed_mm_s: float, tuning: Tuning, seeds: Sequence[int]
) -> tuple[int, float]:
    told = summary(bench, controller, speed_mm_s, tuning, seeds)
    return told.losses, told.lateral_rms_mm if told.losses < told.trials else math.inf
