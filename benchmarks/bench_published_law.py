"""The published law on cables, tuned on four times as many curves as `lumitip bench-tasks` uses.

A law that is compared with it must beat it at its best. Prints the lost curves at each speed, and
how much faster the law of the line's angle is, whose top speeds `bench-tasks` found. Run by `make
bench`; exits 1 if the goal is missed. The argument is the number of curves at each speed.
"""

import os
import sys

from common import Goals
from lumitip.links.twin import published_layout
from lumitip.tasks import Settings
from lumitip.tasks.bench import workers
from lumitip.tasks.report import FASTER, FEW
from lumitip.tasks.trial import Summary, Team, search, summary

TUNED_AT_MM_S, CURVES = 120.0, range(10_000, 10_048)
SPEEDS_MM_S = tuple(float(speed) for speed in range(60, 261, 20))
LINE_MM_S = {0.0: 380.0, FEW: 400.0}
"""Top speed of the law of the line's angle by share of lost curves; docs/estimation.md."""


def fastest(rows: list[Summary], most: float) -> float:
    """The highest speed (mm/s) up to which at most this share of the curves was lost; NaN if the
    slowest lost more."""
    kept_mm_s = float("nan")
    for row in rows:
        if row.loss_rate > most:
            break
        kept_mm_s = row.speed_mm_s
    return kept_mm_s


def main(count: int) -> int:
    """Print the table; the exit code."""
    goals = Goals()
    with workers(os.cpu_count() or 1) as pool:
        team = Team(pool, published_layout(), Settings("cable"))
        tuned = search(team, "centre", TUNED_AT_MM_S, seeds=CURVES)
        tuning = tuned.tuning
        print(f"best of {tuned.tried}: K_p {tuning.gain_per_s:.3g}/s, {tuning.height_mm:+.2f} mm")
        rows = [summary(team, "centre", speed, tuning, range(count)) for speed in SPEEDS_MM_S]
    for row in rows:
        print(f"{row.speed_mm_s:5.0f} mm/s  {row.losses:3} of {count} lost")
    for most, line_mm_s in LINE_MM_S.items():
        goals.at_least(
            f"cable, at most {100.0 * most:g} % lost: the line's angle, times as fast",
            line_mm_s / fastest(rows, most),
            FASTER,
        )
    return goals.exit_code()


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 100))
