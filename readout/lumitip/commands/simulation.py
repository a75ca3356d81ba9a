"""`lumitip twin` and `bench-tasks`: a simulated fingertip, and simulated tasks."""

import argparse
import os
from functools import partial
from pathlib import Path

from lumitip.commands.common import (
    Subparsers,
    add_layout,
    command,
    layout_path,
    positive_count,
    positive_seconds,
)


def add(subparsers: Subparsers) -> None:
    """Add the subcommands."""
    parser = command(
        subparsers,
        "twin",
        twin,
        "Simulate a fingertip as a serial device.",
        "It sends the same bytes as the firmware, so that every program can read it. "
        "Other commands open a simulated fingertip directly as twin://SHAPE.",
    )
    parser.add_argument(
        "url",
        metavar="URL",
        nargs="?",
        default="twin://demo",
        help="twin://SHAPE with options (default: twin://demo)",
    )
    parser.add_argument(
        "--serve-serial",
        action="store_true",
        required=True,
        help="send to a new pseudo-terminal until Ctrl-C; its name is printed",
    )
    parser.add_argument(
        "--link", type=Path, metavar="PATH", help="also create a symbolic link to the terminal"
    )
    add_layout(parser)
    parser.add_argument(
        "--seconds", type=positive_seconds, metavar="S", help="stop after S seconds"
    )

    parser = command(
        subparsers,
        "bench-tasks",
        bench_tasks,
        "Follow simulated cloth edges and cables with each controller at rising speeds: a table, "
        "plots if matplotlib is installed, and goals (exit code 1 if one is missed).",
    )
    parser.add_argument(
        "--layout",
        type=Path,
        metavar="FILE",
        help="layout.json (default: the published sensor)",
    )
    parser.add_argument(
        "--trials",
        type=positive_count,
        default=100,
        metavar="N",
        help="curves at each speed (default: 100)",
    )
    parser.add_argument(
        "--cores",
        type=positive_count,
        default=os.cpu_count() or 1,
        metavar="N",
        help="number of processes (default: one per core)",
    )
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("bench-tasks"),
        metavar="FOLDER",
        help="folder of tasks.md, tasks.json and tasks.svg (default: bench-tasks)",
    )


def twin(options: argparse.Namespace) -> int:
    """Send packets until Ctrl-C or the end of `--seconds`."""
    from lumitip.errors import UrlError
    from lumitip.layout import Layout
    from lumitip.links import open_link
    from lumitip.links.serve import SerialDevice

    if not options.url.startswith("twin://"):
        raise UrlError(f"the address is {options.url!r}; one like twin://demo is needed")
    path = layout_path(options, options.url)
    link = open_link(options.url, Layout.load(path) if path else None)
    with SerialDevice(options.link) as device:
        print(f"{link.device_id}: {len(link.layout)} cells on serial://{device.port}", flush=True)
        device.serve(link, options.seconds)
    return 0


def bench_tasks(options: argparse.Namespace) -> int:
    """Run the trials and write the results; exit code 1 if a goal is missed."""
    from lumitip.errors import LumitipError
    from lumitip.layout import Layout
    from lumitip.links.twin import published_layout
    from lumitip.tasks.bench import bench_tasks as run
    from lumitip.tasks.report import goals, write

    layout = Layout.load(options.layout) if options.layout else published_layout()
    try:  # before the long trials
        options.out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise LumitipError(f"--out {options.out}: cannot be created: {error}") from error
    say = partial(print, flush=True)
    results = run(layout, options.trials, say=say, cores=options.cores)
    for path in write(results, options.out):
        print(path)
    outcomes = goals(results)
    for met, goal in outcomes:
        print(f"{'met' if met else 'MISSED':<8}{goal}")
    return 0 if all(met for met, _ in outcomes) else 1
