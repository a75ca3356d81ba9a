"""`lumitip-fab spec`: figures of a design beside the published ones."""

import argparse
import json

from lumitip_fab.cli.screen import OUT


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
        spec.print_table(rows, OUT)
        spec.print_choices(choices, OUT)
    return 0
