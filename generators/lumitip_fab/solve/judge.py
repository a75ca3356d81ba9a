"""Figures of one design of a search, in any process; nothing is built."""

import hashlib
import math
from dataclasses import dataclass

import numpy as np

from lumitip.errors import LumitipError
from lumitip.layout import Layout
from lumitip.twin import Model
from lumitip.twin.pairs import Emitter, Pairs
from lumitip_fab.config.load import Input
from lumitip_fab.derive import resolve
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import canonical
from lumitip_fab.errors import InputError
from lumitip_fab.explore.evaluate import Record, cost
from lumitip_fab.explore.vary import Changes
from lumitip_fab.pipeline.fingerprint import code_hash
from lumitip_fab.solve.goals import Limits, Targets, Task
from lumitip_fab.solve.information import Grasps, expected

ERRORS = ("edge_mm", "edge_deg", "cable_mm", "cable_deg")
"""Expected errors, rms over all grasps."""
FIGURES = (
    "error",
    *ERRORS,
    "exposure",
    "cells",
    "width_mm",
    "length_mm",
    "cost",
    "current_ma",
)
"""Figures of a design; `error` is the largest of the errors, each in units of its goal."""
OBJECTIVES = ("error", "cost", "current_ma")
"""Figures of the Pareto front; less is better."""
_DIGITS = 5
_MOST_EXPOSURE = 4.0  # beyond it every cell is saturated whatever is gripped


@dataclass(frozen=True)
class Job:
    """All that judging a design needs, on whatever machine."""

    config: Input
    changes: Changes
    targets: Targets
    base_light: float
    """Light of the base, see `light`."""
    key: str
    """SHA-256 of everything that the result depends on."""

    @classmethod
    def of(cls, task: Task, changes: Changes, base_light: float) -> "Job":
        """The job of a design of a task."""
        config = task.design(changes)
        inputs = [
            config.parameters.model_dump(),
            sorted(config.automatic),
            {field: part.model_dump() for field, part in config.parts_by_field().items()},
            config.catalogue.prices.model_dump(),
            task.targets.model_dump(),
            base_light,
            code_hash("explore", "solve"),
            np.__version__,
        ]
        key = hashlib.sha256(canonical(inputs).encode()).hexdigest()
        return cls(config, changes, task.targets, base_light, key)


def judge(job: Job) -> Record:
    """The figures of a design, or why it is refused."""
    try:
        resolved = resolve(job.config)
    except InputError as error:
        return {"key": job.key, "refused": [p.text for p in error.problems]}
    design, layout = resolved.design, resolved.design.layout
    exposure = min(light(design) / job.base_light, _MOST_EXPOSURE)
    grasps = Grasps(job.targets.gaps_mm, job.targets.cables_mm)
    try:
        errors = expected(layout, grasps, Model.gain * exposure).rms()
    except LumitipError as error:
        return {"key": job.key, "refused": [f"grid.columns: {error}"]}
    figures = {
        "error": max(errors[name] / getattr(job.targets, name) for name in errors),
        **dict.fromkeys(ERRORS, 0.0),
        **errors,
        "exposure": exposure,
        "cells": float(len(layout)),
        "width_mm": float(np.ptp(layout.x_mm)),
        "length_mm": float(np.ptp(layout.y_mm)),
        "cost": cost(resolved.config, design, resolved.config.catalogue.prices),
        "current_ma": float(sum(design.wiring.current_ma)),
    }
    return {"key": job.key, "figures": {name: rounded(figures[name]) for name in FIGURES}}


def light(design: Design) -> float:
    """Voltage that the brightest photodetector takes from its pull-up in the empty grasp, in a
    unit of its own: it compares designs with the same LEDs and photodetectors.

    Light grows with the LED's current, which is assumed to be linear.
    """
    layout: Layout = design.layout
    full = Pairs.of(layout, Emitter(Model.from_layout(layout))).full
    current_ma = float(np.mean(design.wiring.current_ma))
    return float(full.max()) * current_ma * layout.optics.pull_up_ohm


def excesses(figures: dict[str, float], limits: Limits) -> tuple[float, ...]:
    """How far a design is beyond each limit, as a share of it; 0 or less where it keeps it."""
    most = ("cost", "current_ma", "cells")
    least = ("width_mm", "length_mm")
    return (
        *(figures[n] / getattr(limits, n) - 1.0 for n in most if getattr(limits, n) < math.inf),
        *(1.0 - figures[n] / getattr(limits, n) for n in least if getattr(limits, n) > 0.0),
    )


def rounded(value: float) -> float:
    """A figure with as many digits as are the same on any machine."""
    return float(f"{value:.{_DIGITS}g}")
