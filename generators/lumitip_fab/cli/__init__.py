"""The command `lumitip-fab`. Everything heavy is imported by the command that needs it."""

import argparse
import json
import sys
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

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
    from lumitip_fab.derive.auto.remedies import remedy_lines
    from lumitip_fab.derive.auto.resolve import RuleError

    remedies = remedy_lines(error.verdict) if isinstance(error, RuleError) else []
    if options.json:
        problems = [vars(p) for p in error.problems]
        print(json.dumps({"problems": problems, "remedies": remedies[1:]}, indent=1))
    print(error, *remedies, sep="\n", file=sys.stderr)
    if remedies:
        print(f"lumitip-fab fix {options.file} writes them.", file=sys.stderr)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="lumitip-fab",
        description="From one parameter file to every part of an optical fingertip, and the "
        "proof that they fit.",
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    def command(name: str, summary: str, *flags: str) -> argparse.ArgumentParser:
        sub = commands.add_parser(name, help=summary, description=summary)
        sub.set_defaults(quiet=False, json=False)
        exclusive = [flag for flag in flags if flag in {"quiet", "verbose"}]
        # argparse of Python 3.11 crashes on the usage line of an empty group.
        group = sub.add_mutually_exclusive_group() if exclusive else sub
        for flag in flags:
            where = group if flag in exclusive else sub
            where.add_argument(f"--{flag}", action="store_true", help=FLAGS[flag])
        return sub

    def add_file(sub: argparse.ArgumentParser) -> None:
        sub.add_argument("file", type=Path, metavar="FILE", help="the parameter file")

    def add_out(sub: argparse.ArgumentParser) -> None:
        sub.add_argument("--out", type=Path, required=True, metavar="DIR", help="output folder")

    sub = command("init", "Copy the design folder (parameters, presets, parts) to DIR.", "quiet")
    sub.add_argument("directory", type=Path, metavar="DIR", help="a new or empty folder")
    summary = "Build FILE into DIR; only what changed is built again."
    sub = command("build", summary, "quiet", "verbose", "json")
    add_file(sub)
    add_out(sub)
    summary = "Re-read the files in DIR and prove that they fit. Builds nothing."
    sub = command("check", summary, "quiet", "verbose", "json")
    add_out(sub)
    sub.add_argument("--junit", type=Path, metavar="XML", help="also write a JUnit file")
    sub.add_argument("--report", type=Path, metavar="JSON", help="also write a JSON file")
    text = "reuse the results that this file holds for unchanged files, and keep new ones in it"
    sub.add_argument("--memory", type=Path, metavar="FILE", help=text)
    sub = command("spec", "Print the published Table I beside the figures of FILE.", "json")
    add_file(sub)
    text = "the folder that FILE was built into: adds the masses of the printed parts"
    sub.add_argument("--out", type=Path, metavar="DIR", help=text)
    summary = "Change FILE so that it is accepted: the smallest changes that work, each tried."
    sub = command("fix", summary, "quiet", "json")
    add_file(sub)
    summary = "Print which detector each multiplexer input of a board reads, from its copper."
    sub = command("channel-map", summary, "json")
    sub.add_argument("file", type=Path, metavar="FILE", help="a .kicad_pcb of KiCad 5 to 10")
    sub = command("watch", "Build FILE into DIR whenever it is saved, and print what changed.")
    add_file(sub)
    add_out(sub)
    summary = "Compare designs before one is built: simulated accuracy, cells, cost, LED current."
    sub = command("explore", summary, "quiet", "json")
    add_file(sub)
    add_out(sub)
    _add_study_options(sub)
    summary = "Slice every printed part in DIR with PrusaSlicer: time, filament and overhangs."
    sub = command("slice", summary, "quiet", "json")
    add_out(sub)
    text = "write the G-code there; without this option only the figures are printed"
    sub.add_argument("--gcode", type=Path, metavar="FOLDER", help=text)
    command("schema", "Print the JSON Schema of parameter files, for editors.")
    return parser


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
