"""The command `lumitip-fab`. Everything heavy is imported by the command that needs it."""

import argparse
import json
import sys
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lumitip_fab.system_libraries import libraries_message, missing_libraries

if TYPE_CHECKING:
    from lumitip_fab.errors import InputError

_REFUSED = 2
MODELLING = frozenset({"build", "watch"})
"""Commands that load the CAD kernel."""
FLAGS = {
    "quiet": "print failures only",
    "json": "print the result as JSON",
    "verbose": "print everything: all files, or all measurements with their margins",
}

COMMANDS = {
    "init": ("Copy the design folder (parameters, presets, parts) to DIR.", "quiet"),
    "build": (
        "Build FILE into DIR; only what changed is built again.",
        "quiet",
        "verbose",
        "json",
    ),
    "check": (
        "Re-read the files in DIR and prove that they fit. Builds nothing.",
        "quiet",
        "verbose",
        "json",
    ),
    "spec": ("Print the published Table I beside the figures of FILE.", "json"),
    "fix": (
        "Change FILE so that it is accepted: the smallest changes that work, each tried.",
        "quiet",
        "json",
    ),
    "channel-map": (
        "Print which detector each multiplexer input of a board reads, from its copper.",
        "json",
    ),
    "watch": ("Build FILE into DIR whenever it is saved, and print what changed.",),
    "explore": (
        "Compare designs before one is built: simulated accuracy, cells, cost, LED current.",
        "quiet",
        "json",
    ),
    "slice": (
        "Slice every printed part in DIR with PrusaSlicer: time, filament and overhangs.",
        "quiet",
        "json",
    ),
    "schema": ("Print the JSON Schema of parameter files, for editors.",),
}
"""Summary and flags of each command."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; returns 0, 1 if a check or a build failed, 2 if the input is rejected."""
    options = _parser().parse_args(arguments)
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

    command = import_module(f"lumitip_fab.cli.{options.command.replace('-', '_')}")
    try:
        return int(command.run(options))
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
    if plan.complete:
        print(f"lumitip-fab fix {options.file} writes them.", file=sys.stderr)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="lumitip-fab",
        description="From one parameter file to every part of an optical fingertip, and the "
        "proof that they fit.",
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version")
    group = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    commands = {
        name: _command(group.add_parser(name, help=summary, description=summary), flags)
        for name, (summary, *flags) in COMMANDS.items()
    }
    for name in ("build", "spec", "fix", "watch", "explore"):
        commands[name].add_argument("file", type=Path, metavar="FILE", help="the parameter file")
    for name in ("build", "check", "watch", "explore", "slice"):
        commands[name].add_argument(
            "--out", type=Path, required=True, metavar="DIR", help="output folder"
        )
    _add_options(commands)
    _add_study_options(commands["explore"])
    return parser


class _Version(argparse.Action):
    """Prints the version of the installed package."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        from lumitip.cli import installed_version

        print(installed_version())
        parser.exit()


def _command(parser: argparse.ArgumentParser, flags: list[str]) -> argparse.ArgumentParser:
    parser.set_defaults(quiet=False, json=False)
    exclusive = [flag for flag in flags if flag in {"quiet", "verbose"}]
    # argparse of Python 3.11 crashes on the usage line of an empty group.
    group = parser.add_mutually_exclusive_group() if exclusive else parser
    for flag in flags:
        where = group if flag in exclusive else parser
        where.add_argument(f"--{flag}", action="store_true", help=FLAGS[flag])
    return parser


def _add_options(commands: dict[str, argparse.ArgumentParser]) -> None:
    add = commands["init"].add_argument
    add("directory", type=Path, metavar="DIR", help="a new or empty folder")
    add = commands["build"].add_argument
    text = "build this step alone, such as backing; repeat the option for further steps"
    add("--only", action="append", default=[], metavar="STEP", help=text)
    add = commands["check"].add_argument
    add("--junit", type=Path, metavar="XML", help="also write a JUnit file")
    add("--report", type=Path, metavar="JSON", help="also write a JSON file")
    text = "reuse the results that this file holds for unchanged files, and keep new ones in it"
    add("--memory", type=Path, metavar="FILE", help=text)
    text = "the folder that FILE was built into: adds the masses of the printed parts"
    commands["spec"].add_argument("--out", type=Path, metavar="DIR", help=text)
    text = "a .kicad_pcb of KiCad 5 to 10"
    commands["channel-map"].add_argument("file", type=Path, metavar="FILE", help=text)
    text = "write the G-code there; without this option only the figures are printed"
    commands["slice"].add_argument("--gcode", type=Path, metavar="FOLDER", help=text)


def _add_study_options(sub: argparse.ArgumentParser) -> None:
    text = "A:B, A:B:STEP, A,B,C or a TOML list [A, B]; repeat the option for further fields"
    sub.add_argument("--vary", action="append", required=True, metavar="FIELD=SPEC", help=text)
    text = "number of values of a range A:B (default 6)"
    sub.add_argument("--points", type=int, default=6, metavar="N", help=text)
    text = "choose columns and rows for each pitch so that the grid keeps its size"
    sub.add_argument("--keep-size", action="store_true", help=text)
    text = "seed of the random poses and faults, the same for every design (default 0)"
    sub.add_argument("--seed", type=int, default=0, metavar="N", help=text)
    text = "run on this Dask cluster (tcp://…) instead of on the cores of this machine"
    sub.add_argument("--scheduler", metavar="ADDRESS", help=text)
