"""`manifest.json`: the files with hashes, frames and facts, and what each task depends on."""

import hashlib
import json
import os
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, fields
from pathlib import Path, PurePath

import numpy as np

from lumitip_fab.design.encoding import canonical, encoded
from lumitip_fab.design.frames import Matrix
from lumitip_fab.errors import OutputError
from lumitip_fab.paths import read_plain
from lumitip_fab.pipeline.artefact import Artefact, Facts
from lumitip_fab.pipeline.dependencies import Dependencies

NAME = "manifest.json"
SCHEMA_VERSION = 3
PAGE, STAMP = "index.html", ".page.js"
"""The page, and what tells an open one of a watched folder that it was written anew."""
RESULTS = ("checks.json", "checks.xml")
"""Results of the checks."""
REPORTS = (*RESULTS, PAGE, STAMP)
"""Files that `make outputs` writes beside those of the build."""


@dataclass(frozen=True)
class Entry:
    """Record of one file."""

    sha256: str
    bytes: int
    task: str
    frame: str
    """Frame that `to_sensor` leads to; empty where the file has none."""
    to_sensor: list[list[float]]
    """4x4 matrix from the file's own frame, mm."""
    facts: Facts
    """Figures that other steps use."""

    @property
    def matrix(self) -> Matrix | None:
        """`to_sensor` as an array; none where it is not 4 x 4 finite numbers."""
        try:
            matrix = np.array(self.to_sensor)
        except (ValueError, TypeError):  # ragged
            return None
        plain = matrix.shape == (4, 4) and matrix.dtype.kind in "if"
        return matrix.astype(np.float64) if plain and np.isfinite(matrix).all() else None

    @property
    def version(self) -> str:
        """Changes when the file or its facts do."""
        return f"{self.sha256} {canonical(self.facts)}"


@dataclass(frozen=True)
class Ran:
    """A task that ran: what it depends on, and the key of that."""

    key: str
    fields: tuple[str, ...]
    """Fields of the design that it read."""
    reads: tuple[str, ...]
    """Files of other steps that it used, as paths and patterns."""

    @property
    def dependencies(self) -> Dependencies:
        """Its dependencies."""
        return Dependencies(self.fields, self.reads)


@dataclass(frozen=True)
class Origin:
    """Source of an output folder."""

    design_hash: str = ""
    parameters_hash: str = ""


@dataclass(frozen=True)
class Manifest:
    """All files of an output folder and the tasks that made them."""

    files: dict[str, Entry]
    tasks: dict[str, Ran]
    origin: Origin = Origin()

    def intact(self, out: Path) -> bool:
        """Whether every file is there and unedited."""
        return bool(self.files) and all(
            sha256_of(out / path) == entry.sha256 for path, entry in self.files.items()
        )

    def whole(self, out: Path, task: str) -> bool:
        """Whether a task's files are all there and unedited."""
        mine = [path for path, entry in self.files.items() if entry.task == task]
        return bool(mine) and all(sha256_of(out / path) == self.files[path].sha256 for path in mine)


def entry(artefact: Artefact, task: str) -> Entry:
    """The manifest's entry for a file just made."""
    digest = hashlib.sha256(artefact.data).hexdigest()
    matrix = encoded(artefact.to_sensor.tolist())
    facts = encoded(dict(artefact.facts))
    return Entry(digest, len(artefact.data), task, artefact.frame, matrix, facts)


def read(out: Path) -> Manifest:
    """The manifest of an output folder, without entries that no build writes; an empty one where
    there is none that can be used."""
    try:
        record = json.loads(read_plain(out / NAME).decode())
        if record["schema_version"] != SCHEMA_VERSION:
            return Manifest({}, {})
        entries = {path: Entry(**values) for path, values in record["files"].items()}
        files = {path: entry for path, entry in entries.items() if _usable(path, entry)}
        tasks = {
            name: Ran(str(task["key"]), tuple(task["fields"]), tuple(task["reads"]))
            for name, task in record["tasks"].items()
        }
        origin = Origin(**{f.name: str(record[f.name]) for f in fields(Origin)})
        return Manifest(files, tasks, origin)
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return Manifest({}, {})


def _usable(path: str, entry: Entry) -> bool:
    """Whether a file is named that can lie in an output folder."""
    inside = "\0" not in path and ".." not in PurePath(path).parts and path[:1] != "/"
    return inside and isinstance(entry.sha256, str) and isinstance(entry.frame, str)


def no_files(out: Path) -> list[str]:
    """Paths in an output folder that are no plain files: pipes, devices and links to them, and
    folders in the place of a file that the manifest lists. Hidden folders are not looked into."""
    listed = {NAME, *read(out).files}
    there = set()
    for top, folders, names in os.walk(out):
        folders[:] = [name for name in folders if not name.startswith(".")]
        there |= {(Path(top) / name).relative_to(out).as_posix() for name in names}
    return sorted(p for p in there | listed if _no_file(out / p, p in listed))


def _no_file(path: Path, listed: bool) -> bool:
    try:
        mode = path.stat().st_mode
    except OSError:  # missing
        return False
    return not stat.S_ISREG(mode) and (listed or not stat.S_ISDIR(mode))


def write(out: Path, manifest: Manifest) -> None:
    """Write the manifest."""
    record = {
        "schema_version": SCHEMA_VERSION,
        **asdict(manifest.origin),
        "files": {path: asdict(e) for path, e in sorted(manifest.files.items())},
        "tasks": {name: asdict(task) for name, task in manifest.tasks.items()},
    }
    write_file(out / NAME, (json.dumps(record, indent=1, sort_keys=True) + "\n").encode())


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


@contextmanager
def writing(folder: Path) -> Iterator[None]:
    """Raise an `OutputError` for a file of a folder that cannot be written or removed."""
    try:
        yield
    except OSError as error:
        # Of two names the second is the file's own; the first is what it was written under.
        at = error.filename2 or error.filename or folder
        raise OutputError(f"{at}: cannot be written: {error.strerror}") from error


def content_hash(out: Path) -> str:
    """SHA-256 (hex) of an output folder: of its manifest and of every file that this lists."""
    paths = (NAME, *sorted(read(out).files))
    lines = (f"{sha256_of(out / path)} {path}\n" for path in paths)
    return hashlib.sha256("".join(lines).encode()).hexdigest()


def sha256_of(path: Path) -> str | None:
    """SHA-256 (hex) of a file; none where it cannot be read."""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else None
    except OSError:
        return None
