"""Subcommands and their arguments from a table, for both commands."""

import argparse
import math
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any


def positive_seconds(text: str) -> float:
    """A time above 0 (s), for `type=` of an argument."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not value > 0.0:
        raise argparse.ArgumentTypeError(f"the value is {text}; a number above 0 (s) is needed")
    return value


def duration(text: str) -> float:
    """A finite time above 0 (s), for `type=` of an argument."""
    value = positive_seconds(text)
    if value == math.inf:
        raise argparse.ArgumentTypeError(f"the value is {text}; a finite time (s) is needed")
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


_TYPES: dict[str, Callable[[str], Any]] = {
    "count": positive_count,
    "duration": duration,
    "number": float,
    "path": Path,
    "seconds": positive_seconds,
    "whole": int,
}


def add_commands(parser: argparse.ArgumentParser, file: Path) -> None:
    """Add the subcommands that a table lists, such as `commands/commands.toml`.

    `options.command` has the name, and `options.run` the module and function where the table has
    them.
    """
    table = tomllib.loads(file.read_text(encoding="utf-8"))
    shared = table.pop("shared")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, entry in table.items():
        text = entry["text"]
        description = f"{text} {entry.get('more', '')}".strip()
        command = commands.add_parser(name, help=text, description=description)
        command.set_defaults(run=entry.get("run"))
        _add_arguments(command, entry["arguments"], shared)


def _add_arguments(parser: Any, arguments: list[Any], shared: dict[str, list[Any]]) -> None:
    """Add arguments of a table; `shared` has those of several commands."""
    for argument in arguments:
        if isinstance(argument, str):
            _add_arguments(parser, shared[argument], shared)
        elif isinstance(argument, list):
            _add_arguments(parser.add_mutually_exclusive_group(), argument, shared)
        else:
            values = dict(argument)
            if "type" in values:
                values["type"] = _TYPES[values["type"]]
            if isinstance(values.get("metavar"), list):
                values["metavar"] = tuple(values["metavar"])
            parser.add_argument(values.pop("name"), **values)
