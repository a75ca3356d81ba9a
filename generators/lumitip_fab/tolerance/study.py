"""A study of tolerances: yield, error percentiles, sensitivities, and how far a mask may be off."""

import math
from collections.abc import Callable, Iterator
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from lumitip.estimation import EstimationError
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.tasks.bench import workers
from lumitip.twin import Model, TwinError
from lumitip_fab.config.load import Input
from lumitip_fab.config.messages import shown_path
from lumitip_fab.derive.making.tolerances import fingerprint, spreads
from lumitip_fab.errors import BuildError, InputError, Problem
from lumitip_fab.tolerance.bench import COLUMNS, Case, bench
from lumitip_fab.tolerance.draws import FACTORS, Draws, draw
from lumitip_fab.tolerance.sobol import indices, mixed

EVIDENCE = "simulated with our own model"
_TARED = COLUMNS[1:2]
_CHUNK = 20  # fingers
_NINE = (50, 90, 95)  # percentiles of the errors
MASK_FINGERS = 200
"""Fingers by which it is found how far a mask may be off."""
_MASK_YIELD = 0.95
_MASK_STEPS, _MASK_STEP_MM = 32, 0.05
_BEST = 3  # deviations of which the yield without them is computed
_SEARCHED = 10  # fingers that the whole estimator is compared on
_DIGITS = 4


@dataclass(frozen=True)
class Goals:
    """A finger is good if edges and cables are both estimated within these, rms over its poses."""

    position_mm: float = 0.6
    angle_deg: float = 2.5


@dataclass(frozen=True)
class Options:
    """Settings of a study."""

    goals: Goals = Goals()
    gap_mm: float = 3.0
    """Expected gap of a grasp (mm)."""
    fingers: int = 500
    """Built pairs of fingers."""
    poses: int = 16
    """Of edges, and as many of cables, with each."""
    seed: int = 0

    def __post_init__(self) -> None:
        limits = {
            "--position": (self.goals.position_mm, 0.01, 2.0, " mm"),
            "--angle": (self.goals.angle_deg, 0.05, 10.0, " degrees"),
            "--gap": (self.gap_mm, 1.0, 10.0, " mm"),
            "--fingers": (self.fingers, 16, 100_000, " fingers"),
            "--poses": (self.poses, 4, 1000, " poses"),
            "--seed": (self.seed, 0, 2**32 - 1, ""),
        }
        wrong = [
            Problem(name, 0, "", f"is {value:g}{unit}; {least:.10g} to {most:.10g} is allowed")
            for name, (value, least, most, unit) in limits.items()
            if not least <= value <= most
        ]
        if wrong:
            raise InputError(wrong)


Errors = Callable[[Draws, tuple[str, ...]], Floats]
"""Errors of fingers as `Bench.errors` has them."""


def study(
    config: Input, layout: Layout, options: Options, cores: int | None = None
) -> dict[str, Any]:
    """All figures of a study, as plain JSON; the same for any number of cores.

    Args:
        config: the parameter file.
        layout: the cells of its design.
        options: goals and sizes.
        cores: processes at most; all cores by default.

    Raises:
        InputError: if the layout has too few cells.
        BuildError: if a worker is stopped.
    """
    case = case_of(config, layout, options)
    table, spread = config.catalogue.tolerances, spreads(config)
    take = partial(draw, table, spread, len(layout))
    drawn = take(options.fingers, options.seed)
    with on_cores(case, cores) as errors:
        columns = errors(drawn, COLUMNS)
        sensitive = _sensitivities(errors, take, options)
        names = sorted(FACTORS, key=lambda name: -max(sensitive[name]["total"].values()))
        without = {
            name: yield_of(errors({**drawn, name: 0.0 * drawn[name]}, _TARED)[0], options.goals)
            for name in names[:_BEST]
        }
        few = take(min(MASK_FINGERS, options.fingers), options.seed)
        mask_mm = mask_allowance_mm(errors, few, options.goals)
    entries = {
        name: {
            "title": entry.title,
            "spread": _rounded(spread[name]),
            "unit": entry.unit,
            "distribution": entry.distribution,
            "confidence": entry.confidence,
            "source": entry.source,
            "measure": entry.measure,
            **sensitive[name],
        }
        for name, entry in ((name, getattr(table, name)) for name in names)
    }
    return {
        "design": config.parameters.name,
        "fingerprint": fingerprint(config, layout),
        "evidence": EVIDENCE,
        "goals": vars(options.goals),
        "gap_mm": options.gap_mm,
        "fingers": options.fingers,
        "poses": {"edge": options.poses, "cable": options.poses},
        "seed": options.seed,
        "columns": {
            name: _column(rows, options.goals) for name, rows in zip(COLUMNS, columns, strict=True)
        },
        "tolerances": entries,
        "yield_if_exact": {name: _rounded(value) for name, value in without.items()},
        "mask_shift_mm": mask_mm,
        "pose_estimator": bench(case).compared(take(_SEARCHED, options.seed)),
    }


def case_of(config: Input, layout: Layout, options: Options) -> Case:
    """The case of a design.

    Raises:
        InputError: if no pose can be estimated with its cells.
    """
    case = Case(layout, Model.from_layout(layout, options.gap_mm), options.poses, options.seed)
    try:
        bench(case)
    except (EstimationError, TwinError) as error:
        file = shown_path(config.sources[0].path)
        raise InputError([Problem(file, 0, "grid.columns", str(error))]) from error
    return case


def mask_allowance_mm(errors: Errors, drawn: Draws, goals: Goals) -> float | None:
    """How far both masks may be off: the largest shift, in a random direction each, with which 95 %
    of the fingers meet the goals after a tare, all else as drawn; none if not even 0 does."""
    way = drawn["mask_shift"].reshape(-1, 2, 2)
    way = way / np.maximum(np.linalg.norm(way, axis=2, keepdims=True), 1e-9)

    def holds(steps: int) -> bool:
        shifted = {**drawn, "mask_shift": (steps * _MASK_STEP_MM * way).reshape(len(way), 4)}
        return yield_of(errors(shifted, _TARED)[0], goals) >= _MASK_YIELD

    low, high = -1, _MASK_STEPS
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return round(low * _MASK_STEP_MM, 2) if low >= 0 else None


def _sensitivities(
    errors: Errors, take: Callable[[int, int], Draws], options: Options
) -> dict[str, dict[str, dict[str, float]]]:
    """Sobol indices of every deviation for the errors after a tare."""
    count = 2 ** int(math.log2(options.fingers / 2))
    a, b = take(count, options.seed), take(count, options.seed + 1)
    sets = [a, b, *(mixed(a, b, name) for name in FACTORS)]
    together = {name: np.concatenate([one[name] for one in sets]) for name in FACTORS}
    worst = worst_of(errors(together, _TARED)[0]).T
    of_a, of_b, *others = np.split(worst, len(sets), axis=1)
    found = indices(of_a, of_b, np.array(others), options.seed)
    return {
        name: {
            kind: {
                figure: _rounded(getattr(found, kind)[row, number])
                for row, figure in enumerate(("position", "angle"))
            }
            for kind in ("first", "first_sd", "total", "total_sd")
        }
        for number, name in enumerate(FACTORS)
    }


def worst_of(rows: Floats) -> Floats:
    """Errors of position (mm) and angle (degrees), the worse of edges and cables, from those of
    both kinds, shape `(fingers, 2)`."""
    return np.maximum(rows[:, :2], rows[:, 2:])


def yield_of(rows: Floats, goals: Goals) -> float:
    """Share of fingers whose errors, as `Bench.errors` has them, meet the goals."""
    worst = worst_of(rows)
    return float(np.mean((worst[:, 0] <= goals.position_mm) & (worst[:, 1] <= goals.angle_deg)))


def _column(rows: Floats, goals: Goals) -> dict[str, Any]:
    share = yield_of(rows, goals)
    names = ("edge_mm", "edge_deg", "cable_mm", "cable_deg")
    return {
        "yield": _rounded(share),
        "yield_95": [_rounded(end) for end in wilson(share, len(rows))],
        **{
            name: {str(p): _rounded(value) for p, value in zip(_NINE, values, strict=True)}
            for name, values in zip(names, np.percentile(rows, _NINE, axis=0).T, strict=True)
        },
    }


def wilson(share: float, count: int) -> tuple[float, float]:
    """Interval that has the true share with 95 % (Wilson)."""
    z = 1.96
    middle, scale = share + z * z / (2 * count), 1.0 + z * z / count
    half = z * math.sqrt(share * (1.0 - share) / count + (z / (2 * count)) ** 2)
    return max((middle - half) / scale, 0.0), min((middle + half) / scale, 1.0)


@contextmanager
def on_cores(case: Case, cores: int | None) -> Iterator[Errors]:
    """A function like `Bench.errors` on several processes."""
    if cores == 1:
        yield bench(case).errors
        return
    with workers(cores or 1_000) as pool:

        def errors(drawn: Draws, columns: tuple[str, ...]) -> Floats:
            count = len(drawn["gap"])
            parts = [
                (case, {name: rows[at : at + _CHUNK] for name, rows in drawn.items()}, columns)
                for at in range(0, count, _CHUNK)
            ]
            try:
                return np.concatenate(list(pool.map(_errors_of, parts)), axis=1)
            except BrokenProcessPool as error:
                raise BuildError("a worker was stopped from outside; run it again") from error

        yield errors


def _errors_of(part: tuple[Case, Draws, tuple[str, ...]]) -> Floats:
    case, drawn, columns = part
    return bench(case).errors(drawn, columns)


def _rounded(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}")
