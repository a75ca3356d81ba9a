"""Lumitip on the maker's side: one parameter file to every part, and the proof that they fit.

design = lumitip_fab.derived(Path("design/fingertip.toml"))
lumitip_fab.build(Path("design/fingertip.toml"), Path("outputs"))
outcome = lumitip_fab.check(Path("outputs"))
lumitip_fab.show("outputs/backing/receiver_backing.step")
"""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from build123d import Shape

    from lumitip_fab.checks.run import Outcome
    from lumitip_fab.config.load import Input
    from lumitip_fab.design import Design
    from lumitip_fab.pipeline.build import Progress, Report

__all__ = ["build", "check", "derived", "load", "show"]


# What a function needs is imported when it is called: many programs want one of them.
def load(file: Path | str) -> "Input":
    """Read a parameter file with its bases and the catalogue.

    Raises:
        InputError: with every fault of the file.
    """
    from lumitip_fab.config import load as config

    return config.load(Path(file))


def derived(file: Path | str) -> "Design":
    """The design that a parameter file describes.

    Raises:
        InputError: with every fault of the file, and the smallest changes that work.
    """
    from lumitip_fab.derive import derive

    return derive(load(file))


def build(
    file: Path | str, out: Path | str, progress: "Progress | None" = None, only: Sequence[str] = ()
) -> "Report":
    """Build a parameter file into an output folder; only what changed is made again.

    It starts processes: in a script, call it below `if __name__ == "__main__":`.

    Args:
        file: the parameter file.
        out: the folder; made if missing.
        progress: called with the name of each step that ends, how much is done, and how much
            there is, both in seconds that the steps take one core, about.
        only: names of the steps to run, like `["backing"]`; all, if there are none.

    Raises:
        InputError: if the file is rejected; then nothing is written.
        BuildError: if a file could not be made.
        OutputError: if the folder cannot be written.
    """
    from lumitip_fab.cli import build as command

    return command.build(Path(file), Path(out), progress, only)


def check(out: Path | str) -> "Outcome":
    """Read the files of an output folder back and measure whether they fit.

    It starts processes, as `build` does.

    Raises:
        OutputError: if there is no usable `design.json`.
    """
    from lumitip_fab.checks.run import run_checks

    return run_checks(Path(out))


def show(*parts: "Shape | Path | str", open_page: bool = True) -> Path:
    """Show parts in the browser, from a page that works without a network.

    Args:
        parts: shapes of build123d, or STEP, STL, 3MF or GLB files.
        open_page: open the page; if not, it is only written.

    Returns:
        The page, in the temporary folder of the system.

    Raises:
        ValueError: with every argument that is no part.
    """
    from lumitip_fab.parts import show as viewer

    return viewer.show(*parts, open_page=open_page)
