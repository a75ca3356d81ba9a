"""`lumitip-fab diff`: how two designs differ."""

import argparse
import tempfile
from collections.abc import Callable, Iterable
from contextlib import ExitStack
from pathlib import Path

from rich.text import Text

from lumitip_fab.cli.build import build
from lumitip_fab.cli.screen import ERR, OUT
from lumitip_fab.diff.folder import Folder, read_folder
from lumitip_fab.diff.page import page
from lumitip_fab.diff.report import FAILS, compare, summary
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline.manifest import write_file
from lumitip_fab.system_libraries import libraries_message, missing_libraries

PAGE, RECORD = "diff.html", "diff.json"


def run(options: argparse.Namespace) -> int:
    """Compare two designs, and write page and record."""
    _require_outside(options.out, _inputs(options).values())
    silent = options.quiet or options.json
    with ExitStack() as stack:
        shown = None if silent else stack.enter_context(ERR.status("reading"))

        def progress(work: str) -> None:
            if shown:
                shown.update(work)

        a, b = (_read(path, name, stack, progress) for name, path in _inputs(options).items())
        found = compare(a, b, not options.no_checks, progress)
        files = {PAGE: page(found), RECORD: found.json()}
    for name, text in files.items():
        try:
            write_file(options.out / name, text.encode())
        except OSError as error:
            raise OutputError(
                f"--out: is {options.out}, which cannot be written ({error.strerror}); a folder "
                "that can be written is needed. Choose another folder."
            ) from error
    if options.json:
        print(found.json(), end="")
    elif not options.quiet:
        for name, folder in (("A", a), ("B", b)):
            OUT.print(f"{name:<14}{folder.name}: {found.record[name.lower()]['title']}")
        for subject, text in summary(found):
            style = "bold red" if FAILS in text else ""
            OUT.print(Text(f"{subject:<14}{text}", style=style), soft_wrap=True)
        OUT.print(f"wrote {options.out / PAGE}, {options.out / RECORD}", soft_wrap=True)
    return 0


def _inputs(options: argparse.Namespace) -> dict[str, Path]:
    return {"A": options.a, "B": options.b}


def _require_outside(out: Path, inputs: Iterable[Path]) -> None:
    """Refuse to write into an output folder: the files would be part of the next comparison."""
    for folder in inputs:
        if folder.is_dir() and out.resolve().is_relative_to(folder.resolve()):
            raise OutputError(
                f"--out: is {out}, which is inside {folder}; a folder outside both designs is "
                "needed. Choose another folder."
            )


def _read(path: Path, label: str, stack: ExitStack, progress: Callable[[str], None]) -> Folder:
    """An output folder; a parameter file is built into a temporary one."""
    if path.is_dir():
        return read_folder(path, path.resolve().name)
    if not path.is_file():
        raise OutputError(
            f"{label}: is {path}, which does not exist; a parameter file or an output folder is "
            "needed. Check the path."
        )
    if missing := missing_libraries():
        raise OutputError(libraries_message(missing))
    progress(f"building {label}")
    out = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="lumitip-diff-")))
    build(path, out)
    return read_folder(out, path.name)
