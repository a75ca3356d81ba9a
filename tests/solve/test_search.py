"""Searches: the front, going on after a stop, the same result again, and the files of a study."""

import csv
import json
import re
import shutil
import sys
from pathlib import Path

import pytest

from goals_file import write_goals
from lumitip_fab import derived, load
from lumitip_fab.cli import main
from lumitip_fab.solve.goals import Task, read_goals
from lumitip_fab.solve.judge import FIGURES
from lumitip_fab.solve.search import Search, search

pytestmark = pytest.mark.slow

GOALS = """\
[goals]
edge_mm = 0.12
gaps_mm = [3.0]
cables_mm = [3.0]
[limits]
{limits}
[vary]
mask.hole_mm = {{ from = 2.0, to = {to}, step = 0.25 }}
{vary}
"""


def written(tmp_path: Path, limits: str, to: float, vary: str) -> Path:
    return write_goals(tmp_path, GOALS, limits=limits, to=to, vary=vary)


def searched(task: Task, out: Path, designs: int) -> Search:
    return search(task, out, designs, 0, None, lambda *_: None)


def test_few_of_many_designs_find_the_best_of_all(tmp_path: Path) -> None:
    vary = "emitter.current_ma = [4.0, 8.0, 19.2]"
    file = written(tmp_path, "current_ma = 39.0", 5.0, vary)
    file.write_text(file.read_text().replace("[vary]", '[fixed]\nemitter.drive = "source"\n[vary]'))
    task = read_goals(file)
    every = searched(task, tmp_path / "all", task.designs)
    few = searched(task, tmp_path / "few", 20)
    assert (every.complete, few.complete) == (True, False)
    assert len(every.designs) == task.designs == 39
    assert 20 <= len(few.designs) < 32
    least = every.front[0].figures["error"]
    assert few.front[0].figures["error"] <= 1.02 * least
    assert least < 0.85 * every.base.figures["error"]
    # The front: less error costs current; nobody on it is beaten by any design.
    currents = [one.figures["current_ma"] for one in every.front]
    assert currents == sorted(currents, reverse=True)
    for own in every.front:
        for other in every.designs:
            better = other.allowed and other.objectives != own.objectives
            assert not (
                better
                and all(a <= b for a, b in zip(other.objectives, own.objectives, strict=True))
            )
    # The same search again judges nothing and finds the same.
    again = searched(task, tmp_path / "few", 20)
    assert again.evaluated == 0
    assert again.designs == few.designs


def test_limits_hold_and_refused_designs_have_their_reasons(tmp_path: Path) -> None:
    vary = 'grid.pitch_mm = [3.0, 6.0]\ngrid.columns = "keep_size"'
    task = read_goals(written(tmp_path, "cells = 40", 3.0, vary))
    found = searched(task, tmp_path / "out", task.designs)
    refused = [one for one in found.designs if one.refused]
    assert refused
    assert all("mask.hole_mm" in " ".join(one.refused) for one in refused)
    dense = [one for one in found.designs if dict(one.changes)["grid.pitch_mm"] == 3.0]
    assert not any(one.allowed for one in dense)
    assert all(one.excess > 0 for one in dense)
    assert {one.figures["cells"] for one in found.front} == {32.0}


def test_a_study_is_written_and_its_points_are_parameter_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = written(tmp_path, "cost = 60.0", 2.75, "")
    command = ["design", str(file), "--points", "1", "--out"]
    assert main([*command, str(tmp_path / "a")]) == 0
    printed = capsys.readouterr().out
    # The second run goes on from the journal of the first, and writes the same bytes.
    (tmp_path / "b").mkdir()
    shutil.copy(tmp_path / "a/evaluated.jsonl", tmp_path / "b")
    assert main([*command, str(tmp_path / "b"), "--quiet"]) == 0
    names = {f.name for f in (tmp_path / "a").iterdir()}
    pictures = {f"{name}.{kind}" for name in ("front", "directions") for kind in ("svg", "png")}
    assert names == pictures | {"evaluated.jsonl", "front.csv", "point-1.toml", "study.json"}
    for name in names - {"evaluated.jsonl"}:
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes(), name
    study = json.loads((tmp_path / "a/study.json").read_text())
    base, best = study["points"]
    assert study["complete"]
    assert (study["designs"], study["judged"]) == (4, 4)
    assert best["figures"]["error"] < base["figures"]["error"]
    assert {(t["kind"], t["gap_mm"]) for t in best["tried"]} == {("edge", 3.0), ("cable", 3.0)}
    # The file of the point is the design that was judged, with what the base left to the program.
    point = load(tmp_path / "a/point-1.toml")
    for field, value in best["changes"].items():
        assert point.value(field) == value
    assert "emitter.led" in point.automatic
    layout = derived(tmp_path / "a/point-1.toml").layout
    assert layout.optics.hole_mm == best["changes"]["mask.hole_mm"]
    rows = list(csv.DictReader((tmp_path / "a/front.csv").read_text().splitlines()))
    assert {name: float(rows[0][name]) for name in FIGURES} == best["figures"]
    for point in study["points"]:
        errors = point["confirmed"]
        good = errors["edge_mm"] <= 0.12 and errors["gross_percent"] <= 1.0
        assert point["confirmed_meets_goals"] is good
    met = [point["name"] for point in study["points"] if point["confirmed_meets_goals"]]
    words = " ".join(printed.split())
    assert (
        f"the estimator keeps the goals with {', '.join(met) or 'none of these designs'}." in words
    )
    assert "point-1" in printed
    assert "4 designs judged (all)" in printed


def test_limits_that_no_design_keeps_are_an_answer(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = written(tmp_path, "cost = 20.0", 2.25, "")
    assert main(["design", str(file), "--out", str(tmp_path / "out")]) == 1
    printed = " ".join(capsys.readouterr().out.split())
    assert "No design keeps all limits" in printed
    assert re.search(r"cost is 50\.\d+, the limit 20\. Relax limits, or vary more", printed)
    assert not list((tmp_path / "out").glob("point-*.toml"))


def test_designs_that_are_all_refused_are_an_answer(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = written(tmp_path, "cost = 60.0", 2.25, "")
    text = file.read_text().replace(
        "from = 2.0, to = 2.25, step = 0.25", "from = 5.9, to = 6.0, step = 0.1"
    )
    file.write_text(text)
    assert main(["design", str(file), "--out", str(tmp_path / "out")]) == 1
    printed = " ".join(capsys.readouterr().out.split())
    assert "Every design is refused: mask.hole_mm is 5.9" in printed
    assert not list((tmp_path / "out").glob("point-*.toml"))


def test_numbers_out_of_range_are_all_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["design", "absent.toml", "--out", str(tmp_path / "out"), "--designs", "2"]
    assert main([*command, "--points", "0"]) == 2
    errors = capsys.readouterr().err
    assert "--designs: is 2; 8 to 100000 is allowed" in errors
    assert "--points: is 0; 1 to 50 is allowed" in errors
    assert not (tmp_path / "out").exists()


def test_a_search_without_pymoo_says_what_to_install(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setitem(sys.modules, "pymoo.core.evaluator", None)
    file = written(tmp_path, "cost = 60.0", 5.0, "")
    assert main(["design", str(file), "--out", str(tmp_path / "out"), "--designs", "8"]) != 0
    assert "the search needs pymoo" in capsys.readouterr().err
