"""Accuracy of the pose estimator on frames of a second optical model, beside the bound.

The second model (`second_light`) is a path tracer that shares no code and no assumption with the
twin, on which the estimator is built. Each fingertip has its own optics, electronics and gains;
it is tared with its empty grasp. Nothing is learned. In `tared` the 6 % of spread of the cells are
part of the empty grasp; in `gains changed` each cell's gain changes by 6 % after it. The bound is
that of a pose with unknown optics, electronics, specimen and gains (`second_bench.Bound`).

Run by `make bench`; exits 1 if a goal is missed. Arguments: number of poses, seed of the
fingertips and poses.
"""

import sys

import numpy as np

from common import Goals, on_one_core
from lumitip.estimation import PoseEstimator
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.links.twin import published_layout
from poses import Trial, estimated, gross, misses
from second_bench import DRIFTED, TARED, Bound, fingers, lights, trials

POSES, SEED = 240, 902
FINGERS = 12
GOALS = {"edge": (0.15, 0.5), "cable": (0.25, 1.0)}
GROSS, TIMES_BOUND = 0.5, 1.3
ONE, TWO = (60.0, 78.0), (90.0, 99.0)
"""Ranges (%) of errors within one and two stated deviations; 68 and 95 are ideal."""


def table(
    estimator: PoseEstimator, kind: str, name: str, found: list[Trial], bound: Floats, goals: Goals
) -> None:
    """Print the line of one kind, with its goals.

    Args:
        estimator: to be tested.
        kind: of object.
        name: of the state of the gains.
        found: frames.
        bound: deviations of offset and angle of each, shape `(n, 2)`.
        goals: of the bench.
    """
    missed = misses(estimated(estimator), found, kind)
    wild = gross(missed)
    kept = missed[~wild]
    rms, middle = np.sqrt((kept**2).mean(axis=0)), np.median(kept, axis=0)
    least = np.sqrt((bound**2).mean(axis=0))
    stated = [estimator(trial.values, kind) for trial in found]
    ratio = missed / np.array([(each.offset_sd_mm, each.angle_sd_deg) for each in stated])
    one, two = (100.0 * (ratio < most).mean(axis=0) for most in (1.0, 2.0))
    share = 100.0 * float(wild.mean())
    flagged = np.array(["ambiguous" in each.flags for each in stated])
    silent = 100.0 * float((wild & ~flagged).mean())
    print(
        f"  {kind + ', ' + name:<24}{rms[0]:>7.3f}{rms[1]:>7.2f}{middle[0]:>9.3f}{middle[1]:>7.2f}"
        f"{least[0]:>9.3f}{least[1]:>7.2f}{share:>8.1f}{silent:>8.1f}"
        f"{one[0]:>8.0f}{one[1]:>4.0f}{two[0]:>6.0f}{two[1]:>4.0f}",
        flush=True,
    )
    for entry, unit in enumerate(("mm", "°")):
        where = f"{kind}, {name}"
        goals.at_most(where, float(rms[entry]), GOALS[kind][entry], f"{unit} rms")
        goals.at_most(
            f"{where}, {unit} rms", float(rms[entry] / least[entry]), TIMES_BOUND, "times the bound"
        )
        for within, limits, times in ((one, ONE, 1), (two, TWO, 2)):
            text = f"{where}, {unit} within {times} stated deviations"
            goals.at_least(text, float(within[entry]), limits[0], "%")
            goals.at_most(text, float(within[entry]), limits[1], "%")
    goals.at_most(f"{where}, gross", share, GROSS, "%")


def main(count: int, seed: int, layout: Layout) -> int:
    """Print the table; the exit code."""
    goals, estimator, bound = Goals(), PoseEstimator(layout).prepare("edge", "cable"), Bound(layout)
    print(
        f"{count} poses of each kind on {FINGERS} fingertips, seed {seed}, simulated with a model "
        "that shares nothing with the twin"
    )
    print(
        f"  {'':<24}{'rms':>7}{'':>7}{'median':>9}{'':>7}{'bound':>9}{'':>7}{'gross':>8}"
        f"{'silent':>8}{'1 sd':>8}{'':>4}{'2 sd':>6}"
    )
    print(
        f"  {'':<24}" + f"{'mm':>7}{'deg':>7}" + f"{'mm':>9}{'deg':>7}" * 2 + f"{'%':>8}{'%':>8}"
        f"{'mm':>8}{'deg':>4}{'mm':>6}{'deg':>4}  (% of errors)"
    )
    found = lights(layout, FINGERS, seed)
    states = {
        "tared": fingers(found, seed, 0.0),
        "gains changed": fingers(found, seed, DRIFTED),
    }
    for kind in ("edge", "cable"):
        frames = {name: trials(tips, kind, count, seed) for name, tips in states.items()}
        poses = [trial.pose for trial in frames["tared"]]
        least = np.array([bound(kind, pose, (TARED, DRIFTED)) for pose in poses])
        for number, (name, shown) in enumerate(frames.items()):
            table(estimator, kind, name, shown, least[:, number], goals)
    return goals.exit_code()


if __name__ == "__main__":
    on_one_core()
    poses = int(sys.argv[1]) if len(sys.argv) > 1 else POSES
    sys.exit(main(poses, int(sys.argv[2]) if len(sys.argv) > 2 else SEED, published_layout()))
