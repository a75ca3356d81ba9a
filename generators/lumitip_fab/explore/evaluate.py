"""One design of a study: what it is good for, or why it cannot be; in any process, anywhere."""

import hashlib
from dataclasses import dataclass
from typing import Any

import numpy as np

from lumitip.estimation import EstimationError
from lumitip_fab.derive import resolve
from lumitip_fab.encoding import canonical
from lumitip_fab.errors import InputError
from lumitip_fab.explore.accuracy import Sample, accuracy
from lumitip_fab.explore.prices import cost
from lumitip_fab.explore.vary import Changes
from lumitip_fab.load import Input
from lumitip_fab.price_entry import Prices
from lumitip_fab.toolchain import code_hash

_DIGITS = 5  # of every figure: the same on any machine

FIGURES = (
    "error_mm", "error_deg", "edge_mm", "cable_mm", "gross_percent", "bound_mm", "cells",
    "grid_cm2", "cost", "current_ma",
)  # fmt: skip
"""What is told of a design, in this order."""

Record = dict[str, Any]
"""Plain JSON: `key`, and `figures` (by name) or `refused` (what derive says)."""


@dataclass(frozen=True)
class Job:
    """All that one evaluation needs, on whatever machine."""

    given: Input
    """The parameter file with its changes."""
    changes: Changes
    prices: Prices
    sample: Sample
    key: str
    """SHA-256 of everything that the result depends on."""

    @classmethod
    def of(cls, given: Input, changes: Changes, prices: Prices, sample: Sample) -> "Job":
        """A job with its key."""
        told = [
            given.parameters.model_dump(),
            {field: part.model_dump() for field, part in given.named_parts().items()},
            prices.model_dump(), sample, code_hash("explore"), np.__version__,
        ]  # fmt: skip
        key = hashlib.sha256(canonical(told).encode()).hexdigest()
        return cls(given, changes, prices, sample, key)


def evaluate(job: Job) -> Record:
    """Judge a design; nothing is built."""
    try:
        resolved = resolve(job.given)
    except InputError as error:
        return {"key": job.key, "refused": [f"{p.field}: {p.message}" for p in error.problems]}
    design, layout = resolved.design, resolved.design.layout
    try:
        accurate = accuracy(layout, job.sample)
    except EstimationError as error:
        return {"key": job.key, "refused": [f"grid.columns: {error}"]}
    figures = {
        **accurate,
        "cells": float(len(layout)),
        "grid_cm2": float(np.ptp(layout.x_mm) * np.ptp(layout.y_mm)) / 100.0,
        "cost": cost(resolved.given, design, job.prices),
        "current_ma": float(sum(design.wiring.current_ma)),
    }
    return {"key": job.key, "figures": {n: _rounded(figures[n]) for n in FIGURES}}


def _rounded(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}")
