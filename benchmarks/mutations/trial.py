"""A mutant written into a scratch copy, the checks that read it, and the file put back."""

import json
import logging
import signal
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from hashlib import sha256
from importlib import import_module
from pathlib import Path, PurePosixPath
from types import FrameType
from typing import Any

from lumitip_fab.checks.run import modules_reading
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import read_design
from lumitip_fab.errors import OutputError
from mutations.damage import Mutant
from mutations.formats import artefact
from mutations.sample import MANIFEST

MOST_SECONDS = 120
OF_ONE_BOARD = ("board", "orders")
"""Modules that take seconds, and can measure one board alone."""
logger = logging.getLogger(__name__)


@dataclass(frozen=True)
class Trial:
    """A mutant and what the checks found."""

    path: str
    kind: str
    seed: int
    description: str
    failed: tuple[str, ...]
    """Names of the checks that failed."""
    crash: str = ""
    """The exception of a check that raised one; it counts as not caught."""

    @property
    def caught(self) -> bool:
        """Whether a check failed, and none stopped."""
        return bool(self.failed) and not self.crash

    @property
    def artefact(self) -> str:
        """Top folder and format of the file."""
        return artefact(self.path)

    def record(self) -> dict[str, Any]:
        """As JSON has it."""
        return asdict(self) | {"caught": self.caught}


def tried(out: Path, mutant: Mutant) -> Trial:
    """Damage a folder, run the checks that read what differs, and put it back.

    Args:
        out: a scratch copy of an output folder whose checks all pass.
        mutant: made from that folder.
    """
    with damaged(out, mutant):
        failed, crash = _checked(out, sorted(mutant.files))
    named = (mutant.path, mutant.kind, mutant.seed, mutant.description)
    return Trial(*named, tuple(failed), crash)


@contextmanager
def damaged(out: Path, mutant: Mutant) -> Iterator[None]:
    """The folder with the mutant's files in place, and as it was afterwards."""
    touched = [*mutant.files, *([MANIFEST] if mutant.listed else [])]
    before = {p: (out / p).read_bytes() if (out / p).exists() else None for p in touched}
    try:
        _write(out, mutant.files)
        if mutant.listed:
            _list(out, mutant.files)
        yield
    finally:
        _write(out, before)


def _write(out: Path, files: "dict[str, bytes | None] | Any") -> None:
    for path, data in files.items():
        if data is None:
            (out / path).unlink(missing_ok=True)
        else:
            (out / path).write_bytes(data)


def _list(out: Path, files: "dict[str, bytes | None] | Any") -> None:
    """Make the manifest right, as a faulty generator would have written it."""
    record = json.loads((out / MANIFEST).read_text(encoding="utf-8"))
    for path, data in files.items():
        if data is None:
            record["files"].pop(path, None)
        elif path in record["files"]:
            record["files"][path] |= {"sha256": sha256(data).hexdigest(), "bytes": len(data)}
    (out / MANIFEST).write_text(json.dumps(record, indent=1, sort_keys=True) + "\n", "utf-8")


def _checked(out: Path, changed: list[str]) -> tuple[list[str], str]:
    """Names of the checks that fail, and the exception of the first that raised one."""
    failed: list[str] = []
    try:
        with _in_time(), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                design = read_design(out / "design.json")
            except OutputError as error:
                return [f"design: {error!s:.80}"], ""
            for name in sorted({*modules_reading(changed), "manifest"}):
                failed += _failed(name, out, design, board_of(changed))
    except (Exception, TooLongError) as error:  # noqa: BLE001
        return failed, f"{type(error).__name__}: {error!s:.200} ({_place(error)})"
    return sorted(set(failed)), ""


def _place(error: BaseException) -> str:
    """The last line of the checks that an exception passed."""
    # A generator that raises StopIteration says where only in the cause.
    frames = traceback.extract_tb((error.__cause__ or error).__traceback__)
    own = [f for f in frames if "lumitip_fab" in Path(f.filename).parts] or frames
    return f"{Path(own[-1].filename).name}:{own[-1].lineno} {own[-1].name}"


def _failed(name: str, out: Path, design: Design, board: str) -> list[str]:
    module = import_module(f"lumitip_fab.checks.{name}")
    if board and name in OF_ONE_BOARD:
        found = module.measure_board(out, design, board)
    else:
        found = module.measure(out, design)
    return [m.check for m in found if not m.passed]


def board_of(changed: list[str]) -> str:
    """The board that all changed files are of; empty where there is no one such board."""
    parts = [PurePosixPath(path).parts for path in changed]
    boards = {p[1] if len(p) > 2 and p[0] == "boards" else "" for p in parts}
    board = boards.pop()
    return "" if boards or board == "models" else board


class TooLongError(BaseException):
    """A check does not end. Readers take whatever is an `Exception` for a damaged file."""


@contextmanager
def _in_time() -> Iterator[None]:
    """Ends a check that does not end by itself with an exception."""

    def stop(_signal: int, _frame: FrameType | None) -> None:
        raise TooLongError(f"longer than {MOST_SECONDS} s")

    before = signal.signal(signal.SIGALRM, stop)
    signal.alarm(MOST_SECONDS)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
