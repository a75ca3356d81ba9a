"""The command `lumitip-fab`. Everything heavy is imported by the command that needs it."""

import argparse
import json
import sys
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Any

from lumitip.command_table import add_commands
from lumitip_fab.system_libraries import libraries_message, missing_libraries

if TYPE_CHECKING:
    from lumitip_fab.errors import InputError

_REFUSED = 2
MODELLING = frozenset({"build", "gripper", "watch"})
"""Commands that load the CAD kernel."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; returns 0, 1 if a check or a build failed, 2 if the input is rejected."""
    options = command_parser().parse_args(arguments)
    missing = missing_libraries() if options.command in MODELLING else ()
    if missing:
        print(libraries_message(missing), file=sys.stderr)
        return _REFUSED
    try:
        return _run(options)
    except ModuleNotFoundError as error:
        if (error.name or "lumitip").startswith("lumitip"):
            raise
        from lumitip.errors import how_to_install

        print(f"lumitip-fab needs {error.name}: {how_to_install('fab')}", file=sys.stderr)
        return _REFUSED
    except KeyboardInterrupt:
        return 130


def _run(options: argparse.Namespace) -> int:
    from lumitip_fab.cli.screen import FAILED, REFUSED
    from lumitip_fab.errors import BuildError, InputError, OutputError

    module, _, function = options.run.partition(".")
    command = getattr(import_module(f"lumitip_fab.cli.{module}"), function)
    try:
        return int(command(options))
    except InputError as error:
        _print_rejection(options, error)
        return REFUSED
    except (OutputError, BuildError) as error:
        if options.json:
            print(json.dumps({"error": str(error)}, indent=1))
        print(error, file=sys.stderr)
        return FAILED if isinstance(error, BuildError) else REFUSED


def _print_rejection(options: argparse.Namespace, error: "InputError") -> None:
    """Print every problem, and the changes that solve those which the rules found."""
    from lumitip_fab.derive.auto.remedies import Plan, plan_of, remedy_lines
    from lumitip_fab.derive.auto.resolve import RuleError

    plan = plan_of(error.verdict) if isinstance(error, RuleError) else Plan((), False)
    remedies = remedy_lines(plan)
    if options.json:
        problems = [vars(p) for p in error.problems]
        print(json.dumps({"problems": problems, "remedies": remedies[1:]}, indent=1))
    print(error, *remedies, sep="\n", file=sys.stderr)
    if plan.complete and hasattr(options, "file"):
        print(f"lumitip-fab fix {quote(str(options.file))} writes them.", file=sys.stderr)


def command_parser() -> argparse.ArgumentParser:
    """The parser of the command, with all subcommands."""
    parser = argparse.ArgumentParser(
        prog="lumitip-fab",
        description="From one parameter file to every part of an optical fingertip, and the "
        "proof that they fit.",
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version")
    add_commands(parser, Path(__file__).with_name("commands.toml"))
    parser.set_defaults(quiet=False, json=False)
    return parser


class _Version(argparse.Action):
    """Prints the version of the installed package."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        from lumitip.cli import installed_version

        print(installed_version())
        parser.exit()
