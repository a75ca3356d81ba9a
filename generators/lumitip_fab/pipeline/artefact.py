"""`Artefact`: a file that a step made, before it is written. `Files`: files of earlier steps."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import numpy as np

from lumitip_fab.design.frames import Matrix

Facts = Mapping[str, Any]
"""Figures of a file by name, as JSON has them: volumes, masses, counts, lines of a list."""


@dataclass(frozen=True, eq=False)
class Artefact:
    """A file's place below the output folder, its bytes, its frame, and its facts."""

    path: str
    """Relative to the output folder, with forward slashes."""
    data: bytes
    to_sensor: Matrix = field(default_factory=lambda: np.eye(4))
    """From the file's own frame to its finger's sensor frame, or to `frame` (4x4, mm)."""
    frame: str = "sensor"
    """Name of the frame that `to_sensor` leads to: `"sensor"`, `"gripper"`, `"auxiliary"`,
    `"flange"`, `"tool"` (the robot's tool flange) or `""` for none."""
    facts: Facts = field(default_factory=dict)
    """Figures that other steps need, so that none of them parses the file."""


@dataclass(frozen=True)
class Made:
    """A file as the manifest has it: its hash and its facts."""

    sha256: str
    facts: Facts


class Files:
    """Files of earlier steps; records which of them a step uses.

    Args:
        out: the output folder.
        made: every file that is there, by its path below the folder.
    """

    def __init__(self, out: Path, made: Mapping[str, Made]) -> None:
        self._out, self._made = out, made
        self.used: set[str] = set()
        """Paths and patterns that were asked for."""

    @classmethod
    def of(cls, files: "Files") -> "Files":
        """The same files with a record of their own."""
        return cls(files._out, files._made)

    def like(self, pattern: str) -> tuple[str, ...]:
        """Paths that match a pattern, sorted."""
        self.used.add(pattern)
        return tuple(path for path in sorted(self._made) if fnmatch(path, pattern))

    def read(self, path: str) -> bytes:
        """The bytes of a file.

        Raises:
            LookupError: if no earlier step made it.
        """
        self._file(path)
        return (self._out / path).read_bytes()

    def text(self, path: str) -> str:
        """The text of a file."""
        return self.read(path).decode()

    def facts(self, path: str) -> Facts:
        """The facts of a file.

        Raises:
            LookupError: if no earlier step made it.
        """
        return self._file(path).facts

    def _file(self, path: str) -> Made:
        self.used.add(path)
        if path not in self._made:
            raise LookupError(f"{path}: no earlier step made it")
        return self._made[path]
