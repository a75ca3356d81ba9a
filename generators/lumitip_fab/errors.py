"""The exceptions of the maker's side, all under one root, and the record of one fault."""

import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass


class FabError(Exception):
    """Root of every error that `lumitip_fab` raises on purpose."""


@dataclass(frozen=True, order=True)
class Problem:
    """One fault of the input: its place, the value, and the limit.

    A message that begins with `is` or `has` continues the field's name.
    """

    file: str
    line: int
    field: str
    message: str

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}" if self.line else self.file
        return _printable(f"{place}: {self.text}")

    @property
    def text(self) -> str:
        """The field with the message, without the place."""
        if not self.field:
            return self.message
        joint = " " if self.message.startswith(("is ", "has ")) else ": "
        return f"{self.field}{joint}{self.message}"


def _printable(line: str) -> str:
    """One line that shows what a terminal would act on, like a newline in a name, as an escape."""
    return "".join(map(_shown, line))


def _shown(c: str) -> str:
    if c.isprintable() or unicodedata.category(c) == "Zs":  # a wide space is no control character
        return c
    return c.encode("unicode_escape").decode("ascii")


class InputError(FabError):
    """The parameter file or a catalogue file is refused; `problems` has every fault found."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems = tuple(sorted(set(problems)))
        super().__init__("\n".join(map(str, self.problems)))


class BuildError(FabError):
    """An artefact could not be made; the message names it and the reason."""


class OutputError(FabError):
    """A file in `outputs/` is missing or cannot be read; the message says what to do."""
