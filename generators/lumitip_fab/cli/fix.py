"""`lumitip-fab fix`: write the first remedies into a parameter file; its comments and layout
stay."""

import argparse
import json
import sys
from pathlib import Path

import tomlkit
from tomlkit.items import Table

from lumitip_fab.cli.screen import OUT, REFUSED
from lumitip_fab.config.load import load
from lumitip_fab.derive.auto.remedies import Plan, Remedy, plan_of
from lumitip_fab.derive.auto.resolve import RuleError, resolve
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline.manifest import write_file


def run(options: argparse.Namespace) -> int:
    """Change the file, and print what was changed."""
    plan = fix(options.file)
    changes = [step.remedies[0] for step in plan.steps]
    if options.json:
        print(
            json.dumps(
                {
                    "written": plan.complete and bool(changes),
                    "changes": [vars(change) for change in changes],
                },
                indent=1,
            )
        )
    elif not plan.complete:
        print(
            f"{options.file}: not changed; no small changes were found that mend every fault",
            file=sys.stderr,
        )
    elif not options.quiet:
        OUT.print(f"{options.file}: accepted as it is" if not changes else str(options.file))
        for change in changes:
            OUT.print(f"  {change}")
    return 0 if plan.complete else REFUSED


def fix(file: Path) -> Plan:
    """Change a refused parameter file so that it is accepted.

    Returns:
        What was changed; no steps if the file was accepted as it was. A plan that is not complete
        is not written.

    Raises:
        InputError: if the file cannot be read as parameters.
        OutputError: if it cannot be written.
    """
    config = load(file)
    try:
        resolve(config)
    except RuleError as error:
        plan = plan_of(error.verdict)
    else:
        return Plan((), True)
    if plan.complete:
        text = changed_text(file.read_text(encoding="utf-8"), plan)
        try:
            write_file(file, text.encode())
        except OSError as error:
            raise OutputError(f"{file}: cannot be written: {error.strerror}") from error
    return plan


def changed_text(text: str, plan: Plan) -> str:
    """The text of a parameter file with the first remedy of each step."""
    document = tomlkit.parse(text)
    for step in plan.steps:
        _set(document, step.remedies[0])
    return tomlkit.dumps(document)


def _set(document: tomlkit.TOMLDocument, remedy: Remedy) -> None:
    section, key = remedy.field.split(".")
    if section not in document:
        document[section] = tomlkit.table()
    table = document[section]
    assert isinstance(table, Table)
    table[key] = remedy.value
