"""`lumitip-fab slice`: slice the printed parts."""

import argparse

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from lumitip_fab.cli.screen import ERR, OUT
from lumitip_fab.parts import slicing


def run(options: argparse.Namespace) -> int:
    """Slice, with progress."""
    columns = (TextColumn("{task.description:<32}"), BarColumn(), MofNCompleteColumn())
    silent = options.quiet or options.json
    with Progress(*columns, console=ERR, disable=silent, transient=True) as bar:
        shown = bar.add_task("slicing", total=None)

        def progress(name: str, done: int, total: int) -> None:
            bar.update(shown, description=name, completed=done, total=total)

        parts = slicing.slice_parts(options.out, options.gcode, progress)
    if options.json:
        print(slicing.as_json(parts))
    elif not options.quiet:
        slicing.print_table(parts, OUT)
    return 0
