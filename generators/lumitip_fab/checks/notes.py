"""Lines of the notes beside the parts that the manual has too, or the note of the other finger:
they stand there as often and in the same order."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path

from lumitip_fab.checks.readers.manual import Html, letters, read_note
from lumitip_fab.errors import OutputError

_FOLDERS = ("mask", "mould", "print", "wiring")
"""Of the notes that the manual includes."""
_ITEM = re.compile(r"^\d+\.(?!\d)")
_NUMBER = re.compile(r"\d+(\.\d+)?")
_FINGERS = re.compile("emitter|receiver")


def lines_misplaced(outputs: Path, page: Html) -> Iterator[str]:
    """Lines of a note that stand in it more often than elsewhere, or in another order there.

    What is said of one finger is compared with what is said of the other, without its figures. A
    line that stands in no other document is not judged.
    """
    shown = _forms(page.lines)
    for path in _paths(outputs):
        lines, beside = _note(path), path.with_name(_exchanged(path.name))
        twin = [_exchanged(line) for line in _note(beside)] if beside != path else []
        yield from (f"{path.name}: {line:.40} too often" for line in _doubled(lines, shown, twin))
        moved = {*_moved(lines, shown), *_moved(lines, twin)}
        yield from (f"{path.name}: {line:.40} out of order" for line in sorted(moved))


def labels_alone(outputs: Path, page: Html) -> Iterator[str]:
    """Headings and rows of tables, with their units, that stand in no other document.

    Only the note on printing has the masks that another design prints, which `printing.parts`
    reads.
    """
    for path in _paths(outputs):
        labels = _labels(path)
        beside = path.with_name(_exchanged(path.name))
        known = {*_forms(page.lines), *map(_exchanged, _labels(beside) if beside != path else ())}
        alone = (label for label in labels if label not in known and not label.startswith("mask/"))
        yield from (f"{path.name}: {label:.40}" for label in alone)


def _paths(outputs: Path) -> list[Path]:
    """The notes that the manual includes."""
    return sorted(path for name in _FOLDERS for path in (outputs / name).glob("*.md"))


def _labels(path: Path) -> list[str]:
    """Headings and rows of tables of a note; none if it cannot be read."""
    try:
        note = read_note(path)
    except OutputError:
        return []
    return _forms([*map(letters, (*note.chapters, *note.sections)), *note.rows])


def _exchanged(text: str) -> str:
    """A text with the name of the other finger."""
    other = {"emitter": "receiver", "receiver": "emitter"}
    return _FINGERS.sub(lambda found: other[found[0]], text)


def _note(path: Path) -> list[str]:
    """Lines of a note without its title; none if it cannot be read, which is reported elsewhere."""
    try:
        return _forms([line for line in read_note(path).lines if line][1:])
    except OutputError:
        return []


def _forms(lines: Sequence[str]) -> list[str]:
    """Lines without figures and number of the item."""
    plain = (_NUMBER.sub("0", _ITEM.sub("", line)) for line in lines)
    return [line for line in plain if line]


def _doubled(lines: list[str], shown: list[str], twin: list[str]) -> Iterator[str]:
    in_manual, in_twin = Counter(shown), Counter(twin)
    for line, number in Counter(lines).items():
        if number > max(in_manual[line], in_twin[line]) > 0:
            yield line


def _moved(lines: list[str], other: list[str]) -> Iterator[str]:
    """Lines before one that stands before them in another document; of lines that are there once in
    both."""
    once = {line for line, number in Counter(other).items() if number == 1}
    once &= {line for line, number in Counter(lines).items() if number == 1}
    place = {line: at for at, line in enumerate(other)}
    for before, after in pairwise(line for line in lines if line in once):
        if place[before] > place[after]:
            yield before
