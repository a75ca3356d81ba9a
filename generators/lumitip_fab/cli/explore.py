"""`lumitip-fab explore`: compare designs before one is built."""

import argparse

from lumitip_fab.cli.limits import SEEDS, require_in_range
from lumitip_fab.cli.screen import OUT, counted
from lumitip_fab.explore import report
from lumitip_fab.explore.accuracy import Sample
from lumitip_fab.explore.run import explore
from lumitip_fab.explore.vary import MOST_DESIGNS

_LIMITS = {"points": (1, MOST_DESIGNS), "seed": SEEDS}


def run(options: argparse.Namespace) -> int:
    """Run a study, with progress."""
    require_in_range(options, _LIMITS)
    silent = options.quiet or options.json
    with counted("designs", silent) as progress:
        study = explore(
            options.file,
            options.vary,
            options.out,
            options.points,
            options.keep_size,
            Sample(seed=options.seed),
            options.scheduler,
            progress,
        )
    written = report.write(study, options.out)
    if options.json:
        print((options.out / "designs.json").read_text(encoding="utf-8"), end="")
    elif not options.quiet:
        report.print_table(study, OUT)
        OUT.print(
            f"{study.evaluated} of {len(study.designs)} designs evaluated now, the others "
            "were known; wrote " + ", ".join(map(str, written)),
            soft_wrap=True,
        )
    return 0
