"""`lumitip-fab check`: read an output folder and prove that its files fit."""

import argparse
import json
import os
from contextlib import nullcontext
from pathlib import Path

from lumitip_fab.checks.memory import Memory
from lumitip_fab.checks.run import MODULES, Outcome, as_json, run_checks
from lumitip_fab.cli import report, summary
from lumitip_fab.cli.screen import ERR, FAILED, OUT
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline.manifest import PAGE, STAMP, content_hash, write_file


def run(options: argparse.Namespace) -> int:
    """Check, and write the reports."""
    with ERR.status("reading the files back") if not options.quiet else nullcontext():
        outcome, text = checked(options.out, options.memory, options.junit, options.report)
    if options.json:
        print(text, end="")
    elif options.verbose:
        report.print_measurements(outcome, OUT)
    elif not options.quiet:
        summary.print_summary(outcome, options.out, options.report, OUT)
    elif outcome.failed:
        report.print_failures(outcome, OUT)
    return FAILED if outcome.failed else 0


def checked(
    out: Path, memory: Path | None, junit: Path | None, json_report: Path | None
) -> tuple[Outcome, str]:
    """Check an output folder, and write the reports.

    Args:
        out: the folder.
        memory: file with the measurements of earlier runs, which is written anew.
        junit: report to write as JUnit XML.
        json_report: report to write as JSON.

    Returns:
        What was measured, and the report as JSON.

    Raises:
        OutputError: if the folder is no output folder, or a report cannot be written.
    """
    reports = [path for path in (junit, json_report) if path]
    kept = Memory(memory, out, [*reports, out / PAGE, out / STAMP]) if memory else None
    content = content_hash(out)  # before: what changes meanwhile was not checked
    outcome = run_checks(out, MODULES, kept, os.cpu_count() or 1)
    record = {"content_sha256": content, "measurements": as_json(outcome)}
    text = json.dumps(record, indent=1) + "\n"
    for path, data in ((junit, report.junit(outcome)), (json_report, text.encode())):
        try:
            if path:
                write_file(path, data)
        except OSError as error:
            raise OutputError(f"{path}: cannot be written: {error.strerror}") from error
    return outcome, text
