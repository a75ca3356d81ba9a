"""Time of a pose, by kind, optics and tracking, against the cells, and the memory of the tables.

Frames are simulated by the optical twin, with noise and whole counts; with wrong optics each
fingertip differs from the expected one (`poses`). Each frame is estimated several times; a frame
takes what its fastest run takes, so that pauses of the machine do not count. Run by `make bench`;
exits 1 if a goal is missed.
"""

import resource
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from common import Goals, columns_for, layout_of, on_one_core
from lumitip.estimation import PoseEstimator
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.links.twin import published_layout
from lumitip.twin import Cable, HalfPlane, Twin
from poses import NOISE, frames, wrong_twin

COUNT, FINGERS = 300, 20
RUNS = 5  # of each frame
P99_MS, MEDIAN_MS, FIRST_MS = 5.0, 1.0, 50.0
CELLS, PITCH_MM, MOST_GB = 1008, 3.0, 1.2
KINDS = ("edge", "cable", None)


def main() -> int:
    """Print all tables; the exit code."""
    layout, goals = published_layout(), Goals()
    memory(goals)  # first: a process is said to have had the memory of the one that started it
    alone = PoseEstimator(layout).prepare()
    right, wrong = [Twin(layout)], [wrong_twin(layout, seed) for seed in range(FINGERS)]
    print("\n32 cells, one core (ms)         median    90 %    99 %     all runs: median    99 %")
    for optics, twins in (("right optics", right), ("wrong optics", wrong)):
        for kind in KINDS:
            for shown in ("edge", "cable") if kind is None else (kind,):
                values = [trial.values for trial in frames(twins, shown, COUNT, seed=3)]
                name = f"{shown}, {'undecided, ' if kind is None else ''}{optics}"
                median = _print(name, [_alone(alone, v, kind) for v in values], goals)
                if optics == "right optics" and kind is not None:
                    goals.at_most(f"{name}, 32 cells", median, MEDIAN_MS, "ms median")
        for kind, moving in (("edge", _edges), ("cable", _cables), ("cable", _bends)):
            name = f"{moving.__name__[1:]}, tracked, {optics}"
            tracked = [row for twin in twins for row in _tracked(twin, kind, moving, len(twins))]
            _print(name, np.array(tracked), goals)
    first_frame(layout, goals)
    growth(layout)
    return goals.exit_code()


def _print(name: str, spent: list[list[float]] | Floats, goals: Goals) -> float:
    """One line of the table, with its goal; the median."""
    runs = np.array(spent)
    best = runs.min(axis=1)
    middle, most, worst = (float(np.percentile(best, share)) for share in (50, 90, 99))
    every = [float(np.percentile(runs, share)) for share in (50, 99)]
    print(
        f"{name:<31}{middle:>7.2f}{most:>8.2f}{worst:>8.2f}{every[0]:>21.2f}{every[1]:>8.2f}",
        flush=True,
    )
    goals.at_most(f"{name}, 32 cells", worst, P99_MS, "ms, 99 %")
    return middle


def _alone(estimator: PoseEstimator, values: Floats, kind: str | None) -> list[float]:
    return [_ms(estimator, values, kind) for _ in range(RUNS)]


def _tracked(
    twin: Twin, kind: str, moving: Callable[[int], Iterator[HalfPlane | Cable]], share: int
) -> Floats:
    """Times of each frame of a sequence, in several passes, shape `(frames, RUNS)`."""
    chance = np.random.default_rng(7)
    things = list(moving(max(COUNT // share, 15)))
    noise = NOISE * chance.standard_normal((len(things), len(twin.layout)))
    rows = [
        np.floor(np.clip(twin.values(thing) + by, 0.0, 255.0))
        for thing, by in zip(things, noise, strict=True)
    ]
    passes = []
    tracker = PoseEstimator(twin.layout, tracking=True).prepare(kind)
    for _ in range(RUNS):
        tracker.reset()
        passes.append([_ms(tracker, values, kind) for values in rows])
    return np.array(passes).T


def _edges(count: int) -> Iterator[HalfPlane]:
    for turn in np.linspace(0.0, 3.0 * np.pi, count):
        yield HalfPlane(3.0 * float(np.sin(turn)), 20.0 * float(np.cos(0.7 * turn)))


def _cables(count: int) -> Iterator[Cable]:
    for turn in np.linspace(0.0, 3.0 * np.pi, count):
        yield Cable(3.0 * float(np.sin(turn)), 20.0 * float(np.cos(0.7 * turn)))


def _bends(count: int) -> Iterator[Cable]:
    """A cable that is straight at first, then bends with radii down to 60 mm, to either side."""
    for turn in np.linspace(0.0, 2.0 * np.pi, count):
        bend = float(np.sin(turn)) / 60.0
        yield Cable(1.5 * float(np.sin(0.5 * turn)), 10.0 * float(np.cos(turn)), bend)


def first_frame(layout: Layout, goals: Goals) -> None:
    """The first frame of each kind after `prepare()`, with wrong optics."""
    values = {kind: frames([wrong_twin(layout, 1)], kind, 1, 5)[0].values for kind in KINDS[:2]}
    spent = []
    for kind in KINDS[:2]:
        estimator = PoseEstimator(layout).prepare()
        spent.append(_ms(estimator, values[kind], kind))
    print(f"\nfirst frame after prepare(): {max(spent):.1f} ms")
    goals.at_most("first frame after prepare()", max(spent), FIRST_MS, "ms")


def growth(base: Layout) -> None:
    """Median time against the number of cells, right optics."""
    print("\n cells   edge   cable   undecided (ms, median)")
    for cells in (32, 128, 512):
        pitch_mm = 6.0 * float(np.sqrt(32.0 / cells))
        layout = base if cells == 32 else layout_of(columns_for(cells), pitch_mm, base.optics)
        estimator, twin = PoseEstimator(layout).prepare(), Twin(layout)
        medians = []
        for kind, shown in (("edge", "edge"), ("cable", "cable"), (None, "edge")):
            values = [trial.values for trial in frames([twin], shown, 100, seed=3)]
            medians.append(np.median([min(_alone(estimator, v, kind)) for v in values]))
        print(f"{cells:>6}{medians[0]:>7.2f}{medians[1]:>8.2f}{medians[2]:>12.2f}", flush=True)


def memory(goals: Goals) -> None:
    """Greatest memory of a process that prepares every kind and estimates one frame."""
    command = [sys.executable, str(Path(__file__)), "--memory"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    gigabytes = float(done.stdout)
    print(f"{CELLS} cells at {PITCH_MM:g} mm: {gigabytes:.2f} GB at most")
    goals.at_most(f"memory, {CELLS} cells at {PITCH_MM:g} mm", gigabytes, MOST_GB, "GB")


def _memory() -> float:
    layout = layout_of(columns_for(CELLS), PITCH_MM, published_layout().optics)
    estimator = PoseEstimator(layout).prepare()
    estimator(Twin(layout).values(HalfPlane(offset_mm=1.0, angle_deg=10.0)))
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6


def _ms(estimator: PoseEstimator, values: Floats, kind: str | None) -> float:
    begun = time.perf_counter()
    estimator(values, kind)
    return 1e3 * (time.perf_counter() - begun)


if __name__ == "__main__":
    on_one_core()
    if sys.argv[1:] == ["--memory"]:
        print(_memory())
        sys.exit()
    sys.exit(main())
