"""Tables and sentences of `lumitip-fab design`, of studies that are made here."""

import json
import re
from pathlib import Path
from types import SimpleNamespace

import pytest
from rich.console import Console

from goals_file import write_goals
from lumitip_fab.cli import main
from lumitip_fab.cli.design import print_study
from lumitip_fab.solve import files
from lumitip_fab.solve.folder import STUDY
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


def test_the_nearest_design_is_in_the_summary(
    task: Task, capsys: pytest.CaptureFixture[str]
) -> None:
    figures = FIGURES | {"cost": 55.0}
    near = Judged((("mask.hole_mm", 2.5),), (5, 4), figures, (), 0.1)
    far = Judged((("mask.hole_mm", 2.6),), (5, 4), FIGURES | {"cost": 75.0}, (), 0.5)
    found = Study(task, Options(), _search((far, near), far), ())
    assert summary(found)["nearest"] == {
        "changes": {"mask.hole_mm": 2.5},
        "columns": [5, 4],
        "figures": figures,
        "beyond": {"cost": 0.1},
    }
    assert "cost is 55, the limit 50" in _printed(found, capsys)


def test_the_most_frequent_reasons_come_first_with_their_counts(
    task: Task, capsys: pytest.CaptureFixture[str]
) -> None:
    reasons = (("zinc",), ("zinc", "f"), *((name,) for name in "edcba"))
    designs = tuple(Judged((), (), {}, texts, 10.0) for texts in reasons)
    found = Study(task, Options(), _search(designs, designs[0]), ())
    record = summary(found)
    assert re.fullmatch(r"\d+\.\d+\.\d+\S*, code [0-9a-f]{16}", record["made_with"]["lumitip"])
    assert {"numpy", "scipy", "pymoo"} < record["made_with"].keys()
    assert record["nearest"] is None
    assert record["refused"][0] == {"reason": "zinc", "designs": 2}
    assert [one["reason"] for one in record["refused"]] == ["zinc", *"fedcba"]
    text = _printed(found, capsys)
    assert "Every design is refused: zinc (2 of 7) f (1 of 7)" in text
    assert "and for 2 more reasons, which study.json has" in text


@pytest.mark.parametrize("option", ["--json", "--quiet"])
def test_a_silent_study_without_a_result_says_where_to_look(
    option: str,
    task: Task,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    refused = Judged((), (), {}, ("too wide",), 10.0)
    found = Study(task, Options(), _search((refused,), refused), ())
    monkeypatch.setattr("lumitip_fab.cli.design.study", lambda *_: found)
    monkeypatch.setattr(files, "_drawn", lambda _: {})
    command = ["design", str(tmp_path / "goals.toml"), "--out", str(tmp_path / "out"), option]
    assert main(command) == 1
    written = capsys.readouterr()
    assert f"every design is refused: see {tmp_path / 'out' / STUDY}" in written.err
    if option == "--json":
        assert json.loads(written.out)["refused"] == [{"reason": "too wide", "designs": 1}]
