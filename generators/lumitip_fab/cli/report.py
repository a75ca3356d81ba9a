"""All measurements: a table for people, JUnit for machines."""

import math
from typing import Any
from xml.etree import ElementTree

from rich.box import Box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from lumitip_fab.checks.result import Measurement
from lumitip_fab.checks.run import Outcome

_NOTHING = 1e-9  # what rounding leaves of a difference
SECTIONS = Box("    \n" * 8)
"""A table without lines, but with an empty one between its sections."""


_COLUMNS: tuple[tuple[str, dict[str, Any]], ...] = (
    ("", {}),
    ("check", {"no_wrap": True}),
    ("measured", {"justify": "right", "no_wrap": True}),
    ("limit", {"no_wrap": True}),
    ("margin", {"justify": "right", "no_wrap": True}),
    ("file", {"overflow": "fold"}),
    ("note", {"overflow": "fold", "style": "dim"}),
)


def print_measurements(outcome: Outcome, console: Console) -> None:
    """Every measurement with its limit and margin, by what it is of; then as `print_failures`."""
    table, group = _table(), ""
    for m in outcome.measurements:
        if group != (group := m.check.partition(".")[0]):
            table.add_section()
        _row(table, m)
    console.print(table)
    print_failures(outcome, console)


def print_failures(outcome: Outcome, console: Console) -> None:
    """Every measurement that failed, if any did, and a line that counts them."""
    if outcome.failed:
        console.rule(Text(f"{len(outcome.failed)} FAILED", style="bold red"), style="red")
        table = _table()
        for m in outcome.failed:
            _row(table, m)
        console.print(table)
    console.print(summary(outcome), style="bold red" if outcome.failed else "bold green")


def _table() -> Table:
    table = Table(box=SECTIONS, pad_edge=False, header_style="bold", show_edge=False)
    for heading, options in _COLUMNS:
        table.add_column(heading, **options)
    return table


def _row(table: Table, m: Measurement) -> None:
    mark = Text("ok", style="green") if m.passed else Text("FAIL", style="bold red")
    unit = f" {m.unit}" if m.unit else ""
    limit = "" if m.limit == "any" else m.limit
    cells = (m.check, f"{figure(m.measured)}{unit}", limit, figure(m.margin), m.subject)
    table.add_row(mark, *(Text(c) for c in cells), Text(m.note))


def tightness(m: Measurement) -> tuple[bool, bool, float]:
    """Sort key: failed measurements first, then by margin; exact counts last."""
    margin = -math.inf if math.isnan(m.margin) else m.margin
    return m.passed, m.low == m.high, margin


def summary(outcome: Outcome) -> str:
    """One line that counts what was measured."""
    failed = len(outcome.failed)
    counts = f"{len(outcome.measurements)} measurements of {len(outcome.names)} checks"
    return f"{counts}: {f'{failed} FAILED' if failed else 'all within their limits'}"


def junit(outcome: Outcome) -> bytes:
    """The measurements as a JUnit file, a test case each."""
    suite = ElementTree.Element(
        "testsuite",
        name="lumitip-fab check",
        tests=str(len(outcome.measurements)),
        failures=str(len(outcome.failed)),
    )
    for m in outcome.measurements:
        case = ElementTree.SubElement(suite, "testcase", classname=m.check, name=m.subject)
        if not m.passed:
            ElementTree.SubElement(case, "failure", message=_sentence(m))
        ElementTree.SubElement(case, "system-out").text = _sentence(m)
    ElementTree.indent(suite)
    text: str = ElementTree.tostring(suite, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'.encode()


def _sentence(m: Measurement) -> str:
    text = f"measured {figure(m.measured)} {m.unit}, limit {m.limit}, margin {figure(m.margin)}"
    return f"{text}; {m.note}" if m.note else text


def figure(value: float) -> str:
    """A figure with four digits; none if it could not be measured, empty if it has no bound."""
    if math.isnan(value):
        return "none"
    if math.isinf(value):
        return ""
    return f"{value:.4g}" if abs(value) >= _NOTHING else "0"
