"""Helpers of several subcommands."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lumitip.fingertip import Fingertip

BUILT_LAYOUT = Path("outputs/layout.json")


def layout_path(options: argparse.Namespace, url: str) -> Path | None:
    """The path of `--layout`, or of the layout built here; replays and servers have their own."""
    path: Path | None = options.layout
    own = url.lower().startswith(("replay:", "tcp:"))
    if path is None and BUILT_LAYOUT.is_file() and not own:
        return BUILT_LAYOUT
    return path


def open_fingertip(options: argparse.Namespace, *, calibrated: bool = True) -> "Fingertip":
    """Open the fingertip that the arguments name; errors as of `Fingertip.open`."""
    from lumitip.fingertip import Fingertip

    return Fingertip.open(
        options.url,
        layout_path(options, options.url),
        timeout=options.timeout,
        any_design=options.any_design,
        calibrated=calibrated,
    )
