"""Errors of the pose estimator with a design, on fingertips whose optics are wrong.

The search computes what can be known from a frame; here the estimator of the robot's side finds the
poses, from frames of twins whose gap, exponent, scattered share, hole and gains are not those that
it expects. Its bank, its robust loss and its gross errors are in these figures.
"""

from dataclasses import dataclass

import numpy as np

from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Model
from lumitip_fab.explore.accuracy import Grasp, Sample, Trials, gross, rms
from lumitip_fab.solve.goals import Targets

FIGURES = ("error", "edge_mm", "edge_deg", "cable_mm", "cable_deg", "gross_percent")
EVIDENCE = "simulated with our own model, optics wrong"


@dataclass(frozen=True)
class Trial:
    """One design and one grasp that it is tried in."""

    layout: Layout
    sample: Sample
    grasp: Grasp
    kind: str

    def misses(self) -> Floats:
        """Errors of offset (mm) and angle (degrees), shape `(n, 2)`."""
        return Trials(self.layout, self.sample, self.grasp).misses(self.kind)


def trials(layout: Layout, targets: Targets, exposure: float, sample: Sample) -> list[Trial]:
    """The trials of a design: edges at each gap, and cables that are not thicker than it.

    Args:
        layout: the cells.
        targets: gaps and cables.
        exposure: of the design, see `judge.drive`.
        sample: fingertips and poses of each trial.
    """
    gain = Model.gain * exposure
    found = []
    for gap_mm in targets.gaps_mm:
        found.append(Trial(layout, sample, Grasp(gap_mm, gain=gain), "edge"))
        found += [
            Trial(layout, sample, Grasp(gap_mm, diameter_mm, gain), "cable")
            for diameter_mm in targets.cables_mm
            if diameter_mm <= gap_mm
        ]
    return found


def figures(found: list[tuple[str, Floats]], targets: Targets) -> dict[str, float]:
    """Rms errors over all trials, the largest in units of its goal, and the share of gross errors.

    Args:
        found: kind and errors of each trial.
        targets: the goals.
    """
    missed = {
        kind: np.concatenate([rows for name, rows in found if name == kind])
        for kind in ("edge", "cable")
        if any(name == kind for name, _ in found)
    }
    errors = {
        f"{kind}_{unit}": rms(rows[:, column])
        for kind, rows in missed.items()
        for column, unit in enumerate(("mm", "deg"))
    }
    every = np.concatenate(list(missed.values()))
    return {
        "error": max(errors[name] / goal for name, goal in targets.errors.items()),
        **errors,
        "gross_percent": 100.0 * float(gross(every).mean()),
    }
