"""A learned policy against the tuned laws, on 20 fingertips that neither has seen.

They differ in optics and gains (`poses.wrong_twin`), and a quarter each has 0, 1, 2 and 3 dead
cells. The policy was trained on fingertips of its own spread (`lumitip train`). The laws are tuned
on twelve others of the same kind, at several speeds; the best of these tunings counts at each speed
of the test, which favours them. Everyone has the same limits of velocity, and the same curves.

Run by `make bench`; exits 1 if the policy is no faster than the best law at equal loss. With a
layout or with files of policies as arguments, others are tried.
"""

import argparse
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import product
from pathlib import Path

import numpy as np

from common import Goals
from lumitip.control import Tracer
from lumitip.links.twin import published_layout
from lumitip.tasks.batch import TaskBatch
from lumitip.tasks.bench import workers
from lumitip.tasks.policy import LIMITS, Memory, Policy
from lumitip.tasks.task import KINDS, Metrics, Settings, Task
from lumitip.tasks.trial import Bench, Tuning, at_edge
from poses import wrong_twin

LAYOUT = published_layout()
TEST, TUNING = range(1, 21), range(1000, 1012)
"""Seeds of the fingertips."""
CURVES = 5
"""Of each fingertip."""
SPEEDS_MM_S = (100, 200, 240, 280, 320, 360, 400, 440, 480, 520, 560, 600)
TUNED_AT_MM_S = (280, 380)
GRID = tuple(
    Tuning(*of)
    for of in product((5.0, 8.0, 12.0, 16.0, 24.0), (10.0, 14.0, 20.0, 28.0), (0.03, 0.06, 0.09))
)
"""Around the best tunings at these speeds."""
MOST_LOST = 0.05
LAWS = ("line", "pose")
_ENOUGH = 0.3  # lost: faster is not tried
_LONGEST = 2.5  # times the time for the curve


@dataclass(frozen=True)
class Row:
    """Trials at one speed."""

    lost: int
    trials: int
    lateral_rms_mm: float
    """Over those that kept the line."""

    @property
    def share(self) -> float:
        """Of the trials that lost the line."""
        return self.lost / self.trials

    @property
    def order(self) -> tuple[int, float]:
        """The least is the best."""
        return self.lost, self.lateral_rms_mm


def settings(kind: str, seed: int) -> Settings:
    """Those of a fingertip's tasks."""
    return Settings(kind, dead_cells=seed % 4)


class Fast(Bench):
    """A bench whose tracers have the limits of the policy's training."""

    def tracer(self, controller: str, speed_mm_s: float, tuning: Tuning) -> Tracer:
        """See `Bench`."""
        made = super().tracer(controller, speed_mm_s, tuning)
        return Tracer(made.law, LIMITS, lead_s=tuning.lead_s)


@lru_cache(maxsize=40)
def bench(kind: str, seed: int) -> Fast:
    """That of a fingertip."""
    return Fast(Task(LAYOUT, settings(kind, seed), wrong_twin(LAYOUT, seed)))


def tried(kind: str, law: str, speed_mm_s: float, curves: int, tuning: Tuning, seed: int) -> Row:
    """A law on one fingertip."""
    first = CURVES * seed
    made: list[Metrics] = [
        bench(kind, seed).run(law, speed_mm_s, tuning, number)
        for number in range(first, first + curves)
    ]
    kept = [of.lateral_rms_mm for of in made if not of.lost]
    return Row(len(made) - len(kept), len(made), _rms(kept))


def learned(policy: Policy, speed_mm_s: float, seed: int) -> Row:
    """A policy on one fingertip, all curves at once."""
    batch = TaskBatch(CURVES, LAYOUT, settings(policy.kind, seed), wrong_twin(LAYOUT, seed))
    first = CURVES * seed
    values = batch.reset(range(CURVES), list(range(first, first + CURVES)))
    memory, speeds = Memory(CURVES, len(LAYOUT)), np.full(CURVES, float(speed_mm_s))
    over, lost = np.zeros(CURVES, bool), np.zeros(CURVES, bool)
    errors = []
    s = batch.settings
    for _ in range(round(_LONGEST * s.length_mm / speed_mm_s * s.rate_hz)):
        commands = policy(memory.see(values, speeds))
        memory.act(commands)
        values = batch.step(commands)
        errors.append(np.where(over, np.nan, batch.line()[0]))
        lost |= batch.lost & ~over
        over |= batch.ended
        if over.all():
            break
    lost |= ~over
    each = np.sqrt(np.nanmean(np.square(errors), axis=0))
    return Row(int(lost.sum()), CURVES, _rms(each[~lost].tolist()))


def _rms(values: Iterable[float]) -> float:
    found = list(values)
    return float(np.sqrt(np.mean(np.square(found)))) if found else float("nan")


def together(rows: Iterable[Row]) -> Row:
    """The trials of several fingertips."""
    each = list(rows)
    kept = [of for of in each if of.lost < of.trials]
    squares = sum((of.trials - of.lost) * of.lateral_rms_mm**2 for of in kept)
    count = sum(of.trials - of.lost for of in kept)
    return Row(
        sum(of.lost for of in each),
        sum(of.trials for of in each),
        float(np.sqrt(squares / count)) if count else float("nan"),
    )


def faster(name: str, row_of: Callable[[float], Row]) -> dict[float, Row]:
    """Rising speeds until too many curves are lost."""
    rows: dict[float, Row] = {}
    for speed_mm_s in SPEEDS_MM_S:
        rows[speed_mm_s] = row = row_of(speed_mm_s)
        print(
            f"  {name:<10}{speed_mm_s:>5} mm/s: {row.lost:>3} of {row.trials} lost, "
            f"{row.lateral_rms_mm:.2f} mm rms",
            flush=True,
        )
        if row.share > _ENOUGH:
            break
    return rows


def fastest(rows: dict[float, Row]) -> float:
    """The highest speed up to which at most 5 % are lost (mm/s)."""
    best = 0.0
    for speed_mm_s, row in rows.items():
        if row.share > MOST_LOST:
            break
        best = speed_mm_s
    return best


def compared(kind: str, policy: Policy, goals: Goals, jobs: int) -> None:
    """Print the tables of one kind of object, and judge."""
    print(f"\n{kind}: {policy!r}, seed {policy.seed}")
    with workers(jobs) as pool:

        def all_of(one: Callable[[int], Row], seeds: Iterable[int]) -> Row:
            return together(pool.map(one, seeds))

        best = {}
        for law in LAWS:
            tunings = []
            for at_mm_s in TUNED_AT_MM_S:
                scores = {
                    tuning: all_of(partial(tried, kind, law, at_mm_s, 1, tuning), TUNING)
                    for tuning in GRID
                }
                tunings.append(min(GRID, key=lambda tuning: scores[tuning].order))
                edge = ", ".join(at_edge(tunings[-1], GRID)) or "nothing"
                print(f"  {law}, tuned at {at_mm_s} mm/s: {tunings[-1]}; at the edge: {edge}")

            def row(speed_mm_s: float, law: str = law, of: list[Tuning] = tunings) -> Row:
                found = (
                    all_of(partial(tried, kind, law, speed_mm_s, CURVES, tuning), TEST)
                    for tuning in dict.fromkeys(of)
                )
                return min(found, key=lambda row: row.order)

            best[law] = fastest(faster(law, row))
        own = fastest(faster("policy", lambda speed: all_of(partial(learned, policy, speed), TEST)))
    most = max(best.values())
    goals.at_least(f"{kind}: times the best law, at most 5 % lost", own / max(most, 1.0), 1.05, "")


def main() -> int:
    """Print everything; the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--policy", type=Path, nargs="*", default=[], help="files of policies")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    options = parser.parse_args()
    policies = [Policy.load(file) for file in options.policy]
    goals = Goals()
    for policy in policies or [Policy.shipped(kind) for kind in KINDS]:
        compared(policy.kind, policy, goals, options.jobs)
    return goals.exit_code()


if __name__ == "__main__":
    sys.exit(main())
