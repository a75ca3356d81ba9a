"""Share of traces that are lost with three dead cells of 32, at 200 mm/s, on simulated fingers.

Dead cells are drawn anew for each of the curves. They read nothing, 0 or 255. The laws have the
tunings that `lumitip bench-tasks` found. Run by `make bench`; exits 1 if a goal is missed.
The argument is the number of curves.
"""

import os
import sys

import numpy as np

from common import Goals
from lumitip.links.twin import published_layout
from lumitip.tasks import Settings, Tuning
from lumitip.tasks.bench import workers
from lumitip.tasks.trial import Team

SPEED_MM_S, DEAD, MOST_LOST = 200.0, 3, 0.05
TUNED = {"cloth": Tuning(24.0, 6.0, 0.03), "cable": Tuning(8.0, 14.0, 0.06)}
READS = (("none dead", 0, None), ("nothing", DEAD, None), ("0", DEAD, 0.0), ("255", DEAD, 255.0))


def main(count: int) -> int:
    """Print the table; the exit code."""
    goals, layout = Goals(), published_layout()
    print(f"{'task':<8}{'dead cells read':<18}{'controller':<12}{'lost':>10}{'lateral rms':>14}")
    with workers(os.cpu_count() or 1) as pool:
        for kind, tuning in TUNED.items():
            for reads, dead, value in READS:
                team = Team(pool, layout, Settings(kind, dead_cells=dead, dead_value=value))
                for controller in ("line", "pose"):
                    found = team.run_all(controller, SPEED_MM_S, tuning, range(count))
                    lost = sum(trial.lost for trial in found)
                    kept = [trial.lateral_rms_mm for trial in found if not trial.lost]
                    rms = f"{np.mean(kept):.2f} mm" if kept else "–"
                    print(f"{kind:<8}{reads:<18}{controller:<12}{lost:>4} of {count}{rms:>14}")
                    if controller == "pose":
                        name = f"{kind}, dead cells read {reads}: lost with the pose estimator"
                        goals.at_most(name, lost / count, MOST_LOST)
    return goals.exit_code()


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 100))
