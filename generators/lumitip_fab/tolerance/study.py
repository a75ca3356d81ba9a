"""A study of tolerances: yield, error percentiles, sensitivities, and how far a mask may be off."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from lumitip.estimation import EstimationError
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Model, TwinError
from lumitip_fab.config.load import Input
from lumitip_fab.config.messages import shown_path
from lumitip_fab.derive.making.tolerances import MODEL_VERSION, fingerprint, spreads
from lumitip_fab.errors import InputError, Problem
from lumitip_fab.pipeline.fingerprint import made_with
from lumitip_fab.tolerance.bench import COLUMNS, POSE_SETS, Case, bench, forget
from lumitip_fab.tolerance.cores import Errors, on_cores
from lumitip_fab.tolerance.draws import FACTORS, Draws, directions, draw
from lumitip_fab.tolerance.options import GOOD_PERCENT, MASK_FINGERS, Goals, Options
from lumitip_fab.tolerance.sobol import indices, mixed
from lumitip_fab.tolerance.yields import Good, design_effect, good, interval, worst_of

EVIDENCE = "simulated with our own model"
_TARED = COLUMNS[1:2]
_PERCENTILES = (50, 90, 95)  # of the errors
LEAST_DRAWS = 64
"""With fewer draws there are no Sobol indices."""
_MASK_STEPS = 15
MASK_STEP_MM = 0.1
MOST_SHIFT_MM = round(_MASK_STEPS * MASK_STEP_MM, 2)
"""Largest shift of the masks that is tried."""
_BEST = 3  # deviations of which the yield without them is computed
_SEARCHED = 10  # fingers that the whole estimator is compared on
_DIGITS = 4
_LEAST_EXTENT_MM = 0.1


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
        InputError: if the fingers are compliant, or no pose can be estimated with the cells.
        BuildError: if a worker is stopped.
    """
    cases = cases_of(config, layout, options)
    table, spread = config.catalogue.tolerances, spreads(config)
    take = partial(draw, table, spread, len(layout))
    drawn = take(options.fingers, options.seed)
    with on_cores(cases, cores) as errors:
        columns = errors(drawn, COLUMNS)
        draws = draws_of(options.fingers)
        sensitive = sensitivities(errors, take, draws, options) if draws else {}
        names = sorted(sensitive, key=lambda name: -max(sensitive[name]["total"].values()))
        without = {
            name: float(
                good(errors({**drawn, name: 0.0 * drawn[name]}, _TARED)[0], options.goals).mean()
            )
            for name in names[:_BEST]
        }
        few = take(min(MASK_FINGERS, options.fingers), options.seed)
        ways = directions(table, few, options.seed)
        mask_mm, mask_good = mask_allowance(errors, few, ways, options.goals)
    entries = {
        name: {
            "title": entry.title,
            "spread": _rounded(spread[name]),
            "unit": entry.unit,
            "distribution": entry.distribution,
            "confidence": entry.confidence,
            "source": entry.source,
            "measure": entry.measure,
            **sensitive.get(name, {}),
        }
        for name, entry in ((name, getattr(table, name)) for name in names or FACTORS)
    }
    compared = _compared(cases, take(_SEARCHED, options.seed))
    forget()
    return {
        "design": config.parameters.name,
        **_fingerprint(config, layout, options),
        "made_with": made_with("tolerance", "numpy", "scipy"),
        "model_version": MODEL_VERSION,
        "evidence": EVIDENCE,
        "goals": options.goals.set,
        "grasps": [
            {"gap_mm": grasp.gap_mm, "edges": grasp.edges, "cables_mm": list(grasp.cables_mm)}
            for grasp in options.grasps
        ],
        **(
            {"exposure": options.exposure, "exposure_against": options.against}
            if options.file
            else {}
        ),
        "fingers": options.fingers,
        "poses": {"edge": options.poses, "cable": options.poses, "sets": POSE_SETS},
        "seed": options.seed,
        "columns": {
            name: _column(rows, options.goals) for name, rows in zip(COLUMNS, columns, strict=True)
        },
        "sobol_draws": draws,
        "tolerances": entries,
        "yield_if_exact": {name: _rounded(value) for name, value in without.items()},
        "mask_shift": {
            "mm": mask_mm,
            "or_more": mask_mm == MOST_SHIFT_MM,
            "fingers": len(few["gap"]),
            **_yield(mask_good),
        },
        "pose_estimator": compared,
    }


def _fingerprint(config: Input, layout: Layout, options: Options) -> dict[str, str]:
    conditions = options.mask_conditions
    return {"fingerprint": fingerprint(config, layout, conditions)} if conditions else {}


def _compared(cases: tuple[Case, ...], drawn: Draws) -> dict[str, float]:
    """How the estimates of all cases compare with those of `PoseEstimator`, by `Bench.compared`."""
    found = [bench(case).compared(drawn) for case in cases]
    frames = [one["frames"] for one in found]
    shares = {
        name: float(np.average([one[name] for one in found], weights=frames))
        for name in found[0]
        if name != "frames"
    }
    return {"frames": sum(frames), **shares}


def cases_of(config: Input, layout: Layout, options: Options) -> tuple[Case, ...]:
    """The cases of a design, one for each gap.

    Raises:
        InputError: if its fingers are compliant, or no pose can be estimated with its cells.
    """
    file, variant = shown_path(config.sources[0].path), config.parameters.backing.variant
    if variant != "rigid":
        text = (
            f'is "{variant}"; a study of tolerances allows "rigid" alone, because its fingers do '
            "not bend. Study the same cells on a rigid backing."
        )
        raise InputError([Problem(file, 0, "backing.variant", text)])
    if min(np.ptp(layout.x_mm), np.ptp(layout.y_mm)) < _LEAST_EXTENT_MM:
        text = (
            f"is {list(config.parameters.grid.columns)}; all cells lie on one line, and a study "
            "allows grids of two columns and two rows or more. Add cells."
        )
        raise InputError([Problem(file, 0, "grid.columns", text)])
    gain = Model.gain * (options.exposure or 1.0)
    cases = tuple(
        Case(
            layout,
            replace(Model.from_layout(layout, grasp.gap_mm), gain=gain),
            options.poses,
            options.seed,
            grasp.edges,
            grasp.cables_mm,
        )
        for grasp in options.grasps
    )
    try:
        for case in cases:
            bench(case)
    except (EstimationError, TwinError) as error:
        raise InputError([Problem(file, 0, "grid.columns", str(error))]) from error
    return cases


def mask_allowance(
    errors: Errors, drawn: Draws, ways: Floats, goals: Goals
) -> tuple[float | None, Good]:
    """The largest shift of both masks, each in a random direction, up to which `GOOD_PERCENT` of
    the fingers drawn meet the goals after a tare, all their other deviations unchanged.

    Args:
        errors: of fingers.
        drawn: their deviations.
        ways: see `directions`.
        goals: of a good finger.

    Returns:
        The shift, a multiple of `MASK_STEP_MM`; at `MOST_SHIFT_MM` the masks may be off by more.
        None if too few fingers are good without any shift. And which fingers are good with it.
    """
    found, last = None, np.zeros(len(ways), bool)
    for steps in range(_MASK_STEPS + 1):
        shift_mm = round(steps * MASK_STEP_MM, 2)
        own = shifted_good(errors, drawn, ways, goals, shift_mm)
        if own.mean() < GOOD_PERCENT / 100.0:
            return found, last if steps else own
        found, last = shift_mm, own
    return found, last


def shifted_good(errors: Errors, drawn: Draws, ways: Floats, goals: Goals, shift_mm: float) -> Good:
    """Which fingers meet the goals after a tare if both masks are off by a length, each in its
    direction."""
    shifted = {**drawn, "mask_shift": (shift_mm * ways).reshape(len(ways), 4)}
    return good(errors(shifted, _TARED)[0], goals)


def draws_of(fingers: int) -> int:
    """Draws of each set of the Sobol indices: a power of 2; 0 if these fingers are too few."""
    count = 2 ** int(math.log2(fingers / 2))
    return count if count >= LEAST_DRAWS else 0


def sensitivities(
    errors: Errors, take: Callable[..., Draws], count: int, options: Options
) -> dict[str, dict[str, dict[str, float]]]:
    """Sobol indices of every deviation for the errors after a tare, see `worst_of`.

    Args:
        errors: of fingers.
        take: draws fingers by count, seed and part.
        count: draws of each of the two sets, a power of 2.
        options: goals and seed of the study.
    """
    seed = options.seed
    a, b = take(count, seed), take(count, seed, 1)
    sets = [a, b, *(mixed(a, b, name) for name in FACTORS)]
    together = {name: np.concatenate([one[name] for one in sets]) for name in FACTORS}
    worst = worst_of(errors(together, _TARED)[0], options.goals).T
    of_a, of_b, *others = np.split(worst, len(sets), axis=1)
    found = indices(of_a, of_b, np.array(others), seed)
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


def _column(rows: Floats, goals: Goals) -> dict[str, Any]:
    names = ("edge_mm", "edge_deg", "cable_mm", "cable_deg")
    return {
        **_yield(good(rows, goals)),
        "gross_errors": _rounded(float(rows[:, 4].mean())),
        **{
            name: {str(p): _rounded(value) for p, value in zip(_PERCENTILES, values, strict=True)}
            for name, values in zip(
                names, np.percentile(rows[:, :4], _PERCENTILES, axis=0).T, strict=True
            )
            if np.isfinite(values).all()  # a kind that is not tried has no errors
        },
    }


def _yield(found: Good) -> dict[str, Any]:
    return {
        "yield": _rounded(float(found.mean())),
        "yield_95": [_rounded(end) for end in interval(found)],
        "design_effect": _rounded(design_effect(found)),
    }


def _rounded(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}")
