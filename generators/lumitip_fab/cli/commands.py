"""What each command of `lumitip-fab` does."""

import argparse
import json
import os
import shutil
import sys
from contextlib import nullcontext
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from lumitip_fab.cli import FAILED, REFUSED
from lumitip_fab.errors import BuildError, InputError, OutputError
from lumitip_fab.paths import packaged_design

_FEW = 20  # files that are named one by one
WIDE = None if sys.stdout.isatty() else 200  # a file or a log has no edge to fold at
# Names of files and designs are told as they are, with brackets and colons in them.
OUT = Console(highlight=False, markup=False, emoji=False, width=WIDE)
ERR = Console(stderr=True, highlight=False, markup=False, emoji=False)


def run(options: argparse.Namespace) -> int:
    """Carry out a parsed command line."""
    try:
        return COMMANDS[options.command](options)
    except InputError as error:
        return _refuse(options, error)
    except (OutputError, BuildError) as error:
        if options.json:
            print(json.dumps({"error": str(error)}, indent=1))
        print(error, file=sys.stderr)
        return FAILED if isinstance(error, BuildError) else REFUSED


def _refuse(options: argparse.Namespace, error: InputError) -> int:
    """Print every fault, and the changes that mend those which the rules found."""
    from lumitip_fab.derive.auto.remedies import remedy_lines
    from lumitip_fab.derive.auto.resolve import RuleError

    remedies = remedy_lines(error.verdict) if isinstance(error, RuleError) else []
    if options.json:
        problems = [vars(p) for p in error.problems]
        print(json.dumps({"problems": problems, "remedies": remedies[1:]}, indent=1))
    print(error, *remedies, sep="\n", file=sys.stderr)
    if remedies:
        print(f"lumitip-fab fix {options.file} writes them.", file=sys.stderr)
    return REFUSED


def _init(options: argparse.Namespace) -> int:
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
        OUT.print(f"{target}: edit fingertip.toml, then: lumitip-fab build "
                  f"{target / 'fingertip.toml'} --out outputs")  # fmt: skip
    return 0


def _build(options: argparse.Namespace) -> int:
    from lumitip_fab.pipeline.build import build

    columns = (TextColumn("{task.description:<24}"), BarColumn(), MofNCompleteColumn(),
               TimeElapsedColumn())  # fmt: skip
    silent = options.quiet or options.json
    with Progress(*columns, console=ERR, disable=silent, transient=True) as bar:
        shown = bar.add_task("reading", total=None)

        def progress(name: str, done: int, total: int) -> None:
            bar.update(shown, description=name, completed=done, total=total)

        report = build(options.file, options.out, progress)
    if options.json:
        told = {
            "design_hash": report.origin.design_hash,
            "parameters_hash": report.origin.parameters_hash,
            **{name: getattr(report, name) for name in ("written", "removed", "made", "kept")},
        }
        print(json.dumps(told, indent=1))
    elif not options.quiet:
        if options.verbose:
            for line in shortened(options.out, report.written):
                OUT.print(f"  wrote {line}", soft_wrap=True)
            for path in report.removed:
                OUT.print(f"  removed {options.out / path}", soft_wrap=True)
        OUT.print(f"{len(report.written)} files changed, {len(report.kept)} of "
                  f"{len(report.kept) + len(report.made)} steps were up to date")  # fmt: skip
    return 0


def shortened(out: Path, written: tuple[str, ...]) -> list[str]:
    """Files by name where they are few; else how many there are in each folder."""
    paths = [out / name for name in written]
    if len(paths) <= _FEW:
        return [str(path) for path in paths]
    folders: dict[Path, list[Path]] = {}
    for path in paths:
        folders.setdefault(path.parent, []).append(path)
    return [f"{folder}: {len(inside)} files" if len(inside) > 1 else str(inside[0])
            for folder, inside in folders.items()]  # fmt: skip


def _check(options: argparse.Namespace) -> int:
    from lumitip_fab.checks import report, summary
    from lumitip_fab.checks.memory import Memory
    from lumitip_fab.checks.run import MODULES, as_json, run_checks
    from lumitip_fab.pipeline.manifest import write_file

    with ERR.status("reading the files back") if not options.quiet else nullcontext():
        reports = [path for path in (options.junit, options.report) if path]
        memory = Memory(options.memory, options.out, reports) if options.memory else None
        outcome = run_checks(options.out, MODULES, memory, os.cpu_count() or 1)
    told = json.dumps(as_json(outcome), indent=1) + "\n"
    for path, data in ((options.junit, report.junit(outcome)), (options.report, told.encode())):
        try:
            if path:
                write_file(path, data)
        except OSError as error:
            raise OutputError(f"{path}: cannot be written: {error.strerror}") from error
    if options.json:
        print(told, end="")
    elif options.verbose:
        report.print_measurements(outcome, OUT)
    elif not options.quiet:
        summary.print_summary(outcome, options.out, options.report, OUT)
    elif outcome.failed:
        report.print_failures(outcome, OUT)
    return FAILED if outcome.failed else 0


def _spec(options: argparse.Namespace) -> int:
    from lumitip_fab.config.load import load
    from lumitip_fab.derive import derive
    from lumitip_fab.docs import spec

    design = derive(load(options.file))
    rows, choices = spec.rows(design), spec.choice_rows(design)
    if options.out:
        from lumitip_fab.cli.built import built_rows

        rows += built_rows(options.out, design)
    if options.json:
        print(json.dumps([vars(row) for row in (*rows, *choices)], indent=1))
    else:
        spec.print_table(rows, OUT)
        spec.print_choices(choices, OUT)
    return 0


def _fix(options: argparse.Namespace) -> int:
    from lumitip_fab.cli.fix import fix

    plan = fix(options.file)
    changes = [step.remedies[0] for step in plan.steps]
    if options.json:
        print(json.dumps({"written": plan.complete and bool(changes),
                          "changes": [vars(change) for change in changes]}, indent=1))  # fmt: skip
    elif not plan.complete:
        print(f"{options.file}: not changed; no small changes were found that mend every fault",
              file=sys.stderr)  # fmt: skip
    elif not options.quiet:
        OUT.print(f"{options.file}: accepted as it is" if not changes else str(options.file))
        for change in changes:
            OUT.print(f"  {change}")
    return 0 if plan.complete else REFUSED


def _watch(options: argparse.Namespace) -> int:
    from lumitip_fab.cli.watch import watch

    watch(options.file, options.out, OUT)
    return 0


def _explore(options: argparse.Namespace) -> int:
    from lumitip_fab.explore import report
    from lumitip_fab.explore.accuracy import Sample
    from lumitip_fab.explore.run import explore

    columns = (TextColumn("designs"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    silent = options.quiet or options.json
    with Progress(*columns, console=ERR, disable=silent, transient=True) as bar:
        shown = bar.add_task("designs", total=None)

        def progress(done: int, total: int) -> None:
            bar.update(shown, completed=done, total=total)

        study = explore(
            options.file, options.vary, options.out, options.points, options.keep_size,
            Sample(seed=options.seed), options.scheduler, progress,
        )  # fmt: skip
    written = report.write(study, options.out)
    if options.json:
        print((options.out / "designs.json").read_text(encoding="utf-8"), end="")
    elif not options.quiet:
        report.print_table(study, OUT)
        OUT.print(f"{study.evaluated} of {len(study.designs)} designs evaluated now, the others "
                  "were known; wrote " + ", ".join(map(str, written)), soft_wrap=True)  # fmt: skip
    return 0


def _slice(options: argparse.Namespace) -> int:
    from lumitip_fab.checks import slicing as report
    from lumitip_fab.checks.slicing import slice_parts

    columns = (TextColumn("{task.description:<32}"), BarColumn(), MofNCompleteColumn())
    silent = options.quiet or options.json
    with Progress(*columns, console=ERR, disable=silent, transient=True) as bar:
        shown = bar.add_task("slicing", total=None)

        def progress(name: str, done: int, total: int) -> None:
            bar.update(shown, description=name, completed=done, total=total)

        parts = slice_parts(options.out, options.gcode, progress)
    if options.json:
        print(report.as_json(parts))
    elif not options.quiet:
        report.print_table(parts, OUT)
    return 0


def _channel_map(options: argparse.Namespace) -> int:
    from lumitip_fab.checks.channel_map import read_channels

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


def _schema(_: argparse.Namespace) -> int:
    from lumitip_fab.config.schema import schema_text

    print(schema_text(), end="")
    return 0


COMMANDS = {
    "init": _init,
    "build": _build,
    "check": _check,
    "fix": _fix,
    "spec": _spec,
    "channel-map": _channel_map,
    "watch": _watch,
    "explore": _explore,
    "slice": _slice,
    "schema": _schema,
}
