"""`lumitip-fab init`, `schema`, `channel-map` and `slice`: commands of a few lines each."""

import argparse
import json
import shutil
import sys
from pathlib import Path
from shlex import quote

from lumitip_fab.cli.screen import ERR, FAILED, OUT, REFUSED


def init(options: argparse.Namespace) -> int:
    """Copy parameters, presets and parts."""
    from lumitip_fab.paths import packaged_design

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
            f"{quote(str(target / 'fingertip.toml'))} --out outputs",
            soft_wrap=True,
        )
    return 0


def schema(options: argparse.Namespace) -> int:
    """Print the JSON Schema of parameter files."""
    from lumitip_fab.config.messages import shown_path
    from lumitip_fab.config.schema import schema_text
    from lumitip_fab.config.source import read_toml
    from lumitip_fab.paths import design_folder

    folder = None
    if options.file:
        read_toml(options.file, shown_path(options.file))
        folder = design_folder(options.file)
    print(schema_text(folder), end="")
    return 0


def channel_map(options: argparse.Namespace) -> int:
    """Print the detector of each multiplexer input, from the copper of the board."""
    from lumitip_fab.checks.connections import read_channels

    found = read_channels(options.file)
    if options.json:
        print(json.dumps(found.best, indent=1))
    else:
        for mux, inputs in found.best.items():
            listed = "  ".join(f"{channel}:{detector}" for channel, detector in inputs.items())
            print(f"{mux} ({found.output[mux] or 'no net'})  {listed}")
    for doubt in found.doubts:
        print(doubt, file=sys.stderr)
    return FAILED if found.contradicted else 0


def slice_parts(options: argparse.Namespace) -> int:
    """Slice the printed parts, with progress."""
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    from lumitip_fab.parts import slicing

    columns = (TextColumn("{task.description:<32}"), BarColumn(), MofNCompleteColumn())
    silent = options.quiet or options.json
    with Progress(*columns, console=ERR, disable=silent, transient=True) as bar:
        shown = bar.add_task("slicing", total=None)

        def progress(name: str, done: int, total: int) -> None:
            bar.update(shown, description=name, completed=done, total=total)

        parts = slicing.slice_parts(options.out, options.gcode, progress)
    if options.json:
        print(slicing.as_json(parts))
    elif not options.quiet:
        slicing.print_table(parts, OUT)
    return 0
