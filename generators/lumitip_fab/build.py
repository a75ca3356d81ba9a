"""Parameter file to output folder: only what changed is made again, on all cores."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

from lumitip_fab import manifest
from lumitip_fab.errors import OutputError
from lumitip_fab.fingerprint import input_hash, remember, unchanged
from lumitip_fab.lock import locked

if TYPE_CHECKING:
    from lumitip_fab.graph import Task
    from lumitip_fab.workers import Batch

Progress = Callable[[str, int, int], None]
"""Called with the name of what was just made, how many are done, and how many there are."""


@dataclass(frozen=True)
class Report:
    """What a build did."""

    origin: manifest.Origin
    """What was built."""
    written: tuple[str, ...]
    """Files whose bytes changed."""
    removed: tuple[str, ...]
    """Files of an earlier build that this design does not have."""
    made: tuple[str, ...]
    """Tasks that ran."""
    kept: tuple[str, ...]
    """Tasks whose files were up to date."""


def build(file: Path, out: Path, progress: Progress | None = None) -> Report:
    """Build a parameter file into an output folder.

    Args:
        file: the parameter file.
        out: the folder; made if missing.
        progress: told of each task that ends.

    Raises:
        InputError: if the input is refused; then nothing is written.
        BuildError: if an artefact could not be made.
        OutputError: if the folder cannot be written.
    """
    told = input_hash(file)
    before = unchanged(out, told)
    if before:
        return Report(before.origin, (), (), (), tuple(before.keys))
    return _build_anew(file, told, out, progress or _untold)


def _build_anew(file: Path, told: str, out: Path, progress: Progress) -> Report:
    # Imported here: to see that nothing changed, none of it is needed.
    from lumitip_fab.derive import derive
    from lumitip_fab.documents import documents
    from lumitip_fab.graph import tasks
    from lumitip_fab.load import load
    from lumitip_fab.workers import Batch

    given = load(file)
    design = derive(given)
    origin = manifest.Origin(design.layout.design_hash, design.parameters_hash)
    ready: list[Batch] = [("documents", documents(given, design))]
    try:
        with locked(out):
            report = _write(out, origin, ready, tuple(tasks(design)), progress)
            remember(out, told)
            return report
    except OSError as error:
        raise OutputError(
            f"{error.filename or out}: cannot be written: {error.strerror}"
        ) from error


def _write(
    out: Path,
    origin: manifest.Origin,
    ready: "list[Batch]",
    wanted: "tuple[Task, ...]",
    progress: Progress,
) -> Report:
    from lumitip_fab.workers import made

    before, keys = manifest.read(out), {task.name: task.key for task in wanted}
    kept = tuple(name for name, key in keys.items() if before.whole(out, name, key))
    stale = [task for task in wanted if task.name not in kept]
    files = {path: e for path, e in before.files.items() if e.task in kept}
    written: list[str] = []
    for done, (name, artefacts) in enumerate(chain(ready, made(stale)), start=1):
        for artefact in artefacts:
            files[artefact.path] = manifest.entry(artefact, name)
            if manifest.sha256_of(out / artefact.path) != files[artefact.path].sha256:
                written.append(artefact.path)
                manifest.write_file(out / artefact.path, artefact.data)
        progress(name, done, len(stale) + len(ready))
    removed = _remove(out, set(before.files) - set(files))
    manifest.write(out, manifest.Manifest(files, keys, origin))
    ran = tuple(task.name for task in stale)
    return Report(origin, tuple(sorted(written)), removed, ran, kept)


def _untold(_name: str, _done: int, _total: int) -> None:
    """Progress that nobody asked for."""


def _remove(out: Path, paths: set[str]) -> tuple[str, ...]:
    # The manifest may have been edited: never reach outside the folder.
    mine = sorted(p for p in paths if (out / p).resolve().is_relative_to(out.resolve()))
    for path in mine:
        (out / path).unlink(missing_ok=True)
    return tuple(mine)
