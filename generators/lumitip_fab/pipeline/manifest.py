"""`manifest.json`: which files there are, their hashes, frames, and the keys they were made by."""

import hashlib
import json
import os
import tempfile
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from lumitip_fab.design.encoding import encoded
from lumitip_fab.pipeline.artefact import Artefact

NAME = "manifest.json"
SCHEMA_VERSION = 2


@dataclass(frozen=True)
class Entry:
    """What the manifest says of one file."""

    sha256: str
    bytes: int
    task: str
    frame: str
    """Frame that `to_sensor` leads to; empty where the file has none."""
    to_sensor: list[list[float]]
    """4x4 matrix from the file's own frame, mm."""


@dataclass(frozen=True)
class Origin:
    """What an output folder was built from."""

    design_hash: str = ""
    parameters_hash: str = ""


@dataclass(frozen=True)
class Manifest:
    """All files of an output folder and the key of each task that made them."""

    files: dict[str, Entry]
    keys: dict[str, str]
    origin: Origin = Origin()

    def intact(self, out: Path) -> bool:
        """Whether every file is there and unedited."""
        return bool(self.files) and all(
            sha256_of(out / path) == entry.sha256 for path, entry in self.files.items()
        )

    def whole(self, out: Path, task: str, key: str) -> bool:
        """Whether a task's files are all there, unedited, and made by this key."""
        mine = [path for path, entry in self.files.items() if entry.task == task]
        return (
            self.keys.get(task) == key
            and bool(mine)
            and all(sha256_of(out / path) == self.files[path].sha256 for path in mine)
        )


def entry(artefact: Artefact, task: str) -> Entry:
    """The manifest's entry for a file just made."""
    digest = hashlib.sha256(artefact.data).hexdigest()
    matrix = encoded(artefact.to_sensor.tolist())
    return Entry(digest, len(artefact.data), task, artefact.frame, matrix)


def read(out: Path) -> Manifest:
    """The manifest of an output folder; an empty one where there is none that can be used."""
    try:
        told = json.loads((out / NAME).read_text(encoding="utf-8"))
        if told["schema_version"] != SCHEMA_VERSION:
            return Manifest({}, {})
        files = {path: Entry(**values) for path, values in told["files"].items()}
        origin = Origin(**{f.name: str(told[f.name]) for f in fields(Origin)})
        return Manifest(files, dict(told["keys"]), origin)
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return Manifest({}, {})


def write(out: Path, manifest: Manifest) -> None:
    """Write the manifest."""
    told = {
        "schema_version": SCHEMA_VERSION,
        **asdict(manifest.origin),
        "files": {path: asdict(e) for path, e in sorted(manifest.files.items())},
        "keys": manifest.keys,
    }
    write_file(out / NAME, (json.dumps(told, indent=1, sort_keys=True) + "\n").encode())


def write_file(path: Path, data: bytes, mode: int = 0o644) -> None:
    """Write a file whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        temporary.chmod(mode)
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def sha256_of(path: Path) -> str | None:
    """SHA-256 (hex) of a file; none where it cannot be read."""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return None
