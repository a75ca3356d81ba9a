"""The table of all measurements, with what failed last."""

import io
import math

import pytest
from rich.console import Console

from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.checks.run import Outcome
from lumitip_fab.cli import report

SOUND = (
    Measurement("mask.web", "a.pdf", 0.9, 0.4, math.inf, "mm"),
    Measurement("mask.web", "b.pdf", 0.5, 0.4, math.inf, "mm"),
    Measurement("mask.web", "c.pdf", 3.0, 3.0, 3.0, "openings"),
    Measurement("mould.draft", "m.stl", 2.0, 1.0, math.inf, "°"),
)
BROKEN = (
    Measurement("mask.web", "d.pdf", 0.1, 0.4, math.inf, "mm"),
    Measurement("mask.web", "e.pdf", 0.2, 0.4, math.inf, "mm"),
    unreadable("mask.page", "f.pdf", "no such file"),
)


def told(show, *measurements: Measurement) -> list[str]:
    file = io.StringIO()
    show(Outcome(measurements), Console(file=file, width=200, highlight=False))
    return [line.rstrip() for line in file.getvalue().splitlines()]


def test_a_line_has_figure_limit_and_margin_and_groups_are_apart() -> None:
    lines = told(report.print_measurements, *SOUND)
    assert lines[3].split() == ["ok", "mask.web", "0.5", "mm", "≥", "0.4", "0.1", "b.pdf"]
    assert not lines[5], "between what is of the mask and what is of the mould"
    assert lines[6].split()[:2] == ["ok", "mould.draft"]
    assert lines[-1] == "4 measurements of 2 checks: all within their limits"


def test_what_is_exact_is_shown_with_its_value() -> None:
    lines = told(report.print_measurements, SOUND[2])
    assert lines[2].split() == ["ok", "mask.web", "3", "openings", "=", "3", "0", "c.pdf"]


def test_failures_come_last_and_whole() -> None:
    lines = told(report.print_measurements, *SOUND, *BROKEN)
    start = next(i for i, line in enumerate(lines) if "3 FAILED" in line)
    assert [line.split()[-1] for line in lines[start + 3 : -2]] == ["d.pdf", "e.pdf"]
    assert "no such file" in lines[-2]
    assert lines[-1] == "7 measurements of 3 checks: 3 FAILED"


@pytest.mark.parametrize("measurements", [SOUND, (*SOUND, *BROKEN)])
def test_all_of_them_are_told_where_asked(measurements: tuple[Measurement, ...]) -> None:
    lines = told(report.print_measurements, *measurements)
    for m in measurements:
        assert any(m.check in line and m.subject in line for line in lines)


def test_quietly_only_failures_are_told() -> None:
    lines = told(report.print_failures, *SOUND, *BROKEN)
    assert not any(" a.pdf" in line or "mould" in line for line in lines)
    assert sum(line.startswith("FAIL") for line in lines) == len(BROKEN)
