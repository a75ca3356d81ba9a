"""Helpers of several subcommands: arguments that name a fingertip, and opening it."""

import argparse
import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lumitip.fingertip import Fingertip

Subparsers = Any  # argparse does not export this type
BUILT_LAYOUT = Path("outputs/layout.json")


def command(
    subparsers: Subparsers,
    name: str,
    run: Callable[[argparse.Namespace], int],
    text: str,
    more: str = "",
) -> argparse.ArgumentParser:
    """Add a subcommand; its help continues `text` with `more`."""
    description = f"{text} {more}".strip()
    parser: argparse.ArgumentParser = subparsers.add_parser(
        name, help=text, description=description
    )
    parser.set_defaults(run=run)
    return parser


def positive_seconds(text: str) -> float:
    """A time above 0 (s), for `type=` of an argument."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not value > 0.0:
        raise argparse.ArgumentTypeError(f"the value is {text}; a number above 0 (s) is needed")
    return value


def positive_count(text: str) -> int:
    """A whole number from 1 on, for `type=` of an argument."""
    try:
        value = int(text)
    except ValueError:
        value = 0
    if value < 1:
        raise argparse.ArgumentTypeError(f"the value is {text}; a whole number from 1 on is needed")
    return value


def add_fingertip(parser: argparse.ArgumentParser, several: bool = False) -> None:
    """Add the arguments that name one fingertip (`options.url`), or several (`options.urls`)."""
    text = "ble://NAME-OR-ADDRESS, serial://PORT, tcp://HOST:PORT, replay://FILE or twin://SHAPE"
    if several:
        parser.add_argument("urls", metavar="URL", nargs="+", help=text)
    else:
        parser.add_argument("url", metavar="URL", help=text)
    add_layout(parser)
    parser.add_argument(
        "--timeout",
        type=positive_seconds,
        default=10.0,
        metavar="S",
        help="longest time to connect, in seconds (default: 10)",
    )
    parser.add_argument("--any-design", action="store_true", help="accept a device of any design")


def add_layout(parser: argparse.ArgumentParser) -> None:
    """Add `--layout`."""
    parser.add_argument(
        "--layout",
        type=Path,
        metavar="FILE",
        help=f"layout.json of the device's firmware (default: {BUILT_LAYOUT}, if it exists, or the "
        "one that was used with this design before)",
    )


def add_server(parser: argparse.ArgumentParser, port: int, clients: str) -> None:
    """Add the arguments of a server: `--host`, `--port` and `--token`."""
    parser.add_argument(
        "--host",
        default="127.0.0.1",
        metavar="ADDRESS",
        help="address to listen on (default: 127.0.0.1); other computers need the token",
    )
    parser.add_argument(
        "--port",
        type=int,
        default=port,
        metavar="N",
        help=f"port (default: {port}); 0 is any free one",
    )
    parser.add_argument(
        "--token",
        metavar="TEXT",
        help=f"secret that {clients} must send (default: random, if needed)",
    )


def layout_path(options: argparse.Namespace, url: str) -> Path | None:
    """The path of `--layout`, or of the layout built here; replays and servers have their own."""
    path: Path | None = options.layout
    own = url.lower().startswith(("replay:", "tcp:"))
    if path is None and BUILT_LAYOUT.is_file() and not own:
        return BUILT_LAYOUT
    return path


def open_fingertip(options: argparse.Namespace, *, calibrated: bool = True) -> "Fingertip":
    """Open the fingertip that the arguments name; errors as of `Fingertip.open`."""
    from lumitip.fingertip import Fingertip

    return Fingertip.open(
        options.url,
        layout_path(options, options.url),
        timeout=options.timeout,
        any_design=options.any_design,
        calibrated=calibrated,
    )
