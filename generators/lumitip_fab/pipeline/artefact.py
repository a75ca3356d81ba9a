"""`Artefact`: a file that a step made, before it is written. `Made`: files of earlier steps."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatch
from pathlib import Path

import numpy as np

from lumitip_fab.design.frames import Matrix


@dataclass(frozen=True, eq=False)
class Artefact:
    """A file's place below the output folder, its bytes, and its frame."""

    path: str
    """Relative to the output folder, with forward slashes."""
    data: bytes
    to_sensor: Matrix = field(default_factory=lambda: np.eye(4))
    """From the file's own frame to its finger's sensor frame, or to `frame` (4x4, mm)."""
    frame: str = "sensor"
    """Name of the frame that `to_sensor` leads to: `"sensor"`, `"gripper"`, `"carrier"`,
    `"flange"`, `"tool"` (the robot's tool flange) or `""` for none."""


@dataclass(frozen=True)
class Made:
    """Files below an output folder, with what they held when they were written."""

    out: Path
    sha256: Mapping[str, str]
    """Of each file that may be read, by its path below the folder."""

    def read(self, path: str) -> bytes:
        """The bytes of a file.

        Raises:
            LookupError: if it is none of those that the step said it reads.
        """
        if path not in self.sha256:
            raise LookupError(f"{path}: was not made, or the step does not say that it reads it")
        return (self.out / path).read_bytes()

    def text(self, path: str) -> str:
        """The text of a file."""
        return self.read(path).decode()

    def like(self, pattern: str) -> Iterator[str]:
        """Paths that match a pattern, in order."""
        return (path for path in sorted(self.sha256) if fnmatch(path, pattern))

    def only(self, patterns: tuple[str, ...]) -> "Made":
        """The files that match any of the patterns."""
        told = {
            path: digest
            for path, digest in self.sha256.items()
            if any(fnmatch(path, pattern) for pattern in patterns)
        }
        return Made(self.out, told)
