"""Gain of self-calibration where the optics are wrong: six fingers, edges and cables.

`learn` sees 300 simulated frames of edges, a minute of ordinary use; before and after are measured
on other frames of the same finger, cables among them. Run by `make bench`; exits 1 if a goal is
missed: no finger's offset may get worse, and all together lose a quarter of their error at least.
A number as its argument is that of the poses.
"""

import sys

import numpy as np

from common import Goals, on_one_core
from lumitip.estimation import PoseEstimator, learn
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.links.twin import published_layout
from lumitip.twin import HalfPlane, Twin
from poses import OFFSET_MM, estimated, frames, gross, misses, read, wrong_twin

FINGERS, SEEN = 6, 300
KINDS = ("edge", "cable")
LEFT, WORST = 0.75, 1.0  # limit of the remaining rms offset, as a share: all fingers, any finger


def ordinary_use(twin: Twin, seed: int) -> Floats:
    """Edges in any direction, shape `(n, cells)`."""
    chance = np.random.default_rng(seed)
    edges = (
        HalfPlane(chance.uniform(-OFFSET_MM, OFFSET_MM), chance.uniform(-180.0, 180.0))
        for _ in range(SEEN)
    )
    return np.array([read(twin, edge, chance) for edge in edges])


def rms(estimator: PoseEstimator, twin: Twin, kind: str, poses: int, seed: int) -> Floats:
    """Of offset (mm) and angle (degrees) without gross errors, and these (%), shape `(3,)`."""
    missed = misses(estimated(estimator), frames([twin], kind, poses, seed), kind)
    wild = gross(missed)
    return np.append(np.sqrt((missed[~wild] ** 2).mean(axis=0)), 100.0 * wild.mean())


def finger(layout: Layout, number: int, poses: int) -> Floats:
    """Print one finger's lines; errors before and after by kind, shape `(2, 2, 3)`."""
    twin = wrong_twin(layout, 100 + number)
    learned = learn(layout, ordinary_use(twin, number), "edge")
    off = 100.0 * np.std(learned.gains / (twin.gains / twin.gains.mean()))
    true, found = twin.model, learned.model
    print(
        f"\nfinger {number}: gap {true.gap_mm:.2f} mm, learned {found.gap_mm:.2f}; scattered share "
        f"{true.alpha:.2f}, learned {found.alpha:.2f}; gains off by {off:.1f} %; misfit "
        f"{learned.rms_before_counts:.1f} counts, then {learned.rms_counts:.1f}"
    )
    before, after = PoseEstimator(layout), PoseEstimator(layout, found, gains=learned.gains)
    errors = np.array(
        [[rms(e, twin, kind, poses, 200 + number) for e in (before, after)] for kind in KINDS]
    )
    for kind, both in zip(KINDS, errors, strict=True):
        _line(kind, both)
    return errors


def _line(kind: str, both: Floats) -> None:
    before, after = ("{:.3f} mm, {:.2f}°, {:.1f} % gross".format(*figures) for figures in both)
    print(f"  {kind:<6} before {before}; after {after}", flush=True)


def main(poses: int) -> int:
    """Print everything; the exit code."""
    layout, goals = published_layout(), Goals()
    print(
        f"wrong optics before and after self-calibration from {SEEN} frames of edges, "
        f"{poses} other poses of each finger and kind, simulated"
    )
    every = np.array([finger(layout, number, poses) for number in range(FINGERS)])
    whole = np.sqrt((every**2).mean(axis=0))
    whole[..., 2] = every[..., 2].mean(axis=0)
    print("\nall fingers")
    for kind, both, single in zip(KINDS, whole, every.swapaxes(0, 1), strict=True):
        _line(kind, both)
        goals.at_most(
            f"{kind}, offset after against before, all fingers",
            float(both[1, 0] / both[0, 0]),
            LEFT,
        )
        goals.at_most(
            f"{kind}, offset after against before, worst finger",
            float((single[:, 1, 0] / single[:, 0, 0]).max()),
            WORST,
        )
        goals.at_most(f"{kind}, gross errors after", float(both[1, 2]), float(both[0, 2]), "%")
    return goals.exit_code()


if __name__ == "__main__":
    on_one_core()
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 200))
