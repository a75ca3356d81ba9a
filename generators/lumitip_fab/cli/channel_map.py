"""`lumitip-fab channel-map`: the detector of each multiplexer input, read from copper."""

import argparse
import json
import sys

from lumitip_fab.cli.screen import FAILED


def run(options: argparse.Namespace) -> int:
    """Print the map, from the copper of the board."""
    from lumitip_fab.checks.connections import read_channels

    found = read_channels(options.file)
    if options.json:
        print(json.dumps(found.best, indent=1))
    else:
        for mux, inputs in found.best.items():
            listed = "  ".join(f"{channel}:{detector}" for channel, detector in inputs.items())
            print(f"{mux} ({found.output[mux] or 'no net'})  {listed}")
    for doubt in found.doubts:
        print(doubt, file=sys.stderr)
    return FAILED if found.contradicted else 0
