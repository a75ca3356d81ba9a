"""Lumitip on the maker's side: one parameter file to every part, and the proof that they fit.

design = lumitip_fab.derived(Path("design/fingertip.toml"))
lumitip_fab.build(Path("design/fingertip.toml"), Path("outputs"))
outcome = lumitip_fab.check(Path("outputs"))
"""

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lumitip_fab.checks.run import Outcome
    from lumitip_fab.config.load import Input
    from lumitip_fab.design import Design
    from lumitip_fab.pipeline.build import Progress, Report

__all__ = ["build", "check", "derived", "load"]


# What a function needs is imported when it is called: many programs want one of them.
def load(file: Path) -> "Input":
    """Read a parameter file with its bases and the catalogue.

    Raises:
        InputError: with every fault of the file.
    """
    from lumitip_fab.config import load as config

    return config.load(file)


def derived(file: Path) -> "Design":
    """The design that a parameter file describes.

    Raises:
        InputError: with every fault of the file, and the smallest changes that work.
    """
    from lumitip_fab.derive import derive

    return derive(load(file))


def build(file: Path, out: Path, progress: "Progress | None" = None) -> "Report":
    """Build a parameter file into an output folder; only what changed is made again.

    Args:
        file: the parameter file.
        out: the folder; made if missing.
        progress: called with the name of each step that ends, how many are done, and how many
            there are.

    Raises:
        InputError: if the file is rejected; then nothing is written.
        BuildError: if a file could not be made.
        OutputError: if the folder cannot be written.
    """
    from lumitip_fab.cli import build as command

    return command.build(file, out, progress)


def check(out: Path) -> "Outcome":
    """Read the files of an output folder back and measure whether they fit.

    Raises:
        OutputError: if there is no usable `design.json`.
    """
    from lumitip_fab.checks.run import run_checks

    return run_checks(out)
