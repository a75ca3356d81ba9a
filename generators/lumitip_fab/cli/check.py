"""`lumitip-fab check`: read an output folder and prove that its files fit."""

import argparse
import json
import os
from contextlib import nullcontext

from lumitip_fab.checks.run import MODULES, Memory, as_json, run_checks
from lumitip_fab.cli import report, summary
from lumitip_fab.cli.screen import ERR, FAILED, OUT
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline.manifest import PAGE, content_hash, write_file


def run(options: argparse.Namespace) -> int:
    """Check, and write the reports."""
    with ERR.status("reading the files back") if not options.quiet else nullcontext():
        reports = [path for path in (options.junit, options.report) if path]
        beside = [*reports, options.out / PAGE]
        memory = Memory(options.memory, options.out, beside) if options.memory else None
        content = content_hash(options.out)  # before: what changes meanwhile was not checked
        outcome = run_checks(options.out, MODULES, memory, os.cpu_count() or 1)
    record = {"content_sha256": content, "measurements": as_json(outcome)}
    text = json.dumps(record, indent=1) + "\n"
    for path, data in ((options.junit, report.junit(outcome)), (options.report, text.encode())):
        try:
            if path:
                write_file(path, data)
        except OSError as error:
            raise OutputError(f"{path}: cannot be written: {error.strerror}") from error
    if options.json:
        print(text, end="")
    elif options.verbose:
        report.print_measurements(outcome, OUT)
    elif not options.quiet:
        summary.print_summary(outcome, options.out, options.report, OUT)
    elif outcome.failed:
        report.print_failures(outcome, OUT)
    return FAILED if outcome.failed else 0
