"""TOML files that remember on which line of which file each value was written."""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

from lumitip_fab.errors import InputError, Problem
from lumitip_fab.paths import read_input

Table = dict[str, Any]
_HEADER = re.compile(r"\s*\[{1,2}\s*([^\[\]]+?)\s*\]{1,2}\s*(#.*)?$")
_KEY = re.compile(r"\s*([A-Za-z0-9_\-.\"' ]+?)\s*=")
_SYNTAX = re.compile(r"(?P<what>.*) \(at (?:line (?P<line>\d+), column \d+|end of document)\)")
_HINTS = {
    "Invalid value": ". Put text in quotes, and write numbers with a decimal point.",
    "Expected newline": ". Write one value on each line, and numbers with a decimal point.",
    "Illegal character": ". End text with the same quotes as at its start.",
    "Unclosed": ". Close every bracket.",
}
DEEPEST = 12  # tables and lists within each other; a parameter file needs three
_LONGEST_NUMBER = re.compile(r"\d{4000}")  # beyond it Python itself refuses to read a number
_LONGEST_STATEMENT = 400  # lines


@dataclass(frozen=True)
class Source:
    """A parsed TOML file: its values, and the line of every dotted field."""

    path: Path
    table: Table
    lines: Mapping[str, int] = field(default_factory=dict)

    def line(self, dotted: str) -> int:
        """Line of a field, of the nearest table around it, or 1."""
        while dotted:
            if dotted in self.lines:
                return self.lines[dotted]
            dotted = dotted.rpartition(".")[0]
        return 1

    def sets(self, dotted: str) -> bool:
        """Whether the file itself gives a value to a field."""
        found: Any = self.table
        for key in dotted.split("."):
            if isinstance(found, list) and key.isdecimal() and int(key) < len(found):
                found = found[int(key)]
            elif isinstance(found, dict) and key in found:
                found = found[key]
            else:
                return False
        return True


def read_toml(path: Path, shown: str) -> Source:
    """Parse a TOML file.

    Args:
        path: the file.
        shown: its name in messages.

    Raises:
        InputError: if it cannot be read, is too large or too deep, or is not TOML.
    """
    try:
        data = read_input(path)
        # Some editors begin a file with a byte-order mark, or end lines with two characters.
        text = data.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        message = f"has the byte 0x{data[error.start]:02x}, which is not UTF-8. Save it as UTF-8."
        raise _refusal(shown, line, message) from error
    except OSError as error:
        raise _refusal(shown, 0, f"cannot be read: {error.strerror}") from error
    except ValueError as error:
        raise _refusal(shown, 0, f"is not a valid file name: {error}") from error
    try:
        table = tomllib.loads(text)
    except RecursionError as error:
        raise _refusal(shown, 0, _TOO_DEEP) from error
    except tomllib.TOMLDecodeError as error:
        raise _refusal(shown, *_syntax_fault(text, error)) from error
    except ValueError as error:
        digits = _LONGEST_NUMBER.search(text)
        line = text.count("\n", 0, digits.start()) + 1 if digits else 0
        message = "is not TOML: it has a number of more than 4300 digits"
        raise _refusal(shown, line, message) from error
    if _too_deep(table):
        raise _refusal(shown, 0, _TOO_DEEP)
    return Source(path, table, _lines_of(text))


def _syntax_fault(text: str, error: tomllib.TOMLDecodeError) -> tuple[int, str]:
    """Line and wording of what the TOML reader found wrong."""
    match = _SYNTAX.match(str(error))
    lines = text.rstrip().split("\n")
    line = int(match["line"]) if match and match["line"] else len(lines)
    what = match["what"] if match else str(error)
    if what.startswith(("Cannot overwrite", "Cannot declare")):
        return line, "is not TOML: this key or table appears twice. Keep one of them."
    written = lines[min(line, len(lines)) - 1].strip()
    hint = next((h for start, h in _HINTS.items() if what.startswith(start)), "")
    return line, f"is not TOML at {written!r:.80}: {what[:1].lower()}{what[1:]}{hint}"


_TOO_DEEP = f"has tables or lists nested deeper than {DEEPEST} levels; a parameter file needs three"


def _too_deep(table: Table) -> bool:
    level: list[Any] = [table]
    for _ in range(DEEPEST):
        level = [
            inner
            for outer in level
            for inner in (outer.values() if isinstance(outer, dict) else outer)
            if isinstance(inner, dict | list)
        ]
    return bool(level)


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


@lru_cache(maxsize=256)  # takes most time of a load; designs share a catalogue
def _lines_of(text: str) -> Mapping[str, int]:
    """Line of every table header and key; statements over several lines count as one."""
    lines: dict[str, int] = {}
    section = ""
    statement, begun = "", 0
    for number, line in enumerate(text.split("\n"), start=1):
        if statement:
            statement += "\n" + line
        elif header := _HEADER.match(line):
            section = _bare(header[1])
            _note(lines, section, number)
            continue
        elif key := _KEY.match(line):
            statement, begun = line, number
            _note(lines, f"{section}.{_bare(key[1])}" if section else _bare(key[1]), number)
        if statement and (_whole(statement) or number - begun > _LONGEST_STATEMENT):
            statement = ""
    return lines


def _note(lines: dict[str, int], dotted: str, number: int) -> None:
    """Note the line of a field, and of the tables around it where they are new."""
    while dotted:
        lines.setdefault(dotted, number)
        dotted = dotted.rpartition(".")[0]


def _bare(dotted: str) -> str:
    return ".".join(part.strip().strip("\"'") for part in dotted.split("."))


def _whole(statement: str) -> bool:
    try:
        tomllib.loads(statement)
    except (ValueError, RecursionError):
        return False
    return True
