"""Trial of a user file: accepted, refused or crashed; and, once built, which checks fail."""

import shutil
import tempfile
import traceback
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from acceptance.parts import DEFAULT, DESIGN


@dataclass(frozen=True)
class Refusal:
    """One problem of a refused file."""

    field: str
    message: str


@dataclass(frozen=True)
class Trial:
    """Result of one design."""

    name: str
    refusals: tuple[Refusal, ...] = ()
    crash: str = ""
    """The traceback of an exception that no user should see."""
    failed: tuple[str, ...] = ()
    """Checks of the built design that fail, with subject, figure and limit."""

    @property
    def accepted(self) -> bool:
        """Whether nothing was refused and nothing crashed."""
        return not (self.refusals or self.crash)


@contextmanager
def design_folder() -> Iterator[Path]:
    """A folder as a user has it: presets, catalogue, and room for files that extend them."""
    with tempfile.TemporaryDirectory(prefix="acceptance") as name:
        fill(Path(name))
        yield Path(name)


def fill(folder: Path) -> None:
    """Copy presets, default and catalogue into a folder."""
    for part in ("parts", "presets"):
        shutil.copytree(DESIGN / part, folder / part)
    shutil.copy(DESIGN / f"{DEFAULT}.toml", folder)


def derive_file(file: Path) -> Trial:
    """Derive a user file."""
    from lumitip_fab.config.load import load
    from lumitip_fab.derive import derive
    from lumitip_fab.errors import InputError

    try:
        derive(load(file))
    except InputError as error:
        problems = tuple(Refusal(p.field, p.message) for p in error.problems)
        return Trial(file.stem, refusals=problems)
    except Exception:  # noqa: BLE001 - whatever it is, it is what is counted
        return Trial(file.stem, crash=traceback.format_exc())
    return Trial(file.stem)


def build_file(file: Path, steps: Collection[str] = (), checks: Collection[str] = ()) -> Trial:
    """Build a user file and check what was built.

    Args:
        file: the parameter file.
        steps: names of the steps to run; empty for all.
        checks: names of the check modules to run; empty for all.
    """
    from lumitip_fab.checks.run import MODULES, run_checks
    from lumitip_fab.cli.build import build

    with tempfile.TemporaryDirectory(prefix="acceptance") as out:
        try:
            build(file, Path(out), only=steps)
            failed = run_checks(Path(out), checks or MODULES).failed
        except Exception:  # noqa: BLE001 - whatever it is, it is what is counted
            return Trial(file.stem, crash=traceback.format_exc())
    lines = (f"{m.check} {m.subject}: {m.measured:g} {m.unit} ({m.limit}) {m.note}" for m in failed)
    return Trial(file.stem, failed=tuple(lines))
