"""Design to output folder: only what changed is made again, on all cores."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline import manifest
from lumitip_fab.pipeline.fingerprint import remember, unchanged

if TYPE_CHECKING:
    from lumitip_fab.design import Design
    from lumitip_fab.pipeline.artefact import Artefact
    from lumitip_fab.pipeline.graph import Step, Task
    from lumitip_fab.pipeline.workers import Batch


try:
    import fcntl
except ImportError:  # Windows has no advisory locks on folders; there nothing is locked
    fcntl = None  # type: ignore[assignment]


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold a folder, which is made if missing; leaves no file behind, even when killed.

    Raises:
        OutputError: if another build holds it.
    """
    folder.mkdir(parents=True, exist_ok=True)
    if fcntl is None:
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield
    except BlockingIOError as error:
        raise OutputError(
            f"{folder}: another build is writing there: wait for it, or stop it (is `make watch` "
            "running?)"
        ) from error
    finally:
        os.close(handle)


Progress = Callable[[str, int, int], None]
"""Called with the name of what was just made, how many are done, and how many there are."""
Resolve = Callable[[], "tuple[Design, tuple[Artefact, ...]]"]
"""Gives a design and its documents."""


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


def build(
    origin_hash: str,
    resolved: Resolve,
    out: Path,
    steps: "tuple[Step, ...]",
    progress: Progress | None = None,
) -> Report:
    """Build a design into an output folder.

    Args:
        origin_hash: of everything that the design follows from; empty if it is not known.
        resolved: gives the design and its documents; not called if the folder is up to date.
        out: the folder; made if missing.
        steps: all steps, in their order.
        progress: told of each task that ends.

    Raises:
        InputError: if the input is refused; then nothing is written.
        BuildError: if an artefact could not be made.
        OutputError: if the folder cannot be written.
    """
    before = unchanged(out, origin_hash)
    if before:
        return Report(before.origin, (), (), (), tuple(before.keys))
    design, documents = resolved()
    origin = manifest.Origin(design.layout.design_hash, design.parameters_hash)
    try:
        with locked(out):
            report = _write(
                out, origin, [("documents", documents)], design, steps, progress or _untold
            )
            remember(out, origin_hash)
            return report
    except OSError as error:
        # Of two names the second is the file's own; the first is what it was written under.
        at = error.filename2 or error.filename or out
        raise OutputError(f"{at}: cannot be written: {error.strerror}") from error


def _write(
    out: Path,
    origin: manifest.Origin,
    ready: "list[Batch]",
    design: "Design",
    steps: "tuple[Step, ...]",
    progress: Progress,
) -> Report:
    # Imported here: to see that nothing changed, none of it is needed.
    from lumitip_fab.pipeline.artefact import Made
    from lumitip_fab.pipeline.graph import late_steps, late_task, tasks

    run = _Run(out, manifest.read(out), progress)
    run.make(ready, tuple(tasks(steps, design)))
    for step in late_steps(steps):
        made = Made(out, {path: entry.sha256 for path, entry in run.files.items()})
        run.make([], (late_task(step, design, made),))
    removed = _remove(out, set(run.before.files) - set(run.files))
    manifest.write(out, manifest.Manifest(run.files, run.keys, origin))
    return Report(origin, tuple(sorted(run.written)), removed, tuple(run.ran), tuple(run.kept))


@dataclass
class _Run:
    """One build: what it has made so far."""

    out: Path
    before: manifest.Manifest
    progress: Progress
    files: dict[str, manifest.Entry] = field(default_factory=dict)
    keys: dict[str, str] = field(default_factory=dict)
    written: list[str] = field(default_factory=list)
    ran: list[str] = field(default_factory=list)
    kept: list[str] = field(default_factory=list)
    done: int = 0

    def make(self, ready: "list[Batch]", wanted: "tuple[Task, ...]") -> None:
        """Run those tasks whose files are not there already, and write what is ready."""
        from lumitip_fab.pipeline.workers import made

        keys = {task.name: task.key for task in wanted}
        kept = [name for name, key in keys.items() if self.before.whole(self.out, name, key)]
        stale = [task for task in wanted if task.name not in kept]
        self.files |= {path: e for path, e in self.before.files.items() if e.task in kept}
        total = self.done + len(stale) + len(ready)
        for name, artefacts in chain(ready, made(stale)):
            for artefact in artefacts:
                self._write(name, artefact)
            self.done += 1
            self.progress(name, self.done, total)
        self.keys |= keys
        self.kept += kept
        self.ran += [task.name for task in stale]

    def _write(self, task: str, artefact: "Artefact") -> None:
        entry = self.files[artefact.path] = manifest.entry(artefact, task)
        if manifest.sha256_of(self.out / artefact.path) != entry.sha256:
            self.written.append(artefact.path)
            manifest.write_file(self.out / artefact.path, artefact.data)


def _untold(_name: str, _done: int, _total: int) -> None:
    """Progress that nobody asked for."""


def _remove(out: Path, paths: set[str]) -> tuple[str, ...]:
    # The manifest may have been edited: never reach outside the folder.
    mine = sorted(p for p in paths if (out / p).resolve().is_relative_to(out.resolve()))
    for path in mine:
        (out / path).unlink(missing_ok=True)
    return tuple(mine)
