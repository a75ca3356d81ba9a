"""`lumitip-fab init`: copy the design folder."""

import argparse
import shutil
import sys
from pathlib import Path

from lumitip_fab.cli.screen import OUT, REFUSED
from lumitip_fab.paths import packaged_design


def run(options: argparse.Namespace) -> int:
    """Copy parameters, presets and parts."""
    target: Path = options.directory
    if target.exists() and (not target.is_dir() or any(target.iterdir())):
        print(f"{target}: exists and is not empty: name a new or empty folder", file=sys.stderr)
        return REFUSED
    try:
        shutil.copytree(packaged_design(), target, dirs_exist_ok=True)
    except (OSError, shutil.Error) as error:
        print(f"{target}: cannot be written: {error}", file=sys.stderr)
        return REFUSED
    if not options.quiet:
        OUT.print(
            f"{target}: edit fingertip.toml, then: lumitip-fab build "
            f"{target / 'fingertip.toml'} --out outputs"
        )
    return 0
