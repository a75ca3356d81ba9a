"""Kind of a mutator, and of its result."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from numpy.random import Generator

Mutator = Callable[[bytes, Generator], tuple[bytes, str]]
"""Takes the bytes of a file; returns other bytes, and what was done in plain words."""
Mutators = Mapping[str, Mutator]
"""Mutators of a format, by kind."""


class NotApplicableError(Exception):
    """This file, or the place that was drawn in it, has nothing that the mutator could change."""


@dataclass(frozen=True)
class Mutant:
    """A damaged folder: the files that differ, and what was done to them."""

    path: str
    """The file, relative to the output folder."""
    kind: str
    """The mutator, like `"mirror"`."""
    seed: int
    """Path, kind and seed name a mutant of a folder: it is made again from them."""
    description: str
    files: Mapping[str, bytes | None]
    """New bytes of each changed file; None for one that is removed."""
    listed: bool = True
    """Whether the manifest is made right, as a faulty generator would write it."""
