"""A search by goals, from its file to built points: its time, and how many of its points build.

`examples/goals_wsg50.toml`: another gripper and supply, a larger area, cost and LED current free
below their limits, so that the front has many points. Five of them are built, which routes their
boards, and each must pass every check. The time is that of search and estimator, without builds:
CPU time of all processes, over two cores.

Run by `make bench`; exits 1 if a goal is missed. Arguments: number of designs, number of points.
"""

import os
import sys
import tempfile
from pathlib import Path

from common import Goals
from lumitip_fab.checks.run import run_checks
from lumitip_fab.cli.build import build
from lumitip_fab.errors import FabError
from lumitip_fab.solve import files
from lumitip_fab.solve.goals import read_goals
from lumitip_fab.solve.study import Options, study

FILE = Path(__file__).parents[1] / "examples" / "goals_wsg50.toml"
DESIGNS, POINTS = 240, 5
MOST_MIN = 30.0
"""Longest search on two cores, by the issue of the search."""


def passes(file: Path) -> bool:
    """Whether a parameter file is built and passes every check; says what does not."""
    try:
        build(file, file.with_suffix(""))
    except FabError as error:
        print(f"  {file.stem}: not built: {error}", flush=True)
        return False
    outcome = run_checks(file.with_suffix(""))
    failed = sorted({measurement.check for measurement in outcome.failed})
    print(f"  {file.stem}: " + (", ".join(failed) or f"passes {len(outcome.names)}"), flush=True)
    return not failed


def main(out: Path, designs: int, points: int) -> int:
    """Search, print the front's points, build them; the exit code."""
    goals = Goals()
    found = study(
        read_goals(FILE), out, Options(designs=designs, points=points), None, lambda *_: None
    )
    spent = os.times()
    cpu_s = spent.user + spent.system + spent.children_user + spent.children_system
    files.write(found, out)
    print(f"  {'':<10}{'edge mm':>9}{'cable mm':>9}{'cost':>8}{'mA':>7}")
    for point in found.points:
        row = point.judged.figures
        print(
            f"  {point.name:<10}{row['edge_mm']:>9.3f}{row['cable_mm']:>9.3f}{row['cost']:>8.2f}"
            f"{row['current_ma']:>7.1f}"
        )
    goals.at_most("search and estimator, on two cores", cpu_s / 120.0, MOST_MIN, "minutes")
    good = sum([passes(out / f"{point.name}.toml") for point in found.points[1:]])
    goals.at_least("points of the front that are built and pass all checks", good, points, "")
    return goals.exit_code()


if __name__ == "__main__":
    asked = [int(text) for text in sys.argv[1:3]]
    with tempfile.TemporaryDirectory() as folder:
        sys.exit(main(Path(folder), *(asked + [DESIGNS, POINTS][len(asked) :])))
