"""The three published real frames, and what both methods find in them at an assumed gap.

The publication gives the object of each frame (a cloth edge, the corner of a cloth, a cable of
3 mm), but neither its pose nor the gap of the grasp.
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lumitip.estimation import Estimate, PoseEstimator
from lumitip.grid import Floats
from lumitip.layout import Layout

FILE = Path(__file__).parents[1] / "tests/readout/published_frames.json"
KINDS = {"cloth_edge": "edge", "cloth_corner": "corner", "cable": "cable"}
"""Kind of the object in each frame."""
GAPS_MM = ((2.0, 0.4), (3.0, 0.4), (3.5, 1.0), (4.0, 0.4), (5.0, 0.4))
"""Gaps that the estimator assumes, with their standard deviations (mm)."""
DIAMETERS_MM = (2.0, 2.5, 3.0, 3.5, 4.0, 5.0)
"""Diameters that the estimator expects of the cable, which has 3 mm."""
GAP_MM = 3.0
"""Gap at which they are tried (mm)."""


@dataclass(frozen=True)
class Tried:
    """An estimate with what was assumed for it."""

    assumed: str
    estimate: Estimate


def real_frame(name: str) -> Floats:
    """Values of a real frame in cell order, shape `(32,)`."""
    columns = json.loads(FILE.read_text("utf-8"))["frames"][name]["columns"]
    return np.concatenate(columns).astype(np.float64)


def by_gap(layout: Layout, name: str) -> Iterator[Tried]:
    """Estimates of one frame at each assumed gap."""
    for gap_mm, sd_mm in GAPS_MM:
        estimator = PoseEstimator(layout, gap_mm=gap_mm, gap_sd_mm=sd_mm)
        yield Tried(f"gap {gap_mm:g} ± {sd_mm:g} mm", estimator(real_frame(name), KINDS[name]))


def by_diameter(layout: Layout) -> Iterator[Tried]:
    """Estimates of the cable with each expected diameter."""
    for diameter_mm in DIAMETERS_MM:
        estimator = PoseEstimator(layout, gap_mm=GAP_MM, diameter_mm=diameter_mm)
        yield Tried(
            f"gap {GAP_MM:g}, expected {diameter_mm:g} mm", estimator(real_frame("cable"), "cable")
        )


def deviation(estimate: Estimate, name: str) -> float:
    """Standard deviation of a parameter of the estimate."""
    at = estimate.parameters.index(name)
    return float(np.sqrt(estimate.covariance[at, at]))
