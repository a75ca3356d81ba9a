"""The published frame of a cloth edge by both methods, and whether they agree.

The publication states no error of its method. It is computed with the twin: simulated edges for
which the method draws a line in the same place have a known true pose, and their mean and
deviation are bias and uncertainty of the method. The fingertips differ from the expected one as in
the other benchmarks, with a gap from 2 to 5 mm, since that of this grasp is not published.
Both methods agree if they are apart by two combined standard deviations at most (95 %), in offset
and in angle, whatever gap the estimator assumes.

Run by `make bench`; exits 1 if they do not.
"""

import json
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from common import Goals, on_one_core
from lumitip.estimation import PoseEstimator
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.links.twin import published_layout
from lumitip.twin import HalfPlane
from poses import Line, Method, published, read, wrong_twin

REAL_FRAMES = Path(__file__).parents[1] / "tests/readout/published_frames.json"

GAPS_MM = ((2.0, 0.4), (3.0, 0.4), (3.5, 1.0), (4.0, 0.4), (5.0, 0.4))
"""Gaps that the estimator assumes, with their standard deviations (mm)."""
ANY_GAP_MM = (2.0, 5.0)
AROUND_MM, AROUND_DEG = 1.5, 10.0  # range of the simulated edges around the drawn line
ALIKE_MM, ALIKE_DEG = 0.3, 1.0  # largest difference of two lines in the same place
FINGERS, EDGES = 40, 8000
AGREE = 2.0  # combined standard deviations, beyond which 5 % lie


@dataclass(frozen=True)
class Stated:
    """A line and its standard deviations: offset (mm), angle (degrees)."""

    line: Floats
    deviation: Floats

    def __str__(self) -> str:
        (offset, angle), (offset_sd, angle_sd) = self.line, self.deviation
        return f"{offset:+.2f} ± {offset_sd:.2f} mm, {angle:.1f} ± {angle_sd:.1f}°"

    def apart(self, other: "Stated") -> float:
        """Distance in combined standard deviations: the larger of offset and angle."""
        away = np.abs(self.line - other.line) / np.hypot(self.deviation, other.deviation)
        return float(away.max())


def stated_by(method: Method, layout: Layout, drawn: Line) -> tuple[Stated, int]:
    """True place of the edges for which a method draws a line, and their number."""
    chance, found = np.random.default_rng(5), []
    for seed in range(FINGERS):
        twin = wrong_twin(layout, seed, ANY_GAP_MM)
        for _ in range(EDGES // FINGERS):
            true = np.array(drawn) + (AROUND_MM, AROUND_DEG) * chance.uniform(-1.0, 1.0, 2)
            edge = HalfPlane(offset_mm=-true[0], angle_deg=true[1] + 180.0)  # the dark is left
            again = method(read(twin, edge, chance), "edge")
            if again and np.all(np.abs(np.subtract(again, drawn)) < (ALIKE_MM, ALIKE_DEG)):
                found.append(true)
    return Stated(np.mean(found, axis=0), np.std(found, axis=0)), len(found)


def without_single_cells_deg(layout: Layout, gap_mm: float, values: Floats) -> float:
    """Deviation of the angle by the jackknife: each cell left out in turn."""
    estimator, cells = PoseEstimator(layout, gap_mm=gap_mm), range(len(values))
    estimates = [
        estimator(np.where(np.arange(len(values)) == c, np.nan, values), "edge") for c in cells
    ]
    return float(np.sqrt((len(values) - 1.0) * np.var([t.angle_deg for t in estimates])))


def main() -> int:
    """Both methods on the frame; the exit code."""
    layout, goals = published_layout(), Goals()
    columns = json.loads(REAL_FRAMES.read_text("utf-8"))["frames"]["cloth_edge"]["columns"]
    values, method = np.concatenate(columns).astype(np.float64), published(layout)
    drawn = method(values, "edge")
    assert drawn is not None
    yardstick, many = stated_by(method, layout, drawn)
    print("the published frame (measured on hardware), gap not published")
    print(f"  published method draws {drawn[0]:+.2f} mm, {drawn[1]:.1f}°")
    print(f"  {many} simulated edges that it draws there lie at {yardstick}")
    for gap_mm, gap_sd_mm in GAPS_MM:
        found = PoseEstimator(layout, gap_mm=gap_mm, gap_sd_mm=gap_sd_mm)(values, "edge")
        estimate = Stated(
            np.array([found.offset_mm, found.angle_deg]),
            np.array([found.offset_sd_mm, found.angle_sd_deg]),
        )
        apart = estimate.apart(yardstick)
        print(
            f"  estimator, gap {gap_mm:g} ± {gap_sd_mm:g} mm: {estimate} "
            f"(± {without_single_cells_deg(layout, gap_mm, values):.1f}° by jackknife), "
            f"misfit {found.rms_counts:.1f} counts; published method {yardstick}: "
            f"{apart:.1f} combined deviations apart, "
            f"they {'agree' if apart <= AGREE else 'do not agree'}"
        )
        goals.at_most(
            f"both methods, gap {gap_mm:g} ± {gap_sd_mm:g} mm",
            apart,
            AGREE,
            "combined deviations apart",
        )
    return goals.exit_code()


if __name__ == "__main__":
    on_one_core()
    sys.exit(main())
