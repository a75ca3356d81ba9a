"""`by_name`: the fingertips of some files, each with a name that topics can have."""

import re
from collections.abc import Iterator, Sequence
from itertools import count
from pathlib import Path

from lumitip.foxglove.panels import ROOT
from lumitip.foxglove.scene import NAME, FoxgloveError
from lumitip.recording import Reader, fingers

_OTHER = re.compile(r"[^A-Za-z0-9_]")
_PREFIX = "finger_"


def by_name(files: Sequence[str]) -> dict[str, Reader]:
    """The recording of each fingertip, in order, by its name.

    Args:
        files: each a path, or NAME=PATH. A file with one fingertip is called NAME, or after the
            file, with `_` for characters that a name cannot have, and a number if another has that
            name. Those of a file with several keep their names, after NAME and `_` if it is there.

    Raises:
        FoxgloveError: if two have the same name.
        RecordingError: if a file is not a recording.
    """
    found = [each for text in files for each in _of_file(text)]
    taken = set[str]()
    for name, _, derived in found:
        if name in taken and not derived:
            raise FoxgloveError(
                f"two recordings are called {name!r}. Give one another name: NAME=FILE"
            )
        if not derived:
            taken.add(name)
    named: dict[str, Reader] = {}
    for name, reader, derived in found:
        free = _free(name, taken) if derived else name
        taken.add(free)
        named[free] = reader
    return named


def _of_file(text: str) -> Iterator[tuple[str, Reader, bool]]:
    """Name and recording of each fingertip of a file, and whether the name is derived."""
    name, equals, path = text.partition("=")
    path = path if equals else text
    inside = fingers(path)
    if len(inside) > 1:
        before = f"{name}_" if equals else ""
        for finger in inside:
            yield before + finger, Reader(path, tolerant=True, finger=finger), False
        return
    reader = Reader(path, tolerant=True)
    if equals:
        yield name, reader, False
        return
    stem = Path(path).stem
    legal = _legal(stem)
    yield legal, reader, legal != stem


def _legal(stem: str) -> str:
    name = _OTHER.sub("_", stem)
    return name if NAME.fullmatch(name) and name != ROOT else _PREFIX + name


def _free(name: str, taken: set[str]) -> str:
    if name not in taken:
        return name
    return next(free for n in count(2) if (free := f"{name}_{n}") not in taken)
