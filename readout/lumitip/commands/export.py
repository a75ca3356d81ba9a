"""`lumitip export`: a recording as a table."""

import argparse
from pathlib import Path

from lumitip.commands.common import Subparsers


def add(subparsers: Subparsers) -> None:
    """Say what the command takes."""
    told = "Write a recording as Parquet or CSV, one row a frame."
    parser = subparsers.add_parser("export", help=told, description=told)
    parser.add_argument("file", type=Path, metavar="FILE", help="the recording")
    parser.add_argument("table", type=Path, metavar="TABLE", help="ends in .parquet or .csv")


def run(options: argparse.Namespace) -> int:
    """Carry it out."""
    from lumitip.recording import export

    rows = export(options.file, options.table)
    print(f"{options.table}: {rows} frames")
    return 0
