"""How the checks are told: a table for people, JUnit for machines."""

import math
from xml.etree import ElementTree

from rich.console import Console
from rich.table import Table
from rich.text import Text

from lumitip_fab.checks.result import Measurement
from lumitip_fab.checks.run import Outcome


def print_table(outcome: Outcome, console: Console, failed_only: bool = False) -> None:
    """Every measurement with its limit and margin, and a line that counts them."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    for heading, options in (
        ("", {}),
        ("check", {"no_wrap": True}),
        ("file", {"overflow": "fold"}),
        ("measured", {"justify": "right", "no_wrap": True}),
        ("limit", {"no_wrap": True}),
        ("margin", {"justify": "right", "no_wrap": True}),
        ("note", {"overflow": "fold", "style": "dim"}),
    ):
        table.add_column(heading, **options)
    for m in outcome.measurements:
        if failed_only and m.passed:
            continue
        mark = Text("ok", style="green") if m.passed else Text("FAIL", style="bold red")
        unit = f" {m.unit}" if m.unit else ""
        limit = "" if m.limit == "any" else m.limit
        cells = (m.check, m.subject, f"{_figure(m.measured)}{unit}", limit, _figure(m.margin))
        table.add_row(mark, *(Text(c) for c in cells), Text(m.note))
    console.print(table)
    console.print(summary(outcome))


def summary(outcome: Outcome) -> str:
    """One line that counts what was measured."""
    failed = len(outcome.failed)
    told = f"{len(outcome.measurements)} measurements of {len(outcome.names)} checks"
    return f"{told}: {f'{failed} FAILED' if failed else 'all within their limits'}"


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
    told = f"measured {_figure(m.measured)} {m.unit}, limit {m.limit}, margin {_figure(m.margin)}"
    return f"{told}; {m.note}" if m.note else told


def _figure(value: float) -> str:
    if math.isnan(value):
        return "none"
    return "" if math.isinf(value) else f"{value:.4g}"
