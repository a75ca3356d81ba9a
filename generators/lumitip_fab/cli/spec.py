"""`lumitip-fab spec`: figures of a design beside the published ones."""

import argparse
import json
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table

from lumitip_fab.cli.screen import OUT

if TYPE_CHECKING:
    from lumitip_fab.docs.row import Row


def run(options: argparse.Namespace) -> int:
    """Print figures and automatic choices."""
    from lumitip_fab.config.load import load
    from lumitip_fab.derive import derive
    from lumitip_fab.docs import spec

    design = derive(load(options.file))
    rows, choices = spec.rows(design), spec.choice_rows(design)
    if options.out:
        from lumitip_fab.cli.built import built_rows

        rows += built_rows(options.out, design)
    if options.json:
        print(json.dumps([vars(row) for row in (*rows, *choices)], indent=1))
    else:
        _print_table(rows, OUT)
        _print_choices(choices, OUT)
        if not options.out:
            OUT.print("\nMasses and strength are measured in built files: add --out FOLDER.")
    return 0


def _print_table(rows: "tuple[Row, ...]", console: Console) -> None:
    """The rows as a table."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    for heading in ("", "published", "this design"):
        table.add_column(heading, no_wrap=True)
    table.add_column("why they differ", style="dim", overflow="fold")
    for row in rows:
        differs = row.published != row.computed
        table.add_row(row.quantity, row.published, row.computed, row.reason if differs else "")
    console.print(table)


def _print_choices(choices: "tuple[Row, ...]", console: Console) -> None:
    """The automatic values as a table, one line each."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    for heading in ("automatic", "value"):
        table.add_column(heading, no_wrap=True)
    table.add_column("reason", style="dim", overflow="ellipsis", no_wrap=True)
    for row in choices:
        table.add_row(row.quantity, row.computed, row.reason)
    console.print()
    console.print(table)
