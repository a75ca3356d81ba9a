"""`lumitip-fab tolerance`: share of built fingers that meet the goals."""

import argparse
import json
from contextlib import nullcontext

from lumitip_fab.cli.screen import ERR, OUT
from lumitip_fab.config.load import load
from lumitip_fab.derive import resolve
from lumitip_fab.tolerance import report
from lumitip_fab.tolerance.options import Goals, Options
from lumitip_fab.tolerance.study import study


def run(options: argparse.Namespace) -> int:
    """Run a study of tolerances."""
    goals = Goals(options.position, options.angle)
    asked = Options(goals, options.gap, options.fingers, options.poses, options.seed)
    if options.out:
        report.prepare(options.out)
    resolved = resolve(load(options.file))
    silent = options.quiet or options.json
    with nullcontext() if silent else ERR.status("building and trying fingers …"):
        found = study(resolved.config, resolved.design.layout, asked)
    written = report.write(found, options.out) if options.out else []
    if options.json:
        print(json.dumps(found, indent=1, ensure_ascii=False))
    elif not options.quiet:
        report.print_tables(found, OUT)
        if written:
            OUT.print("wrote " + ", ".join(map(str, written)), soft_wrap=True)
    return 0
