"""`Made`: files that other steps wrote, for the steps that come after them."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path


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
