"""The command `lumitip`. Each subcommand is a module of `lumitip.commands`, which says with `add`
what it takes and does it with `run`; everything heavy is imported within `run`.
"""

import argparse
import logging
import os
import sys
from collections.abc import Sequence
from importlib import import_module

from lumitip.errors import LumitipError

COMMANDS = (
    "bench-tasks",
    "doctor",
    "export",
    "info",
    "record",
    "recover",
    "replay",
    "scan",
    "tare",
    "twin",
    "view",
)
REFUSED = 2


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; returns what it returns, 2 if what it was given cannot be used."""
    options = _parser().parse_args(arguments)
    level = logging.INFO if options.verbose else logging.WARNING
    logging.basicConfig(level=level, format="%(message)s")
    try:
        code: int = import_module(_module(options.command)).run(options)
        sys.stdout.flush()
    except LumitipError as error:
        print(f"lumitip: {error}", file=sys.stderr)
        return REFUSED
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        # Whoever read the output has enough of it; the interpreter must not flush it again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 141
    return code


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="lumitip", description="Read, record and look at optical fingertips."
    )
    parser.add_argument("-v", "--verbose", action="store_true", help="say what the links do")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name in COMMANDS:
        import_module(_module(name)).add(commands)
    return parser


def _module(command: str) -> str:
    return f"lumitip.commands.{command.replace('-', '_')}"


if __name__ == "__main__":
    sys.exit(main())
