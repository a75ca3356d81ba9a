"""Mutants drawn so that every artefact has its share, whatever number of files it has."""

import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatch
from functools import cache
from pathlib import Path

import numpy as np
from numpy.random import Generator, default_rng

from mutations.damage import Mutant, NotApplicableError
from mutations.formats import BY_SUFFIX, WHOLE, artefact, of_whole_file, suffix

WHOLE_SHARE = 0.12
"""Of damages of whole files: swapped, not written, or a stray copy."""
MANIFEST = "manifest.json"
_TRIES = 60
_EQUIVALENT = Path(__file__).with_name("equivalent.toml")


@dataclass(frozen=True)
class Equivalent:
    """A damage that no user of the file can see."""

    path: str
    """Pattern of the file."""
    kind: str
    """Pattern of the mutator."""
    text: str
    """Pattern of the description."""
    reason: str

    def is_like(self, mutant: Mutant) -> bool:
        """Whether a mutant is one of these."""
        return (
            fnmatch(mutant.path, self.path)
            and fnmatch(mutant.kind, self.kind)
            and fnmatch(mutant.description, self.text)
        )


@cache
def equivalents() -> tuple[Equivalent, ...]:
    """The damages of `equivalent.toml`, each with its reason."""
    table = tomllib.loads(_EQUIVALENT.read_text(encoding="utf-8"))
    return tuple(Equivalent(**entry) for entry in table.get("equivalent", []))


def files_of(out: Path, only: str = "*") -> list[str]:
    """The files of an output folder that a mutator knows; hidden ones are the build's own."""
    paths = sorted(p.relative_to(out).as_posix() for p in out.rglob("*") if p.is_file())
    return [
        p for p in paths if fnmatch(p, only) and not p.startswith(".") and suffix(p) in BY_SUFFIX
    ]


def made(out: Path, path: str, kind: str, seed: int) -> Mutant:
    """The mutant of that file, kind and seed.

    Raises:
        NotApplicableError: if the place that the seed draws has nothing to damage.
    """
    rng = default_rng(seed)
    listed = path != MANIFEST
    if kind in WHOLE:
        files, done = of_whole_file(kind, out, path, files_of(out), rng)
        return Mutant(path, kind, seed, done, files, listed and kind != "stray")
    old = (out / path).read_bytes()
    new, done = BY_SUFFIX[suffix(path)][kind](old, rng)
    if new == old:
        raise NotApplicableError
    return Mutant(path, kind, seed, done, {path: new}, listed)


def drawn(out: Path, paths: Sequence[str], seed: int, number: int) -> Mutant:
    """The mutant of that number: its artefact's turn, and all else at random.

    Args:
        out: the output folder, not damaged.
        paths: the files to choose from, as `files_of` lists them.
        seed: of the whole sample.
        number: of the mutant in it.
    """
    names = sorted({artefact(p) for p in paths})
    turn, place = divmod(number, len(names))
    name = names[default_rng([seed, turn]).permutation(len(names))[place]]
    rng = default_rng([seed, number, 1])
    alike = [p for p in paths if artefact(p) == name]
    for _ in range(_TRIES):
        path = alike[int(rng.integers(len(alike)))]
        kind, own = _kind(path, rng), int(rng.integers(2**32))
        try:
            mutant = made(out, path, kind, own)
        except NotApplicableError:
            continue
        if not any(e.is_like(mutant) for e in equivalents()):
            return mutant
    raise NotApplicableError(name)


def _kind(path: str, rng: Generator) -> str:
    kinds = WHOLE if rng.random() < WHOLE_SHARE else tuple(sorted(BY_SUFFIX[suffix(path)]))
    weights = np.array([_WEIGHTS.get(kind, 1) for kind in kinds], dtype=np.float64)
    return str(rng.choice(kinds, p=weights / weights.sum()))


_WEIGHTS = {"truncate": 0.5, "file": 8}
"""How often a kind is drawn, by that of others: a file that ends early is the plainest damage, and
in an order's zip most of what can be wrong is in one of its files."""


def sample(out: Path, count: int, seed: int, only: str = "*") -> Iterator[Mutant]:
    """So many mutants of a folder."""
    paths = files_of(out, only)
    for number in range(count):
        yield drawn(out, paths, seed, number)
