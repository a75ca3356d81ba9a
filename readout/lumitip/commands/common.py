"""What several subcommands share: the arguments that name a fingertip, and opening it."""

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lumitip.fingertip import Fingertip

Subparsers = Any  # argparse keeps the type of its subparsers to itself
BUILT_LAYOUT = Path("outputs/layout.json")


def some_seconds(text: str) -> float:
    """A time above 0 (s), for `type=` of an argument."""
    try:
        given = float(text)
    except ValueError:
        given = math.nan
    if not given > 0.0:
        raise argparse.ArgumentTypeError(f"{text} given, seconds above 0 are needed")
    return given


def some(text: str) -> int:
    """A number from 1 on, for `type=` of an argument."""
    try:
        given = int(text)
    except ValueError:
        given = 0
    if given < 1:
        raise argparse.ArgumentTypeError(f"{text} given, a whole number from 1 on is needed")
    return given


def add_fingertip(parser: argparse.ArgumentParser, several: bool = False) -> None:
    """Add the arguments that name a fingertip, or one or more of them.

    They become `options.url` (`options.urls`, a list), `layout`, `timeout` and `any_design`.
    """
    told = "ble://NAME-OR-ADDRESS, serial://PORT, replay://FILE or twin://SHAPE"
    if several:
        parser.add_argument("urls", metavar="URL", nargs="+", help=told)
    else:
        parser.add_argument("url", metavar="URL", help=told)
    parser.add_argument(
        "--layout",
        type=Path,
        metavar="FILE",
        help=f"layout.json that the firmware was built from ({BUILT_LAYOUT} if it is there)",
    )
    parser.add_argument(
        "--timeout",
        type=some_seconds,
        default=10.0,
        metavar="S",
        help="seconds that connecting may take (10)",
    )
    parser.add_argument(
        "--any-design", action="store_true", help="read a device of another design all the same"
    )


def layout_path(options: argparse.Namespace, url: str) -> Path | None:
    """The layout that was given, or the one that was built here; a replay brings its own."""
    given: Path | None = options.layout
    if given is None and BUILT_LAYOUT.is_file() and not url.lower().startswith("replay:"):
        return BUILT_LAYOUT
    return given


def open_fingertip(
    options: argparse.Namespace, url: str | None = None, **others: Any
) -> "Fingertip":
    """Open the fingertip that the arguments name; errors as of `Fingertip.open`."""
    from lumitip.fingertip import Fingertip

    named: str = url or options.url
    return Fingertip.open(
        named,
        layout_path(options, named),
        timeout=options.timeout,
        any_design=options.any_design,
        **others,
    )
