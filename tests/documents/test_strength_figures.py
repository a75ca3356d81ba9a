"""The table of the fingers' strength in docs/making.md has what `check` measures on the published
design, as the page says."""

import re
from pathlib import Path

import pytest

from lumitip_fab.checks.result import Measurement
from lumitip_fab.checks.run import run_checks
from markdown_pages import ROOT

PAGE = ROOT / "docs" / "making.md"
_ROW = re.compile(r"^\| `(strength\.\w+)`[^|]*\| ([\d.]+)[^|]*\| ([^|]*) \|$", re.MULTILINE)


@pytest.fixture(scope="module")
def measured(outputs: Path) -> dict[str, Measurement]:
    """The weaker finger's measurements, by check."""
    found = run_checks(outputs, ["strength"]).measurements
    return {m.check: m for m in sorted(found, key=lambda m: -m.margin)}


def wrong(text: str, measured: dict[str, Measurement]) -> list[str]:
    """Rows of a page whose figure or limit is another than what was measured."""
    found = []
    for check, figure, limit in _ROW.findall(text):
        m, digits = measured[check], len(figure.partition(".")[2])
        limits = {f"{value:.4g}" for value in (m.low, m.high)}
        named = re.findall(r"\d+(?:\.\d+)?", limit.partition("(")[0])
        held = all(any(abs(float(n) - float(v)) < 0.006 for v in limits) for n in named)
        if f"{m.measured:.{digits}f}" != figure or not held:
            found.append(check)
    return found


@pytest.mark.slow
def test_the_table_has_what_is_measured(measured: dict[str, Measurement]) -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert len(_ROW.findall(text)) == 10
    assert wrong(text, measured) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("written", "other", "check"),
    [
        ("| 1.13 mm |", "| 1.17 mm |", "strength.bend"),
        ("| 0.2 % |", "| 0.3 % |", "strength.board"),
        ("times the load | 2.4 |", "times the load | 2.6 |", "strength.bolt_head"),
    ],
)
def test_another_figure_or_limit_is_found(
    written: str, other: str, check: str, measured: dict[str, Measurement]
) -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert text.count(written) == 1
    assert wrong(text.replace(written, other), measured) == [check]
