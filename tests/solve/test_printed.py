"""Tables and sentences of `lumitip-fab design`, of studies that are made here."""

from pathlib import Path
from types import SimpleNamespace

import pytest
from rich.console import Console

from goals_file import write_goals
from lumitip_fab.cli.design import print_study
from lumitip_fab.solve.goals import Task, read_goals
from lumitip_fab.solve.judge import Reference
from lumitip_fab.solve.judged import Judged
from lumitip_fab.solve.search import Search
from lumitip_fab.solve.study import Options, Point, Study, summary

GOALS = """\
[goals]
edge_mm = 0.2
[limits]
cost = 50.0
[vary]
mask.hole_mm = [2.4, 2.5, 2.6]
"""
FIGURES = {"error": 0.9, "edge_mm": 0.18, "cost": 45.0, "current_ma": 40.0}


@pytest.fixture
def task(tmp_path: Path) -> Task:
    return read_goals(write_goals(tmp_path, GOALS))


def _printed(found: Study, capsys: pytest.CaptureFixture[str]) -> str:
    print_study(found, Console(width=200, markup=False))
    return " ".join(capsys.readouterr().out.split())


def _search(designs: tuple[Judged, ...], base: Judged) -> Search:
    return Search(base, designs, True, 0, Reference(1.0, False))


def _point(name: str, judged: Judged, edge_mm: float, gross_percent: float) -> Point:
    confirmed = {"edge_mm": edge_mm, "gross_percent": gross_percent}
    return Point(name, judged, confirmed, (), SimpleNamespace())  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("excess", "edge_mm", "gross_percent", "met"),
    [
        (0.0, 0.15, 0.4, True),
        (0.2, 0.15, 0.4, False),  # dearer than the limit
        (0.0, 0.15, 1.2, False),
        (0.0, 0.25, 0.0, False),
    ],
)
def test_goals_are_met_within_limits_and_with_few_gross_errors(
    excess: float,
    edge_mm: float,
    gross_percent: float,
    met: bool,
    task: Task,
    capsys: pytest.CaptureFixture[str],
) -> None:
    base = Judged((), (), FIGURES, (), excess)
    best = Judged((("mask.hole_mm", 2.6),), (), FIGURES, (), 0.0)
    points = (_point("base", base, edge_mm, gross_percent), _point("point-1", best, 0.3, 0.0))
    found = Study(task, Options(), _search((best,), base), points)
    text = _printed(found, capsys)
    listed = "base" if met else "none of these designs"
    assert "Within all limits, and with gross errors in at most 1 % of its poses" in text
    assert f"the estimator keeps the goals with {listed}." in text
    assert "gross %" in text and f"│ {gross_percent:.1f} │" in text
    assert [p["confirmed_meets_goals"] for p in summary(found)["points"]] == [met, False]
