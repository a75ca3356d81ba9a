"""`lumitip bench-tasks`: how fast each controller follows cloth and cable in simulation."""

import argparse
import os
from pathlib import Path

from lumitip.commands.common import Subparsers


def add(subparsers: Subparsers) -> None:
    """Say what the command takes."""
    told = (
        "Follow simulated cloth edges and cables with each controller, faster and faster: "
        "a table, plots where matplotlib is installed, and goals (exit code 1 if one is missed)."
    )
    parser = subparsers.add_parser("bench-tasks", help=told, description=told)
    parser.add_argument(
        "--layout", type=Path, metavar="FILE", help="layout.json (the published sensor's)"
    )
    parser.add_argument(
        "--trials", type=int, default=100, metavar="N", help="curves at each speed (100)"
    )
    parser.add_argument(
        "--cores",
        type=int,
        default=os.cpu_count() or 1,
        metavar="N",
        help="processes that share the trials (all cores)",
    )
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("bench-tasks"),
        metavar="FOLDER",
        help="where tasks.md, tasks.json and tasks.svg go (bench-tasks)",
    )


def run(options: argparse.Namespace) -> int:
    """Carry it out; the exit code is 1 if a goal was missed."""
    from lumitip.errors import LumitipError
    from lumitip.layout import Layout
    from lumitip.links.twin import published_layout
    from lumitip.tasks.bench import bench_tasks
    from lumitip.tasks.report import goals, write

    if options.trials < 1:
        raise LumitipError(f"--trials {options.trials} given, one or more are needed")
    if options.cores < 1:
        raise LumitipError(f"--cores {options.cores} given, one or more are needed")
    layout = Layout.load(options.layout) if options.layout else published_layout()
    try:  # now, and not when the trials are done
        options.out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise LumitipError(f"--out {options.out}: cannot be made a folder: {error}") from error

    def say(line: str) -> None:
        print(line, flush=True)

    results = bench_tasks(layout, options.trials, say=say, cores=options.cores)
    for path in write(results, options.out):
        print(path)
    told = goals(results)
    for met, goal in told:
        print(f"{'met' if met else 'MISSED':<8}{goal}")
    return 0 if all(met for met, _ in told) else 1
