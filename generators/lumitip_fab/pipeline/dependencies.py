"""Dependencies of a result: the fields of the design and the files that were read for it.

Steps of a build and modules of checks read a `RecordedDesign`. What they read is kept beside the
result, and a result is used again while all of it is as it was.
"""

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fnmatch import fnmatch
from typing import Any

from lumitip_fab.design import Design
from lumitip_fab.design.encoding import canonical


class RecordedDesign:
    """A design that records which of its fields are read."""

    def __init__(self, design: Design) -> None:
        self._design = design
        self.fields: set[str] = set()

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._design, name)
        if callable(value):
            raise TypeError(f"Design.{name} is a method: what it reads would not be recorded")
        self.fields.add(name)
        return value


@dataclass(frozen=True)
class Dependencies:
    """Names of the fields, and paths or patterns of the files, that a result depends on."""

    fields: tuple[str, ...]
    files: tuple[str, ...] = ()

    def key(self, values: "FieldHashes", versions: Mapping[str, str], *others: str) -> str:
        """Hash that changes when the result may.

        Args:
            values: of the design.
            versions: of every file that is there, by its path; a hash, for instance.
            others: whatever else the result depends on, such as code and tools.
        """
        lines = [f"{name}\0{values[name]}" for name in sorted(self.fields)]
        lines += [
            f"{path}\0{version}"
            for path, version in sorted(versions.items())
            if any(fnmatch(path, pattern) for pattern in self.files)
        ]
        return hashlib.sha256("\n".join([*lines, *others]).encode()).hexdigest()


class FieldHashes:
    """Hash of each field of a design, computed when it is first asked for."""

    def __init__(self, design: Design) -> None:
        self._design = design
        self._known: dict[str, str] = {}

    def __getitem__(self, field: str) -> str:
        """The hash of a field; of one that this version of `Design` lacks, of nothing."""
        if field not in self._known:
            text = canonical(getattr(self._design, field, None))
            self._known[field] = hashlib.sha256(text.encode()).hexdigest()
        return self._known[field]


def recorded(design: RecordedDesign, files: Iterable[str] = ()) -> Dependencies:
    """Everything read so far."""
    return Dependencies(tuple(sorted(design.fields)), tuple(sorted(files)))
