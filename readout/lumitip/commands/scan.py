"""`lumitip scan`: list the fingertips that can be seen from here."""

import argparse
import sys
from collections import Counter

from lumitip.commands.common import Subparsers, some_seconds

NONE_FOUND = 1


def add(subparsers: Subparsers) -> None:
    """Say what the command takes."""
    told = "List fingertips over Bluetooth, and USB serial ports that may be one."
    parser = subparsers.add_parser("scan", help=told, description=told)
    parser.add_argument(
        "--seconds", type=some_seconds, default=5.0, metavar="S", help="how long to listen (5)"
    )
    parser.add_argument("--only", choices=("ble", "serial"), help="one kind of link alone")


def run(options: argparse.Namespace) -> int:
    """Carry it out."""
    from lumitip.links.scan import scan

    result = scan(options.seconds, options.only)
    names = Counter(found.name for found in result.found if found.sure)
    for found in result.found:
        namesake = ", open it by this address: others are of this name too"
        more = namesake if found.sure and names[found.name] > 1 else ""
        maybe = "" if found.sure else ", may be a fingertip"
        print(f"{found.url}  {found.name}  {found.detail}{maybe}{more}")
    for why in result.unsearched:
        print(f"not searched: {why}", file=sys.stderr)
    if not result.found:
        print("no fingertip found; twin://demo is always there", file=sys.stderr)
    return 0 if result.found else NONE_FOUND
