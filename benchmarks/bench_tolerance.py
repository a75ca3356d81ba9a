"""Built fingers a minute in a study of tolerances, and how its estimates compare.

Every finger is one of the published sensor with all of its deviations, tried with 16 edges and 16
cables as built, after a tare and after self-calibration (40 more edges). Processor time of one
process is printed too, since it hardly depends on what else the machine does. A sample of the
estimates is compared with those of `PoseEstimator`. Run by `make bench`; exits 1 if a goal is
missed. The argument is the number of fingers.
"""

import sys
import time
from functools import partial
from pathlib import Path

from common import Goals
from lumitip_fab.config.load import load
from lumitip_fab.derive import resolve
from lumitip_fab.derive.making.tolerances import spreads
from lumitip_fab.tolerance.bench import COLUMNS, bench
from lumitip_fab.tolerance.cores import on_cores
from lumitip_fab.tolerance.draws import draw
from lumitip_fab.tolerance.options import Options
from lumitip_fab.tolerance.study import cases_of

FINGERS_A_MINUTE = 500
CORES = 2
SOME = 20
"""Fingers whose processor time is measured."""
PUBLISHED = Path(__file__).parents[1] / "design" / "presets" / "published.toml"


def main(fingers: int) -> int:
    """Print the figures; the exit code."""
    goals, resolved, options = Goals(), resolve(load(PUBLISHED)), Options()
    config, layout = resolved.config, resolved.design.layout
    (case,) = cases = cases_of(config, layout, options)
    take = partial(draw, config.catalogue.tolerances, spreads(config), len(layout))
    with on_cores(cases, CORES) as errors:
        errors(take(40, 1), COLUMNS)  # processes start, and prepare their tables
        for columns in (COLUMNS, COLUMNS[1:2]):
            drawn, begin = take(fingers, 0), time.perf_counter()
            errors(drawn, columns)
            speed = 60.0 * fingers / (time.perf_counter() - begin)
            print(
                f"{' + '.join(columns)}: {speed:,.0f} fingers a minute on {CORES} cores, "
                f"{options.poses} edges and {options.poses} cables each"
            )
            goals.at_least(f"fingers, {len(columns)} columns", speed, FINGERS_A_MINUTE, "/min")
    for columns in (COLUMNS, COLUMNS[1:2]):
        begin = time.process_time()
        bench(case).errors(take(SOME, 0), columns)
        used = (time.process_time() - begin) / SOME
        print(f"{' + '.join(columns)}: {1000.0 * used:.0f} ms of processor time a finger")
    compared = bench(case).compared(take(30, 0))
    print("PoseEstimator: " + ", ".join(f"{n} {v:.4g}" for n, v in compared.items()))
    goals.at_least("frames with the pose of PoseEstimator", compared["agree_percent"], 85, "%")
    goals.at_most("gross errors without a flag", compared["gross_percent"], 2.0, "%")
    return goals.exit_code()


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 500))
