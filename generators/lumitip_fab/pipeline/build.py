"""Design to output folder: only what changed is built again, on all cores."""

import os
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline import manifest
from lumitip_fab.pipeline.fingerprint import remember, unchanged

if TYPE_CHECKING:
    from lumitip_fab.design import Design
    from lumitip_fab.pipeline.artefact import Artefact, Files
    from lumitip_fab.pipeline.workers import Step, Task


try:
    import fcntl
except ImportError:  # Windows has no advisory locks on folders; there nothing is locked
    fcntl = None  # type: ignore[assignment]


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold a folder, which is made if missing; leaves no file behind, even when killed.

    Raises:
        OutputError: if another build holds it, or it cannot be a folder.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        handle = os.open(folder, os.O_RDONLY) if fcntl else None
    except OSError as error:
        raise OutputError(
            f"{folder}: cannot be written: {error.strerror}; a folder is needed, and is made if "
            "missing. Choose another with --out."
        ) from error
    if fcntl is None or handle is None:
        yield
        return
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
"""Called at the end of a task with its name, how much is done, and how much there is: seconds that
tasks take one core, about."""
Resolve = Callable[[], "tuple[Design, tuple[Artefact, ...]]"]
"""Gives a design and its documents."""


@dataclass(frozen=True)
class Report:
    """Result of a build."""

    origin: manifest.Origin
    """The artefacts that were built."""
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
    only: Collection[str] = (),
) -> Report:
    """Build a design into an output folder.

    Args:
        origin_hash: of everything that the design follows from; empty if it is not known.
        resolved: gives the design and its documents; not called if the folder is up to date.
        out: the folder; made if missing.
        steps: all steps, in their order.
        progress: called at the end of each task.
        only: names of the steps to run; files of the others stay as they are. Empty for all.

    Raises:
        InputError: if the input is rejected; then nothing is written.
        BuildError: if an artefact could not be made.
        OutputError: if the folder cannot be written, has a pipe, device or folder in the place of
            a file, or `only` names no step.
    """
    _require_known(only, steps)
    before = unchanged(out, origin_hash)
    if before:
        return Report(before.origin, (), (), (), tuple(before.tasks))
    _require_files(out)
    design, documents = resolved()
    with manifest.writing(out), locked(out):
        run = _Run(out, design, progress or _silent)
        report = run.all(documents, steps, only)
        if not only:
            remember(out, origin_hash)
        return report


def _require_known(only: Collection[str], steps: "tuple[Step, ...]") -> None:
    names = [step.name for step in steps]
    unknown = sorted(set(only) - set(names))
    if unknown:
        raise OutputError(
            f"--only: no step is called {', '.join(unknown)}; the steps are {', '.join(names)}"
        )


def _require_files(out: Path) -> None:
    if odd := manifest.no_files(out):
        raise OutputError(
            f"{out / odd[0]}: is a pipe, device or folder in the place of a file; nothing was "
            "written. Remove it, or choose another folder with --out."
        )


class _Run:
    """One build: what it has made so far."""

    def __init__(self, out: Path, design: "Design", progress: Progress) -> None:
        from lumitip_fab.pipeline.dependencies import FieldHashes
        from lumitip_fab.pipeline.unfinished import Unfinished

        self.out, self.design, self.progress = out, design, progress
        self.before = manifest.read(out)
        self.unfinished = Unfinished(out, self.before)
        self.hashes = FieldHashes(design)
        self.files: dict[str, manifest.Entry] = {}
        self.tasks: dict[str, manifest.Ran] = {}
        self.written: list[str] = []
        self.ran: list[str] = []
        self.done_s = self.all_s = 0
        self.kept: list[str] = []

    def all(
        self, documents: "tuple[Artefact, ...]", steps: "tuple[Step, ...]", only: Collection[str]
    ) -> Report:
        """Write the documents and what the steps make; remove what no step makes any more."""
        # Imported here: to see that nothing changed, none of it is needed.
        from lumitip_fab.pipeline.workers import tasks

        asked = tuple(step for step in steps if not only or step.name in only)
        if only:
            self._keep_others({task.name for task in tasks(asked, self.design)})
        self._write("documents", documents)
        early = tuple(tasks(tuple(step for step in asked if not step.late), self.design))
        late = [tuple(tasks((step,), self.design)) for step in asked if step.late]
        self.all_s = sum(task.step.takes_s for some in (early, *late) for task in some)
        for some in (early, *late):
            self._make(some)
        removed = _remove(self.out, set(self.before.files) - set(self.files))
        origin = manifest.Origin()  # of files of several designs, none is the origin
        if not only:
            origin = manifest.Origin(self.design.layout.design_hash, self.design.parameters_hash)
        manifest.write(self.out, manifest.Manifest(self.files, self.tasks, origin))
        return Report(
            origin, tuple(sorted(self.written)), removed, tuple(self.ran), tuple(self.kept)
        )

    def _keep_others(self, asked: set[str]) -> None:
        """Files of tasks that are not asked for stay, with the keys that they were made by."""
        others = self.before.tasks.keys() - asked
        self.tasks |= {name: self.before.tasks[name] for name in sorted(others)}
        self.files |= {p: e for p, e in self.before.files.items() if e.task in others}

    def _make(self, wanted: "tuple[Task, ...]") -> None:
        """Run those tasks whose files are not there already."""
        from lumitip_fab.pipeline.workers import run_tasks

        files = self._available()
        versions = {path: entry.version for path, entry in self.files.items()}
        stale = [task for task in wanted if not self._is_current(task, versions)]
        for task in wanted:
            if task not in stale:
                self.kept.append(task.name)
                self.done_s += task.step.takes_s
                self.tasks[task.name] = self.before.tasks[task.name]
                mine = {p: e for p, e in self.before.files.items() if e.task == task.name}
                self.files |= mine
        fixed = {task.name: task.fixed() for task in stale}
        takes_s = {task.name: task.step.takes_s for task in stale}
        for result in run_tasks(stale, files):
            self._write(result.task, result.artefacts)
            needs = result.dependencies
            key = needs.key(self.hashes, versions, *fixed[result.task])
            self.tasks[result.task] = manifest.Ran(key, needs.fields, needs.files)
            self.ran.append(result.task)
            self.done_s += takes_s[result.task]
            self.progress(result.task, self.done_s, self.all_s)

    def _is_current(self, task: "Task", versions: dict[str, str]) -> bool:
        """Whether a task's files are there and nothing that it read has changed."""
        known = self.before.tasks.get(task.name)
        if known is None or not self.before.whole(self.out, task.name):
            return False
        key = known.dependencies.key(self.hashes, versions, *task.fixed())
        return key == known.key

    def _available(self) -> "Files":
        from lumitip_fab.pipeline.artefact import Files, Made

        return Files(self.out, {path: Made(e.sha256, e.facts) for path, e in self.files.items()})

    def _write(self, task: str, artefacts: "Sequence[Artefact]") -> None:
        mine = {artefact.path: manifest.entry(artefact, task) for artefact in artefacts}
        self.files |= mine
        changed = [
            artefact
            for artefact in artefacts
            if manifest.sha256_of(self.out / artefact.path) != mine[artefact.path].sha256
        ]
        if changed:
            self.unfinished.announce(changed)
        for artefact in changed:
            self.written.append(artefact.path)
            manifest.write_file(self.out / artefact.path, artefact.data)


def _silent(_name: str, _done: int, _total: int) -> None:
    """No progress is shown."""


def _remove(out: Path, paths: set[str]) -> tuple[str, ...]:
    # The manifest may have been edited: never reach outside the folder.
    mine = sorted(p for p in paths if (out / p).resolve().is_relative_to(out.resolve()))
    for path in mine:
        (out / path).unlink(missing_ok=True)
    return tuple(mine)
