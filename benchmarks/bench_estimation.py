"""Accuracy of the pose estimator against the published method and the theoretical bound.

All frames are simulated by the optical twin, with noise and whole counts. With wrong optics every
frame is of a fingertip that differs from the expected one (gap ± 0.5 mm, detector exponent ± 0.6,
scattered share ± 0.2, hole ± 5 %, and 6 % of spread in the cells' gains). Run by `make bench`;
exits 1 if a goal is missed. The argument is the number of poses.
"""

import sys

import numpy as np

from common import Goals, on_one_core
from lumitip.estimation import PoseEstimator
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.links.twin import published_layout
from lumitip.twin import Twin
from poses import NOISE, Trial, estimated, frames, gross, misses, published, scene, wrong_twin

PAIRS = 40  # of wrong fingers, each for several poses
DRAWS = 3  # of wrong fingers and poses; the goals hold for each
STATED = 300  # poses at which stated deviations are compared with the errors
GOALS = {
    ("edge", "clean"): (0.08, 0.3, 1.0),
    ("cable", "clean"): (0.1, 0.3, 1.0),
    ("edge", "wrong"): (0.45, 1.5, 3.0),
    ("cable", "wrong"): (0.5, 1.6, 3.0),
}


def row(name: str, missed: Floats, trials: list[Trial]) -> tuple[float, float, float]:
    """Print one line of a table; returns both rms and the gross errors (%)."""
    wild = gross(missed)
    kept = missed[~wild]
    rms = np.sqrt((kept**2).mean(axis=0))
    middle = np.median(kept, axis=0)
    worst = int(np.argmax(np.where(wild, -1.0, missed[:, 0] + missed[:, 1] / 5.0)))
    share = 100.0 * float(wild.mean())
    at = "({:+.1f} mm, {:+.0f}°)".format(*trials[worst].pose)
    print(
        f"  {name:<22}{rms[0]:>7.3f}{rms[1]:>7.2f}{middle[0]:>9.3f}{middle[1]:>7.2f}"
        f"{missed[worst, 0]:>9.2f}{missed[worst, 1]:>6.1f}  {at:<18}{share:>6.1f}"
    )
    return float(rms[0]), float(rms[1]), share


def bound(twin: Twin, kind: str, trials: list[Trial]) -> tuple[float, float]:
    """Cramér–Rao bound of offset (mm) and angle (degrees), rms over the poses."""
    # Light and transmittance are unknown; offset and angle have priors of 1 mm and 5 degrees.
    noise = np.hypot(NOISE, np.sqrt(1.0 / 12.0))
    rows = []
    for trial in trials:
        offset, angle = trial.pose
        steps = ((0.0, 0.0), (0.05, 0.0), (-0.05, 0.0), (0.0, 0.3), (0.0, -0.3))
        light, right, left, up, down = (
            twin.values(scene(kind, (offset + by_mm, angle + by_deg))) for by_mm, by_deg in steps
        )
        slopes = [(right - left) / 0.1, (up - down) / 0.6, light, 255.0 - light]
        jacobian = np.stack(slopes, axis=1) / noise
        known = np.diag([1.0, 1.0 / 5.0**2, 100.0, 1.0])
        rows.append(np.diag(np.linalg.inv(jacobian.T @ jacobian + known))[:2])
    rms = np.sqrt(np.mean(rows, axis=0))
    return float(rms[0]), float(rms[1])


def accuracy(layout: Layout, count: int, goals: Goals) -> None:
    """The tables, with their goals."""
    estimator = PoseEstimator(layout)
    methods = {"published method": published(layout), "estimator": estimated(estimator)}
    for optics, draw in (("clean", 0), *(("wrong", draw) for draw in range(DRAWS))):
        wrong = range(1000 * draw, 1000 * draw + PAIRS) if optics == "wrong" else ()
        pairs = [wrong_twin(layout, seed) for seed in wrong] or [Twin(layout)]
        for kind in ("edge", "cable"):
            trials = frames(pairs, kind, count, seed=11 + draw)
            print(f"\n{kind}, {optics} optics, draw {draw}, {count} poses, simulated")
            print(
                f"  {'':<22}{'rms':>7}{'':>7}{'median':>9}{'':>7}{'worst':>9}{'':>6}  "
                f"{'where':<18}{'gross':>6}"
            )
            print(
                f"  {'':<22}{'mm':>7}{'deg':>7}{'mm':>9}{'deg':>7}{'mm':>9}{'deg':>6}  "
                f"{'':<18}{'%':>6}"
            )
            if optics == "clean":
                print(
                    "  {:<22}{:>7.3f}{:>7.2f}".format(
                        "Cramér–Rao bound", *bound(pairs[0], kind, trials)
                    )
                )
            for name, method in methods.items():
                figures = row(name, misses(method, trials, kind), trials)
            goal = GOALS[kind, optics]
            for unit, figure, most in zip(
                ("mm rms", "° rms", "% gross"), figures, goal, strict=True
            ):
                goals.at_most(f"{kind}, {optics} optics", figure, most, unit)
            print("  {:<22}{:>7.3f}{:>7.2f}{:>56.1f}".format("goal", *goal))
            stated(estimator, trials[:: max(count // STATED, 1)], kind)


def stated(estimator: PoseEstimator, trials: list[Trial], kind: str) -> None:
    """Print the share of errors within the deviations that the estimator states, and of flags."""
    estimates = [estimator(trial.values, kind) for trial in trials]
    missed = misses(estimated(estimator), trials, kind)
    wild = gross(missed)
    ratio = missed / np.array([(t.offset_sd_mm, t.angle_sd_deg) for t in estimates])
    within = [100.0 * (ratio[~wild] < most).mean(axis=0) for most in (1.0, 2.0)]
    flagged = np.array(["ambiguous" in t.flags for t in estimates])
    print(
        "  within one stated deviation {:.0f} % (offset), {:.0f} % (angle)".format(*within[0])
        + ", within two {:.0f} %, {:.0f} %".format(*within[1])
        + f"; {100.0 * flagged.mean():.1f} % ambiguous, of the others "
        f"{100.0 * wild[~flagged].mean():.1f} % gross"
    )


def kinds(layout: Layout, count: int) -> None:
    """How often the estimator decides right without knowing the kind."""
    estimator = PoseEstimator(layout)
    print(f"\nkind decided by the estimator, of {count} frames each")
    for optics, pairs in (
        ("clean", [Twin(layout)]),
        ("wrong", [wrong_twin(layout, n) for n in range(8)]),
    ):
        for kind in ("edge", "cable"):
            decided = [estimator(t.values).kind for t in frames(pairs, kind, count, seed=5)]
            print(f"  {optics} {kind:<8}{100.0 * decided.count(kind) / count:>6.1f} % right")


if __name__ == "__main__":
    on_one_core()
    poses = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    published_cells = published_layout()
    goals = Goals()
    accuracy(published_cells, poses, goals)
    kinds(published_cells, max(poses // 5, 10))
    sys.exit(goals.exit_code())
