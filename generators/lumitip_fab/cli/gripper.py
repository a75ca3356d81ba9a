"""`lumitip-fab gripper`: measure a gripper that is not in the catalogue, and write its entry."""

import argparse
import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from rich.table import Table

from lumitip_fab.cli.screen import OUT
from lumitip_fab.errors import InputError, OutputError, Problem
from lumitip_fab.paths import design_folder, packaged_design
from lumitip_fab.text import table_of

if TYPE_CHECKING:
    from lumitip_fab.grippers.wizard import Fingertip

_NAME = re.compile(r"[a-z0-9]+(_[a-z0-9]+)*")
_FINGER = "presets/published.toml"
_GAUGE = ".stl"
_NUMBERS = {
    "bolts": re.compile(r"[1-9]\d{0,3}(,[1-9]\d{0,3})*"),
    "mount": re.compile(r"[1-9]\d{0,3}"),
    "pad": re.compile(r"[1-9]\d{0,3}"),
}
"""Options that name holes and faces of a STEP file, and their form."""


def new(options: argparse.Namespace) -> int:
    """Write page and answers file, or from the answers the entry; then say what is next."""
    from lumitip_fab.config.load import load
    from lumitip_fab.grippers import wizard
    from lumitip_fab.grippers.ways import Named

    _refuse_options(options)
    name, out = options.name, _folder(options)
    published = load(packaged_design() / _FINGER)
    own = load(options.file) if options.file else published
    tip = None
    notes: tuple[str, ...] = ()
    if options.answers:
        made = wizard.finished(name, own, options.answers)
    else:
        if options.from_step:
            (mount, *_), (pad, *_) = _numbers(options.mount or "0"), _numbers(options.pad or "0")
            named = Named(_numbers(options.bolts or ""), mount, pad)
            tip = wizard.read_fingertip(options.from_step, own.catalogue, named)
        made, notes = wizard.started(name, published, own, options.like, tip)
    files = {out / file: data for file, data in made.items()}
    added = {}
    if options.add:
        entry = made[f"{name}_entry.toml"]
        added = dict([wizard.catalogue_with(name, entry, options.file, options.replace)])
    gauge = out / f"{name}_gauge{_GAUGE}"
    _write(files, added, options.replace, () if gauge in files else (gauge,))
    _report(options, [str(path) for path in (*files, *added)], tip, notes)
    return 0


def _numbers(text: str) -> tuple[int, ...]:
    return tuple(map(int, text.split(","))) if text else ()


def _folder(options: argparse.Namespace) -> Path:
    if options.out:
        return Path(options.out)
    return Path(options.answers).parent if options.answers else Path(options.name)


def _refuse_options(options: argparse.Namespace) -> None:
    """Refuse a name that is none of a catalogue, and options that do not go together."""
    texts = table_of("grippers/texts.toml")["faults"]
    faults = []
    if not _NAME.fullmatch(options.name):
        faults.append(("NAME", texts["name"].format(name=options.name)))
    if options.add and not options.answers:
        faults.append(("--add", texts["add_answers"]))
    if options.answers and options.like:
        faults.append(("--like", texts["like_answers"]))
    if options.add and not options.file:
        faults.append(("--add", texts["add_file"]))
    for option, form in _NUMBERS.items():
        value = getattr(options, option)
        if value is not None and not options.from_step:
            faults.append((f"--{option}", texts["named_step"]))
        elif value is not None and not form.fullmatch(value):
            faults.append((f"--{option}", texts["named_form"].format(value=value)))
    if faults:
        raise InputError(Problem("lumitip-fab gripper", 0, *fault) for fault in faults)


def _write(
    files: Mapping[Path, bytes], added: Mapping[Path, bytes], replace: bool, old: Iterable[Path]
) -> None:
    """Write all files, or none where one would be lost; those that were only added to are not, nor
    is a gauge, which nobody edits. An old one, of other figures, is removed."""
    from lumitip_fab.pipeline.manifest import write_file

    text = table_of("grippers/texts.toml")["faults"]["exists"]
    try:
        kept = (file for file in files if file.suffix != _GAUGE)
        lost = [f for f in kept if f.exists() and f.read_bytes() != files[f]]
        if lost and not replace:
            raise OutputError("\n".join(f"{file}: {text}" for file in lost))
        for file, data in {**files, **added}.items():
            write_file(file, data)
        for file in old:
            file.unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(f"{error.filename}: cannot be written: {error.strerror}") from error


def _report(
    options: argparse.Namespace,
    written: list[str],
    tip: "Fingertip | None",
    notes: tuple[str, ...],
) -> None:
    figures = tip.proposal.figures if tip else {}
    if options.json:
        found = {name: vars(figure) for name, figure in figures.items()}
        print(json.dumps({"written": written, "found": found, "notes": notes}, indent=1))
        return
    if options.quiet:
        return
    if tip:
        _print_found(tip)
    for note in notes:
        OUT.print(note)
    for path in written:
        OUT.print(path)
    step = "answers" if not options.answers else "use" if options.add else "add"
    answers = _folder(options) / f"{options.name}.toml"
    text = table_of("grippers/texts.toml")["next"][step]
    file = options.file or packaged_design() / _FINGER
    places = {"answers": answers, "file": file, "folder": design_folder(file)}
    OUT.print(text.format(name=options.name, **places), soft_wrap=True)


def _print_found(tip: "Fingertip") -> None:
    """Print holes, faces and figures as tables."""
    headings = (("found", "size", "at u, w (mm)"), ("figure", "value", "from"))
    figures = ((n, f"{f.value}", f.where) for n, f in tip.proposal.figures.items())
    for heading, rows in zip(headings, (tip.proposal.rows(), figures), strict=True):
        table = Table(box=None, pad_edge=False, header_style="bold")
        for column in heading:
            table.add_column(column, overflow="fold")
        for row in rows:
            table.add_row(*row)
        OUT.print(table)
        OUT.print()
