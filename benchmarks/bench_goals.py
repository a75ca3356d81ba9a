"""The design that a search by goals found, against the published sensor, under wrong optics.

No cell, cost or LED current may be added. The estimator expects each design's drawing; the
fingertips differ from it. Edges and cables of 3 mm at a gap of 3 mm: first on frames of the twin
with wrong optics, as `lumitip-fab explore` has them, then on those of the second optical model,
which the search never saw (`second_light`), with holes and depths of each design. A gross error
counts as 2 mm or 10 degrees. Intervals are of 95 %, by a bootstrap over fingertips, which are the
same for both designs.

Run by `make bench`; exits 1 if a goal is missed. Arguments: number of poses, number of fingertips
of the second model.
"""

import sys
from pathlib import Path

import numpy as np

from common import Goals, on_one_core
from lumitip.estimation import PoseEstimator
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip_fab import derived
from lumitip_fab.explore.accuracy import MOST_DEG, MOST_MM, Grasp, Sample, Trials, gross, rms
from poses import estimated, misses
from second_bench import fingers, trials
from second_light import Light
from second_tips import Tips, drawn

POSES, FINGERS, SEED = 120, 6, 900
TWINS = 40
"""Fingertips of the twin."""
_RESAMPLED = 2000
LOWER_PERCENT = 30.0
"""Least reduction of the error, by the issue of the search."""
PRESETS = Path(__file__).parents[1] / "design" / "presets"
DESIGNS = {"published": PRESETS / "published.toml", "by goals": PRESETS / "by_goals.toml"}
KINDS = ("edge", "cable")


def of_twin(layout: Layout) -> dict[str, Floats]:
    """Errors of offset (mm) and angle (degrees) by kind, shape `(n, 2)`."""
    tried = Trials(layout, Sample(fingers=TWINS), Grasp())
    return {kind: tried.misses(kind) for kind in KINDS}


def of_second_model(
    layout: Layout, silicone_mm: float, poses: int, count: int
) -> dict[str, Floats]:
    """The same on frames of the second model, tared."""
    optics = layout.optics
    tips = Tips(
        hole_mm=optics.hole_mm,
        film_mm=optics.film_mm,
        board_mm=silicone_mm,
        led_depth_mm=optics.emitter_depth_mm,
        detector_depth_mm=optics.detector_depth_mm,
    )
    found = [
        Light.of(layout, drawn(np.random.default_rng((2, SEED + n)), tips), SEED + n)
        for n in range(count)
    ]
    method = estimated(PoseEstimator(layout).prepare(*KINDS))
    pairs = fingers(found, SEED, 0.0)
    missed = {kind: misses(method, trials(pairs, kind, poses, SEED), kind) for kind in KINDS}
    return {kind: np.minimum(rows, (MOST_MM, MOST_DEG)) for kind, rows in missed.items()}


def lower_percent(before: Floats, after: Floats, count: int) -> tuple[float, float, float]:
    """How much lower (%) the rms error of the offset is, and the ends of its interval.

    Args:
        before, after: misses of both designs, shape `(kinds, n, 2)`, finger by finger.
        count: fingertips.
    """
    finger = np.arange(before.shape[1]) * count // before.shape[1]
    squares = np.array(
        [[np.square(of[:, finger == n, 0]).mean() for n in range(count)] for of in (before, after)]
    )
    chosen = np.random.default_rng(SEED).integers(0, count, (_RESAMPLED, count))
    drawn = squares[:, chosen].mean(axis=2)
    low, high = np.percentile(100.0 * (1.0 - np.sqrt(drawn[1] / drawn[0])), (2.5, 97.5))
    whole = squares.mean(axis=1)
    return 100.0 * float(1.0 - np.sqrt(whole[1] / whole[0])), float(low), float(high)


def main(poses: int, count: int) -> int:
    """Print both tables; the exit code."""
    goals = Goals()
    designs = {name: derived(file) for name, file in DESIGNS.items()}
    for model, tips, errors in (
        ("the twin, optics wrong", TWINS, {n: of_twin(d.layout) for n, d in designs.items()}),
        (
            "a model that shares nothing with the twin",
            count,
            {
                n: of_second_model(d.layout, d.stack.silicone_mm, poses, count)
                for n, d in designs.items()
            },
        ),
    ):
        print(f"frames of {model}, {tips} fingertips")
        print(f"  {'':<24}{'rms mm':>8}{'deg':>8}{'gross %':>9}")
        for name, of in errors.items():
            for kind, rows in of.items():
                print(
                    f"  {name + ', ' + kind:<24}{rms(rows[:, 0]):>8.3f}{rms(rows[:, 1]):>8.2f}"
                    f"{100.0 * gross(rows).mean():>9.1f}",
                    flush=True,
                )
        for kinds in (*((kind,) for kind in KINDS), KINDS):
            before, after = (np.array([errors[name][kind] for kind in kinds]) for name in DESIGNS)
            lower, low, high = lower_percent(before, after, tips)
            print(f"  {' and '.join(kinds)}: lower by {lower:.0f} %, {low:.0f} to {high:.0f} %")
        goals.at_least(f"{model}: position error lower by", lower, LOWER_PERCENT, "%")
    one, other = designs.values()
    goals.at_most("cells", len(other.layout), len(one.layout))
    current = [sum(design.wiring.current_ma) for design in (one, other)]
    goals.at_most("LED current", current[1], round(current[0], 3), "mA")
    return goals.exit_code()


if __name__ == "__main__":
    on_one_core()
    asked = [int(text) for text in sys.argv[1:3]]
    sys.exit(main(*(asked + [POSES, FINGERS][len(asked) :])))
