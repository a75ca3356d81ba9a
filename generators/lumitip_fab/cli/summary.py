"""The end of a run in about ten lines: files, checks, tightest margins, failures with the
parameters to change, rated force, price."""

import csv
import io
from collections.abc import Iterable, Iterator
from pathlib import Path

from rich.console import Console
from rich.text import Text

from lumitip_fab.checks.result import Measurement, relative_margin
from lumitip_fab.checks.run import Outcome
from lumitip_fab.cli.report import figure, tightness
from lumitip_fab.design.encoding import read_design
from lumitip_fab.errors import OutputError
from lumitip_fab.paths import read_plain
from lumitip_fab.text import table_of

TABLES = "cli/summary.toml"


def tightest(
    measurements: Iterable[Measurement], count: int
) -> tuple[tuple[float, Measurement], ...]:
    """The smallest relative margins with their measurements, at most one of each check; without
    what failed and what is drawn at its limit on purpose."""
    least: dict[str, tuple[float, Measurement]] = {}
    for m in measurements:
        share = relative_margin(m)
        if share is None or not m.passed or m.check in table_of(TABLES)["drawn_at_the_limit"]:
            continue
        if m.check not in least or share < least[m.check][0]:
            least[m.check] = (share, m)
    return tuple(sorted(least.values(), key=lambda pair: pair[0])[:count])


def parameters_of(check: str) -> tuple[str, ...]:
    """The fields to change when a check fails; empty if no single one decides it."""
    return tuple(table_of(TABLES)["parameters"].get(check, ()))


TIGHTEST = 5
MOST_FAILURES = 10
MANUAL, BILL, ORDER = "manual/manual.html", "bom.csv", "order.csv"


def print_summary(outcome: Outcome, out: Path, report: Path | None, console: Console) -> None:
    """Print what is in an output folder and how it stands.

    Args:
        outcome: what was measured.
        out: the output folder.
        report: the JSON file with every measurement, if one was written.
        console: where to print.
    """
    failed = {m.check for m in outcome.failed}
    console.print(_contents(out), soft_wrap=True)
    counted = f"{len(outcome.names) - len(failed)} checks passed"
    if failed:
        _print(console, f"{counted}, {len(failed)} FAILED", "bold red")
    else:
        _print(console, counted, "bold green")
    for line, style in _failures(outcome):
        _print(console, line, style)
    _print(console, "tightest margins, as a share of the limit or of half the tolerance:")
    for share, m in tightest(outcome.measurements, TIGHTEST):
        at_least_0 = max(share, 0.0)  # rounding may put what is at its limit a hair beyond
        _print(console, f"{100 * at_least_0:6.1f} %  {_described(m)}")
    for line in _force(out):
        console.print(line, soft_wrap=True)
    console.print(_price(out), soft_wrap=True)
    manual = out / MANUAL
    look = [f"{manual} (how to build it)"] if manual.is_file() else []
    look.append(f"{report} (every measurement)" if report else "check --verbose (all figures)")
    console.print(f"look at: {', '.join(look)}", soft_wrap=True)


def _contents(out: Path) -> str:
    files = [f for f in out.rglob("*") if f.is_file() and not f.name.startswith(".")]
    size_mb = sum(f.stat().st_size for f in files) * 1e-6
    folders = len({f.parent for f in files})
    return f"{out}: {len(files)} files in {folders} folders, {size_mb:.1f} MB"


def _failures(outcome: Outcome) -> Iterator[tuple[str, str]]:
    """Lines with their styles: the worst failure of each check, and the parameters that decide
    it."""
    by_check: dict[str, list[Measurement]] = {}
    for m in outcome.failed:
        by_check.setdefault(m.check, []).append(m)
    for check, failed in list(by_check.items())[:MOST_FAILURES]:
        worst = min(failed, key=tightness)
        more = f" and {len(failed) - 1} more" if len(failed) > 1 else ""
        yield f"  FAIL  {_described(worst)}{more}", "red"
        if worst.note:
            yield f"        {worst.note}", ""
        if parameters_of(check):
            yield f"        change {' or '.join(parameters_of(check))}", ""
    if len(by_check) > MOST_FAILURES:
        yield f"  and {len(by_check) - MOST_FAILURES} more checks: check --verbose", "red"
    if not all(parameters_of(check) for check in by_check):
        yield "  no parameter named: a file was altered, or it is a fault of Lumitip", ""


def _described(m: Measurement) -> str:
    unit = f" {m.unit}" if m.unit else ""
    return f"{m.check}  {figure(m.measured)}{unit}, {m.limit}  {m.subject}"


def _force(out: Path) -> Iterator[str]:
    """What the fingers bear, which a gripper may exceed; nothing where no design can be read."""
    try:
        limit = read_design(out / "design.json").strength
    except OutputError:
        return
    yield f"rated force: {limit.rating}"


def _price(out: Path) -> str:
    """What a pair uses and what is bought for it in whole packs, with the date and trust of the
    prices."""
    totals = []
    for name in (BILL, ORDER):
        try:
            file = io.StringIO(read_plain(out / name).decode(), newline="")
            *_, last = csv.DictReader(file)
            totals.append((float(last["price"]), last.get("for", "")))
        except (OSError, ValueError, TypeError, KeyError, csv.Error):
            return f"price: {out / name} has no total"
    (used, note), (bought, _) = totals
    stated, _, _ = note.partition(":")
    currency, _, trust = stated.partition(", ")
    return (
        f"price: {used:.2f} {currency} ({trust}), {bought:.2f} {currency} in whole packs; "
        f"{out / BILL}, {out / ORDER}"
    )


def _print(console: Console, line: str, style: str = "") -> None:
    """One line, cut at the edge of a terminal."""
    console.print(Text(line, style=style), no_wrap=True, overflow="ellipsis")
