"""`lumitip-fab build`: parameter file to output folder, with all steps."""

import argparse
import json
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING

from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

from lumitip_fab.cli.readings import lost, readings
from lumitip_fab.cli.screen import ERR, OUT
from lumitip_fab.cli.steps import STEPS
from lumitip_fab.pipeline import build as pipeline
from lumitip_fab.pipeline.fingerprint import input_hash

if TYPE_CHECKING:
    from lumitip_fab.design import Design
    from lumitip_fab.pipeline.artefact import Artefact

_FEW = 20  # files that are named one by one


def build(
    file: Path,
    out: Path,
    progress: pipeline.Progress | None = None,
    only: Collection[str] = (),
) -> pipeline.Report:
    """Build a parameter file into an output folder.

    Args:
        file: the parameter file.
        out: the folder; made if missing.
        progress: called at the end of each task.
        only: names of the steps to run; empty for all.

    Prints each reading of the user's prints that the folder had, and has no more.

    Raises:
        InputError: if the file is rejected; then nothing is written.
        BuildError: if an artefact could not be made.
        OutputError: if the folder cannot be written.
    """

    def resolved() -> "tuple[Design, tuple[Artefact, ...]]":
        # Imported here: to see that nothing changed, none of it is needed.
        from lumitip_fab.cli.documents import documents
        from lumitip_fab.config.load import load
        from lumitip_fab.derive import resolve

        found = resolve(load(file))
        return found.design, documents(found.config, found.design, out)

    before = readings(out)
    try:
        return pipeline.build(input_hash(file), resolved, out, STEPS, progress, only)
    finally:  # an interrupted build has written its parameters, too
        for line in lost(before, file, out):
            ERR.print(line, soft_wrap=True)


def run(options: argparse.Namespace) -> int:
    """Build, with progress."""
    columns = (
        TextColumn("{task.description:<24}"),
        BarColumn(),
        TaskProgressColumn(),
        TimeRemainingColumn(),
        TextColumn("left"),
    )
    silent = options.quiet or options.json
    with Progress(*columns, console=ERR, disable=silent, transient=True) as bar:
        shown = bar.add_task("reading", total=None)

        def progress(name: str, done: int, total: int) -> None:
            bar.update(shown, description=name, completed=done, total=total)

        report = build(options.file, options.out, progress, options.only)
    if options.json:
        summary = {
            "design_hash": report.origin.design_hash,
            "parameters_hash": report.origin.parameters_hash,
            **{name: getattr(report, name) for name in ("written", "removed", "made", "kept")},
        }
        print(json.dumps(summary, indent=1))
    elif not options.quiet:
        if options.verbose:
            for line in shortened(options.out, report.written):
                OUT.print(f"  wrote {line}", soft_wrap=True)
            for path in report.removed:
                OUT.print(f"  removed {options.out / path}", soft_wrap=True)
        OUT.print(
            f"{len(report.written)} files changed, {len(report.kept)} of "
            f"{len(report.kept) + len(report.made)} steps were up to date"
        )
    return 0


def shortened(out: Path, written: tuple[str, ...]) -> list[str]:
    """Files by name where they are few; else how many there are in each folder."""
    paths = [out / name for name in written]
    if len(paths) <= _FEW:
        return [str(path) for path in paths]
    folders: dict[Path, list[Path]] = {}
    for path in paths:
        folders.setdefault(path.parent, []).append(path)
    return [
        f"{folder}: {len(inside)} files" if len(inside) > 1 else str(inside[0])
        for folder, inside in folders.items()
    ]
