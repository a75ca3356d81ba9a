"""`lumitip-fab watch`: build again when the parameter file, a base or the catalogue is saved."""

import argparse
import contextlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from rich.console import Console
from watchfiles import watch as changes

from lumitip_fab.cli.build import build
from lumitip_fab.cli.check import checked
from lumitip_fab.cli.page import write_page
from lumitip_fab.cli.screen import OUT
from lumitip_fab.config.load import load
from lumitip_fab.config.messages import shown_path
from lumitip_fab.config.source import flat, read_toml
from lumitip_fab.design.encoding import encoded
from lumitip_fab.errors import FabError
from lumitip_fab.paths import design_folder

_LONGEST_WAIT_MS = 200


def run(options: argparse.Namespace) -> int:
    """Watch the file, which must exist."""
    if not options.file.is_file():
        read_toml(options.file, shown_path(options.file))  # raises
    with contextlib.suppress(KeyboardInterrupt):  # Ctrl-C is how one stops it
        watch(options.file, options.out, OUT, options.page)
    return 0


def watch(file: Path, out: Path, console: Console, with_page: bool) -> None:
    """Build now and after each change, until interrupted. After a rejected file, wait for the next
    change.

    Args:
        file: the parameter file.
        out: the output folder.
        console: prints the changed values and files.
        with_page: whether each build is checked, and its page written.
    """
    folder = design_folder(file)
    known: dict[str, Any] = {}
    watching = False
    # The first set, empty or not, comes when the watcher runs: what is saved from then on, during
    # the first build too, is seen.
    for saved in changes(
        folder,
        raise_interrupt=False,
        watch_filter=_input_files(out),
        yield_on_timeout=True,
        rust_timeout=_LONGEST_WAIT_MS,
    ):
        if saved or not watching:
            before, known = known, _rebuilt(file, out, known, console)
            if with_page and known is not before:
                _looked_at(out, console)
        if not watching:
            console.print(f"watching {folder}; stop with Ctrl-C")
            watching = True


def _input_files(out: Path) -> Callable[[Any, str], bool]:
    """TOML files, but for those that a build writes, should the outputs lie among the inputs."""
    return lambda _, path: path.endswith(".toml") and not Path(path).is_relative_to(out.resolve())


def _rebuilt(file: Path, out: Path, known: dict[str, Any], console: Console) -> dict[str, Any]:
    try:
        values = _values(file)
        for line in differences(known, values) if known else ():
            console.print(line)
        report = build(file, out)
    except FabError as error:
        console.print(str(error), style="red")
        return known
    for path in report.written:
        console.print(f"  wrote {out / path}", soft_wrap=True)
    console.print(f"{len(report.written)} files changed")
    return values


def _looked_at(out: Path, console: Console) -> None:
    """Check the folder, of which most is known from before, and write its page."""
    try:
        outcome, _ = checked(out, out / ".checked.json", None, out / "checks.json")
        path = write_page(out, watched=True)
    except FabError as error:
        console.print(str(error), style="red")
        return
    failed = sorted({m.check for m in outcome.failed})
    passed = len(outcome.names) - len(failed)
    named = f", {len(failed)} failed: {', '.join(failed)}" if failed else ""
    console.print(f"{passed} checks passed{named}; page {path}", soft_wrap=True)


def _values(file: Path) -> dict[str, Any]:
    config = load(file)
    parts = {f: encoded(e.model_dump()) for f, e in config.parts_by_field().items()}
    parameters = encoded(config.parameters.model_dump())
    return dict(flat({"parameters": parameters, "parts": parts}))


def differences(before: dict[str, Any], after: dict[str, Any]) -> Iterator[str]:
    """One line for each value that changed, appeared or went."""
    for name in sorted(before.keys() | after.keys()):
        old, new = before.get(name), after.get(name)
        if old != new:
            yield f"{name.removeprefix('parameters.')}: {old} → {new}"
