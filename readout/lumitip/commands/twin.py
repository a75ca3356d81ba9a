"""`lumitip twin`: a fingertip that is computed, as a serial device on a pseudo-terminal."""

import argparse
from pathlib import Path

from lumitip.commands.common import Subparsers, layout_path, some_seconds


def add(subparsers: Subparsers) -> None:
    """Say what the command takes."""
    told = "Offer the optical twin as a serial device."
    parser = subparsers.add_parser(
        "twin",
        help=told,
        description=f"{told} It sends the bytes that firmware sends, so that "
        "every program that reads a fingertip reads the twin too. Without a device of its own: "
        "give twin://SHAPE to the other commands.",
    )
    parser.add_argument(
        "url",
        metavar="URL",
        nargs="?",
        default="twin://demo",
        help="twin://SHAPE with its options (twin://demo)",
    )
    parser.add_argument(
        "--serve-serial",
        action="store_true",
        required=True,
        help="send to a new pseudo-terminal, whose name is printed, until Ctrl-C",
    )
    parser.add_argument(
        "--link", type=Path, metavar="PATH", help="also reach the pseudo-terminal by this name"
    )
    parser.add_argument(
        "--layout",
        type=Path,
        metavar="FILE",
        help="layout.json of the design (outputs/layout.json if it is there)",
    )
    parser.add_argument("--seconds", type=some_seconds, metavar="S", help="stop after so long")


def run(options: argparse.Namespace) -> int:
    """Carry it out."""
    from lumitip.errors import UrlError
    from lumitip.layout import Layout
    from lumitip.links import open_link
    from lumitip.links.serve import SerialDevice

    if not options.url.startswith("twin://"):
        raise UrlError(f"{options.url!r} given, an address like twin://demo is needed")
    path = layout_path(options, options.url)
    link = open_link(options.url, Layout.load(path) if path else None)
    with SerialDevice(options.link) as device:
        print(f"{link.device_id}: {len(link.layout)} cells on serial://{device.port}", flush=True)
        device.serve(link, options.seconds)
    return 0
