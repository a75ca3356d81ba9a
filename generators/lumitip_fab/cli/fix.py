"""`lumitip-fab fix`: write the first remedies into a parameter file; its comments and layout
stay."""

import argparse
import json
import stat
import sys
from collections.abc import MutableMapping
from pathlib import Path

import tomlkit

from lumitip_fab.cli.screen import OUT, REFUSED
from lumitip_fab.config.load import load
from lumitip_fab.derive.auto.remedies import Plan, Remedy, plan_of, remedy_lines
from lumitip_fab.derive.auto.resolve import RuleError, resolve
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline.manifest import write_file

_MARK = "\ufeff"  # with which some editors begin a file


def run(options: argparse.Namespace) -> int:
    """Change the file, and print what was changed."""
    plan, error = fix(options.file)
    changes = [step.remedies[0] for step in plan.steps]
    if options.json:
        print(
            json.dumps(
                {
                    "written": plan.complete and bool(changes),
                    "changes": [vars(change) for change in changes],
                    "problems": [vars(p) for p in error.problems] if error else [],
                },
                indent=1,
            )
        )
    if not plan.complete:
        text = f"{options.file}: not changed; no small changes were found that mend every fault"
        print(text, error, *remedy_lines(plan), sep="\n", file=sys.stderr)
    elif not options.quiet and not options.json:
        OUT.print(f"{options.file}: accepted as it is" if not changes else str(options.file))
        for change in changes:
            OUT.print(f"  {change}")
    return 0 if plan.complete else REFUSED


def fix(file: Path) -> tuple[Plan, RuleError | None]:
    """Change a rejected parameter file so that it is accepted.

    Returns:
        The changes, and the faults of the file as it was; none if it was accepted. A plan that is
        not complete is not written.

    Raises:
        InputError: if the file cannot be read as parameters.
        OutputError: if it cannot be written.
    """
    plan, error = _planned(file)
    _write(file, plan)
    return plan, error


def _planned(file: Path) -> tuple[Plan, RuleError | None]:
    """The changes of a parameter file, and its faults; none if it is accepted as it is."""
    config = load(file)
    try:
        resolve(config)
    except RuleError as error:
        return plan_of(error.verdict), error
    return Plan((), True), None


def _write(file: Path, plan: Plan) -> None:
    if not plan.complete or not plan.steps:
        return
    try:
        _rewrite(file.resolve(), plan)  # where a link leads
    except OSError as error:
        raise OutputError(f"{file}: cannot be written: {error.strerror}") from error


def _rewrite(file: Path, plan: Plan) -> None:
    mode = stat.S_IMODE(file.stat().st_mode)
    if not mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH):
        raise OutputError(f"{file}: cannot be written: it is read-only")
    text = changed_text(file.read_bytes().decode(), plan)
    write_file(file, text.encode(), mode)


def changed_text(text: str, plan: Plan) -> str:
    """The text of a parameter file with the first remedy of each step."""
    mark = _MARK if text.startswith(_MARK) else ""
    document = tomlkit.parse(text.removeprefix(_MARK))
    for step in plan.steps:
        _set(document, step.remedies[0])
    changed = tomlkit.dumps(document)
    if 0 < text.count("\n") == text.count("\r\n"):  # the same in lines that were added
        changed = changed.replace("\r\n", "\n").replace("\n", "\r\n")
    return mark + changed


def _set(document: tomlkit.TOMLDocument, remedy: Remedy) -> None:
    section, key = remedy.field.split(".")
    if section not in document:
        document[section] = tomlkit.table()
    table = document[section]
    assert isinstance(table, MutableMapping)  # as the file was read before
    table[key] = remedy.value
