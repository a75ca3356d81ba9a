"""Figures of one design of a search, in any process; nothing is built."""

import math
from dataclasses import dataclass

import numpy as np

from lumitip.estimation.estimate import LEAST_CELLS
from lumitip.twin import Model
from lumitip_fab.config.load import Input
from lumitip_fab.derive import Resolved, resolve
from lumitip_fab.design import Design
from lumitip_fab.errors import InputError
from lumitip_fab.explore.evaluate import Record, cost, key_of, rounded
from lumitip_fab.explore.vary import Changes
from lumitip_fab.pipeline.fingerprint import code_hash
from lumitip_fab.solve.goals import WITHOUT_LIGHT, Limits, Targets, Task
from lumitip_fab.solve.information import Grasps, expected

ERRORS = ("edge_mm", "edge_deg", "cable_mm", "cable_deg")
"""Expected errors, rms over all grasps; without cables those of edges alone."""
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
MOST_EXPOSURE = 1.3
"""Beyond it free cells saturate, and thin shadows vanish."""


@dataclass(frozen=True)
class Reference:
    """The light that designs are compared with, which is taken as well exposed."""

    drive: float
    """See `drive`."""
    with_fixed: bool
    """Whether it is that of the base with the fixed values, which name another LED or
    photodetector: how its light compares with that of the base's own file is not known."""

    @classmethod
    def of(cls, task: Task) -> "Reference":
        """The reference of a task.

        Raises:
            InputError: if the base is refused, with or without the fixed values.
        """
        written = resolve(task.written)
        if not task.fixed:
            return cls(drive(written.design), False)
        fixed = resolve(task.base)
        other = any(written.config.value(n) != fixed.config.value(n) for n in WITHOUT_LIGHT)
        return cls(drive((fixed if other else written).design), other)

    def __str__(self) -> str:
        return "the base with [fixed]" if self.with_fixed else "the base"


@dataclass(frozen=True)
class Job:
    """All that judging a design needs, on whatever machine."""

    config: Input
    changes: Changes
    targets: Targets
    reference: Reference
    key: str
    """SHA-256 of everything that the result depends on."""

    @classmethod
    def of(cls, task: Task, changes: Changes, reference: Reference) -> "Job":
        """The job of a design of a task."""
        config = task.design(changes)
        prices, code = config.catalogue.prices, code_hash("explore", "solve")
        key = key_of(config, prices, task.targets.model_dump(), reference.drive, code)
        return cls(config, changes, task.targets, reference, key)


def exposure_of(task: Task, reference: Reference, resolved: Resolved) -> float | None:
    """Exposure of a design against the reference of a task, see `drive`; `None` where it has other
    LEDs or photodetectors, whose light is not known.

    Raises:
        InputError: if the task's base is refused.
    """
    known = resolve(task.base if reference.with_fixed else task.written).config
    if any(known.value(name) != resolved.config.value(name) for name in WITHOUT_LIGHT):
        return None
    return drive(resolved.design) / reference.drive


def judge(job: Job) -> Record:
    """The figures of a design, or why it is refused."""
    try:
        resolved = resolve(job.config)
    except InputError as error:
        return {"key": job.key, "refused": [p.text for p in error.problems]}
    design, layout = resolved.design, resolved.design.layout
    exposure = drive(design) / job.reference.drive
    if len(layout) < LEAST_CELLS:
        text = f"grid.columns has {len(layout)} cells; a pose needs at least {LEAST_CELLS}"
        return {"key": job.key, "refused": [text]}
    if exposure > MOST_EXPOSURE:
        text = (
            f"LED current times pull-up is {exposure:.2f} times that of {job.reference}, which "
            f"saturates free cells; at most {MOST_EXPOSURE:g} times is judged"
        )
        return {"key": job.key, "refused": [text]}
    grasps = Grasps(job.targets.gaps_mm, job.targets.cables_mm)
    errors = expected(layout, grasps, Model.gain * exposure).rms()
    figures = {
        "error": max(errors[name] / goal for name, goal in job.targets.errors.items()),
        **errors,
        "exposure": exposure,
        "cells": float(len(layout)),
        "width_mm": float(np.ptp(layout.x_mm)),
        "length_mm": float(np.ptp(layout.y_mm)),
        "cost": cost(resolved.config, design, resolved.config.catalogue.prices),
        "current_ma": float(sum(design.wiring.current_ma)),
    }
    return {"key": job.key, "figures": {n: rounded(figures[n]) for n in FIGURES if n in figures}}


def drive(design: Design) -> float:
    """Current of an LED times pull-up (mA · ohm): what a design does to the photocurrent's voltage,
    with the same parts and optics."""
    return float(np.mean(design.wiring.current_ma)) * design.layout.optics.pull_up_ohm


def excesses(figures: dict[str, float], limits: Limits) -> dict[str, float]:
    """How far a design is beyond each limit, as a share of it; 0 or less where it keeps it."""
    most = [n for n in ("cost", "current_ma", "cells") if getattr(limits, n) < math.inf]
    least = [n for n in ("width_mm", "length_mm") if getattr(limits, n) > 0.0]
    return {n: figures[n] / getattr(limits, n) - 1.0 for n in most} | {
        n: 1.0 - figures[n] / getattr(limits, n) for n in least
    }
