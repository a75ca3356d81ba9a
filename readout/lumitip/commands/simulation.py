"""`lumitip twin`, `bench-tasks` and `train`: a simulated fingertip, simulated tasks, a policy."""

import argparse
import os
from functools import partial
from pathlib import Path

from lumitip.commands.common import layout_path


def twin(options: argparse.Namespace) -> int:
    """Send packets until Ctrl-C or the end of `--seconds`."""
    from lumitip.errors import UrlError
    from lumitip.layout import Layout
    from lumitip.links import open_link
    from lumitip.links.serve import SerialDevice
    from lumitip.links.url import Url

    address = Url.parse(options.url)
    if address.scheme != "twin":
        raise UrlError(f"the address is {address.text!r}; one like twin://demo is needed")
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
    from lumitip.tasks.report import goals, prepare, write

    layout = Layout.load(options.layout) if options.layout else published_layout()
    try:  # before the long trials
        prepare(options.out)
    except OSError as error:
        raise LumitipError(
            f"--out {options.out}: cannot be written: {error}. Choose another folder"
        ) from error
    say = partial(print, flush=True)
    results = run(layout, options.trials, say=say, cores=options.cores or os.cpu_count() or 1)
    for path in write(results, options.out):
        print(path)
    outcomes = goals(results)
    for met, goal in outcomes:
        print(f"{'met' if met else 'MISSED':<8}{goal}")
    return 0 if all(met for met, _ in outcomes) else 1


def train(options: argparse.Namespace) -> int:
    """Train a policy and write its file.

    Raises:
        LumitipError: if the file exists, or cannot be written.
    """
    from lumitip.errors import LumitipError
    from lumitip.layout import Layout
    from lumitip.links.twin import published_layout
    from lumitip.tasks.training import train as run

    file: Path = options.out or Path(f"{options.kind}.npz")
    layout = Layout.load(options.layout) if options.layout else published_layout()
    try:  # before the long training
        file.touch(exist_ok=False)
    except OSError as error:
        raise LumitipError(
            f"--out {file}: cannot be written as a new file: {error}. Choose another"
        ) from error
    try:
        say = partial(print, flush=True)
        run(layout, options.kind, options.seed, options.rate, say=say).save(file)
    except BaseException:
        file.unlink()
        raise
    print(file)
    return 0
