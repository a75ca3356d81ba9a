"""The one published frame of a cloth edge by both methods; printed by `bench_estimation.py`."""

from collections.abc import Callable

import numpy as np

from lumitip.estimation import PoseEstimator
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import HalfPlane, Model, Twin

# The published frame (8-bit complements, column by column); its figure draws the line at 5.8 deg.
REAL = (19, 11, 44, 228, 239, 7, 17, 196, 206, 13, 8, 84, 238, 226, 13, 22, 216, 232,
        11, 13, 131, 244, 205, 13, 19, 234, 240, 8, 11, 196, 213, 239)  # fmt: skip

GAPS_MM = ((2.0, 0.4), (3.0, 0.4), (3.5, 1.0), (4.0, 0.4), (5.0, 0.4))
"""Gaps that are told to the estimator, with their standard deviations (mm)."""
PUBLISHED_DEG = 2.2
"""Angle error of the published method on simulated edges, rms; `bench_estimation.py` prints it."""

Method = Callable[[Floats, str], tuple[float, float] | None]


def without_single_cells_deg(layout: Layout, gap_mm: float, values: Floats) -> float:
    """Deviation of the angle by the jackknife: every cell left out in turn."""
    estimator, cells = PoseEstimator(layout, gap_mm=gap_mm), range(len(values))
    told = [estimator(np.where(np.arange(len(values)) == c, np.nan, values), "edge") for c in cells]
    return float(np.sqrt((len(values) - 1.0) * np.var([t.angle_deg for t in told])))


def real_frame(layout: Layout, published: Method) -> None:
    """The one published frame by both methods."""
    values = np.array(REAL, dtype=np.float64)
    line = published(values, "edge") or (np.nan, np.nan)
    print("\nthe published frame (measured on hardware), gap not published")
    print(f"  published method: {line[0]:+.2f} mm, {line[1]:.1f}° (its error in simulation: above)")
    for gap_mm, gap_sd_mm in GAPS_MM:
        told = PoseEstimator(layout, gap_mm=gap_mm, gap_sd_mm=gap_sd_mm)(values, "edge")
        line_told = f"{told.offset_mm:+.2f} ± {told.offset_sd_mm:.2f} mm, "
        line_told += f"{told.angle_deg:.1f} ± {told.angle_sd_deg:.1f}°"
        line_told += f" (± {without_single_cells_deg(layout, gap_mm, values):.1f}° by jackknife)"
        print(f"  estimator, gap {gap_mm:g} ± {gap_sd_mm:g} mm: {line_told}, "
              f"misfit {told.rms_counts:.1f} counts")  # fmt: skip
        # Light beside and behind the sheet as estimated; the dark is left of the line.
        twin = Twin(layout, Model.from_layout(layout, gap_mm))
        behind = told.angle_deg + 180.0
        edge = HalfPlane(offset_mm=-told.offset_mm, angle_deg=behind, clear=told.transmittance)
        again = published(told.gain * twin.values(edge), "edge")
        assert again is not None
        left = float(np.hypot(told.angle_sd_deg, PUBLISHED_DEG))
        print(f"    of that pose the published method says {again[0]:+.2f} mm, {again[1]:.1f}°; "
              f"apart by {abs(line[1] - told.angle_deg) / left:.1f} deviations, "
              f"by {abs(line[1] - again[1]) / told.angle_sd_deg:.1f} of the estimator's alone "
              "without that error")  # fmt: skip
