"""The command `lumitip`. `commands/commands.toml` lists its subcommands; heavy imports are in
functions, so that Ctrl-C finds nothing half imported.
"""

import os
import sys
from collections.abc import Sequence

TYPE_CHECKING = False  # `typing` is slow to import

if TYPE_CHECKING:
    from argparse import ArgumentParser

REJECTED = 2


def run() -> None:
    """The whole process of a command."""
    import atexit

    from lumitip.interrupt import leave_by_signal, leave_on_interrupt, leave_with_daemons

    leave_on_interrupt()
    status = 1
    atexit.register(lambda: leave_with_daemons(status))  # the first one is called last
    status = main()
    leave_by_signal(status)
    sys.exit(status)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; returns its exit code: 2 for input that cannot be used, 130 after Ctrl-C, and
    128 more than the number of another signal."""
    from lumitip.interrupt import InterruptGuard

    with InterruptGuard() as guard:
        try:
            return _run_command(arguments)
        except BaseException:
            if guard.interrupted:
                return guard.status
            raise


def _run_command(arguments: Sequence[str] | None) -> int:
    import logging
    from importlib import import_module

    from lumitip.errors import LumitipError

    options = command_parser().parse_args(arguments)
    level = logging.INFO if options.verbose else logging.WARNING
    logging.basicConfig(level=level, format="%(message)s")
    try:
        module, _, function = options.run.partition(".")
        command = getattr(import_module(f"lumitip.commands.{module}"), function)
        code: int = command(options)
        sys.stdout.flush()
    except LumitipError as error:
        print(f"lumitip: {error}", file=sys.stderr)
        return REJECTED
    except BrokenPipeError:
        # The reader closed the pipe; the interpreter must not flush to it at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 141
    return code


def installed_version() -> str:
    """The version of the installed package, for both commands."""
    from importlib.metadata import PackageNotFoundError, version

    try:
        return f"lumitip {version('lumitip')}"
    except PackageNotFoundError:
        return "lumitip, not installed: run from its source folder"


def command_parser() -> "ArgumentParser":
    """The parser of the command, with all subcommands."""
    import argparse
    from pathlib import Path

    from lumitip.command_table import add_commands

    parser = argparse.ArgumentParser(
        prog="lumitip", description="Read, record and display optical fingertips."
    )
    parser.add_argument(
        "-v", "--verbose", action="store_true", help="print the events of the links"
    )
    parser.add_argument("--version", action="version", version=installed_version())
    add_commands(parser, Path(__file__).with_name("commands") / "commands.toml")
    return parser


if __name__ == "__main__":
    run()
