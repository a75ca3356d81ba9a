"""`evaluated.jsonl`: what a study has found out so far, one line each, in the order of finding.

A study that is stopped, or whose computer fails, loses what was under way: a line that was written
by half is cut off. Lines of other studies, prices or versions do no harm: nobody asks for them.
"""

import json
import os
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType

from lumitip_fab.errors import OutputError
from lumitip_fab.explore.evaluate import Record

NAME = "evaluated.jsonl"


class Journal:
    """The journal of a folder, a context manager; `known` is what is in it, by key."""

    def __init__(self, folder: Path) -> None:
        """Read what there is, and be ready to add to it.

        Raises:
            OutputError: if it cannot be read or written.
        """
        self._path = folder / NAME
        try:
            self._file = self._path.open("a+b")
            self._file.seek(0)
            whole = self._file.read()
            self._file.truncate(whole.rfind(b"\n") + 1)
        except OSError as error:
            raise OutputError(f"{self._path}: cannot be used: {error.strerror}") from error
        self.known: Mapping[str, Record] = {
            record["key"]: record for record in map(_record, whole.split(b"\n")[:-1]) if record
        }

    def add(self, record: Record) -> None:
        """Keep a record, on the disk before this returns."""
        line = json.dumps(record, sort_keys=True, ensure_ascii=False) + "\n"
        self._file.write(line.encode())
        self._file.flush()
        os.fsync(self._file.fileno())

    def __enter__(self) -> "Journal":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._file.close()


def _record(line: bytes) -> Record | None:
    """A record, `None` of a line that is none: then its design is evaluated again."""
    try:
        told = json.loads(line)
    except ValueError:
        return None
    usable = isinstance(told, dict) and isinstance(told.get("key"), str)
    return told if usable and ("figures" in told or "refused" in told) else None
