"""`lumitip recover`: save what is left of a recording that broke off."""

import argparse
from pathlib import Path

from lumitip.commands.common import Subparsers


def add(subparsers: Subparsers) -> None:
    """Say what the command takes."""
    told = "Write what can be read of a damaged recording to a new, whole one."
    parser = subparsers.add_parser("recover", help=told, description=told)
    parser.add_argument("file", type=Path, metavar="FILE", help="the damaged recording, kept")
    parser.add_argument(
        "target", type=Path, nargs="?", metavar="NEW", help="the new one (FILE.recovered.mcap)"
    )


def run(options: argparse.Namespace) -> int:
    """Carry it out."""
    from lumitip.recording import recover

    target = options.target or options.file.with_suffix(".recovered.mcap")
    found = recover(options.file, target)
    print(f"{found.path}: {found.frames} frames; {'; '.join(found.damage) or 'nothing was wrong'}")
    return 0
