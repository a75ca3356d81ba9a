"""TOML files that remember on which line of which file each value was written."""

import math
import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lumitip_fab.errors import InputError, Problem

Table = dict[str, Any]
_HEADER = re.compile(r"\s*\[{1,2}\s*([^\[\]]+?)\s*\]{1,2}\s*(#.*)?$")
_KEY = re.compile(r"\s*([A-Za-z0-9_\-.\"' ]+?)\s*=")
_SYNTAX = re.compile(r"(?P<what>.*) \(at (?:line (?P<line>\d+), column \d+|end of document)\)")
LARGEST_FILE_BYTES = 1_000_000


@dataclass(frozen=True)
class Source:
    """A parsed TOML file: its values, and the line of every dotted field."""

    path: Path
    table: Table
    lines: dict[str, int] = field(default_factory=dict)

    def line(self, dotted: str) -> int:
        """Line of a field, of the nearest table around it, or 1."""
        while dotted:
            if dotted in self.lines:
                return self.lines[dotted]
            dotted = dotted.rpartition(".")[0]
        return 1


def read_toml(path: Path, shown: str) -> Source:
    """Parse a TOML file.

    Args:
        path: the file.
        shown: its name in messages.

    Raises:
        InputError: if it cannot be read, is not TOML, or holds a value that is not finite.
    """
    try:
        if path.stat().st_size > LARGEST_FILE_BYTES:
            size = path.stat().st_size
            raise _refusal(shown, 0, f"{size} bytes given, at most {LARGEST_FILE_BYTES} are read")
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise _refusal(shown, 0, f"is not UTF-8 text ({error.reason})") from error
    except OSError as error:
        raise _refusal(shown, 0, f"cannot be read: {error.strerror}") from error
    try:
        table = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        told = _SYNTAX.match(str(error))
        line = int(told["line"]) if told and told["line"] else text.count("\n") + 1
        what = told["what"] if told else str(error)
        raise _refusal(shown, line, f"is not TOML: {what}") from error
    source = Source(path, table, _lines_of(text))
    faults = [
        Problem(shown, source.line(name), name, f"{value} given, a finite number is needed")
        for name, value in flat(table)
        if isinstance(value, float) and not math.isfinite(value)
    ]
    if faults:
        raise InputError(faults)
    return source


def flat(table: Table, prefix: str = "") -> list[tuple[str, Any]]:
    """Every leaf of a table as `(dotted name, value)`, arrays by their elements' index."""
    found: list[tuple[str, Any]] = []
    for key, value in table.items():
        found += _leaves(value, f"{prefix}{key}")
    return found


def _leaves(value: Any, name: str) -> list[tuple[str, Any]]:
    if isinstance(value, dict):
        return flat(value, f"{name}.")
    if isinstance(value, list):
        return [leaf for i, v in enumerate(value) for leaf in _leaves(v, f"{name}.{i}")]
    return [(name, value)]


def _refusal(shown: str, line: int, message: str) -> InputError:
    return InputError([Problem(shown, line, "", message)])


def _lines_of(text: str) -> dict[str, int]:
    """Line of every table header and key; statements over several lines count as one."""
    lines: dict[str, int] = {}
    section = ""
    statement, begun = "", 0
    for number, line in enumerate(text.splitlines(), start=1):
        if statement:
            statement += "\n" + line
        elif header := _HEADER.match(line):
            section = _bare(header[1]) + "."
            lines.setdefault(section[:-1], number)
            continue
        elif key := _KEY.match(line):
            statement, begun = line, number
            lines.setdefault(section + _bare(key[1]), number)
        if statement and (_whole(statement) or number - begun > 400):
            statement = ""
    return lines


def _bare(dotted: str) -> str:
    return ".".join(part.strip().strip("\"'") for part in dotted.split("."))


def _whole(statement: str) -> bool:
    try:
        tomllib.loads(statement)
    except tomllib.TOMLDecodeError:
        return False
    return True
