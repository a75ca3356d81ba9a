"""The command `lumitip`. `add` of each module in `lumitip.commands` adds its subcommands; heavy
imports are in their functions.
"""

import argparse
import logging
import os
import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version

from lumitip.errors import LumitipError

MODULES = ("devices", "record", "recordings", "simulation", "view")
REJECTED = 2


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; returns its exit code, 2 for input that cannot be used."""
    options = _parser().parse_args(arguments)
    level = logging.INFO if options.verbose else logging.WARNING
    logging.basicConfig(level=level, format="%(message)s")
    try:
        code: int = options.run(options)
        sys.stdout.flush()
    except LumitipError as error:
        print(f"lumitip: {error}", file=sys.stderr)
        return REJECTED
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        # The reader closed the pipe; the interpreter must not flush to it at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 141
    return code


def installed_version() -> str:
    """The version of the installed package, for both commands."""
    try:
        return f"lumitip {version('lumitip')}"
    except PackageNotFoundError:
        return "lumitip, not installed: run from its source folder"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="lumitip", description="Read, record and display optical fingertips."
    )
    parser.add_argument(
        "-v", "--verbose", action="store_true", help="print the events of the links"
    )
    parser.add_argument("--version", action="version", version=installed_version())
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name in MODULES:
        import_module(f"lumitip.commands.{name}").add(commands)
    return parser


if __name__ == "__main__":
    sys.exit(main())
