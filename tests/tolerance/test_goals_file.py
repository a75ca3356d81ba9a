"""Yield against the goals of a goals file: its gaps and cables, and what does not fit together."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from lumitip.twin import Model
from lumitip_fab.cli import main
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.auto.resolve import Resolved
from lumitip_fab.derive.making.tolerances import spreads
from lumitip_fab.tolerance.bench import COLUMNS, Case, bench, errors_over
from lumitip_fab.tolerance.draws import draw
from lumitip_fab.tolerance.options import Goals
from lumitip_fab.tolerance.yields import good, worst_of

FEW = ("--fingers", "16", "--poses", "4")
GOALS = """base = "{base}"
[goals]
edge_mm = {edge_mm}
{cable}
gaps_mm = [2.0, 4.0]
[vary]
mask.hole_mm = {{ from = 2.0, to = 5.0, step = 0.1 }}
"""
CABLES = "cable_mm = 0.9\ncables_mm = [2.0, 4.0]"


def goals_file(folder: Path, design_dir: Path, edge_mm: float = 0.9, cable: str = CABLES) -> Path:
    file = folder / "goals.toml"
    base = design_dir / "fingertip.toml"
    file.write_text(GOALS.format(base=base, edge_mm=edge_mm, cable=cable), encoding="utf-8")
    return file


@pytest.mark.slow
def test_a_study_tries_the_gaps_and_cables_of_a_goals_file(
    design_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, goals = str(design_dir / "fingertip.toml"), goals_file(tmp_path, design_dir, 0.8)
    out = tmp_path / "out"
    assert main(["tolerance", file, "--goals", str(goals), "--out", str(out), *FEW]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "gap 2 mm: 4 edges, 4 cables of 2 mm; gap 4 mm: 4 edges, 4 cables of 2, 4 mm" in printed
    assert "Good: rms errors of 0.8 mm (edges), 0.9 mm (cables) or less, and" in printed
    found = json.loads((out / "tolerance.json").read_text(encoding="utf-8"))
    assert found["goals"] == {"edge_mm": 0.8, "cable_mm": 0.9}
    assert [grasp["gap_mm"] for grasp in found["grasps"]] == [2.0, 4.0]
    assert "fingerprint" not in found, "no manual quotes the shift for these goals"
    assert found["pose_estimator"]["frames"] == 10 * 4 * (2 + 3)


@pytest.mark.slow
def test_a_dim_design_is_tried_with_its_exposure(
    design_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Noise is a larger share of less light."""
    design = derive(load(design_dir / "fingertip.toml"))
    current_ma, ohm = float(design.wiring.current_ma[0]), design.layout.optics.pull_up_ohm
    dim = Path(shutil.copytree(design_dir, tmp_path / "design")) / "dim.toml"
    goals, errors_mm = goals_file(tmp_path, design_dir), {}
    for share in (1.0, 0.25):
        text = f'extends = "fingertip.toml"\n[emitter]\ncurrent_ma = {share * current_ma:.3f}\n'
        dim.write_text(f"{text}[receiver]\npull_up_ohm = {ohm:g}\n", encoding="utf-8")
        command = ["tolerance", str(dim), "--goals", str(goals), "--out", str(tmp_path), *FEW]
        assert main(command) == 0
        printed = " ".join(capsys.readouterr().out.split())
        assert f"LED current times pull-up is {share:.2f} times that of the base" in printed
        assert ("noise counts 4.0 times as much" in printed) == (share == 0.25)
        found = json.loads((tmp_path / "tolerance.json").read_text(encoding="utf-8"))
        assert found["exposure"] == pytest.approx(share, abs=0.01)
        errors_mm[share] = found["columns"]["after self-calibration"]["edge_mm"]["50"]
    assert errors_mm[0.25] > errors_mm[1.0]


@pytest.mark.slow
def test_cables_without_a_goal_are_not_tried(
    design_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, goals = str(design_dir / "fingertip.toml"), goals_file(tmp_path, design_dir, cable="")
    assert main(["tolerance", file, "--goals", str(goals), "--out", str(tmp_path), *FEW]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "not tried" in printed
    assert "rms errors of 0.9 mm (edges) or less" in printed
    text = (tmp_path / "tolerance.json").read_text(encoding="utf-8")
    column = json.loads(text)["columns"]["after tare"]
    assert "cable_mm" not in column
    assert column["yield"] > 0.5
    assert "NaN" not in text


@pytest.mark.slow
def test_errors_are_those_over_the_poses_of_all_grasps(design: Resolved) -> None:
    layout, columns = design.design.layout, COLUMNS[1:2]
    models = [Model.from_layout(layout, gap_mm) for gap_mm in (2.0, 5.0)]
    thin, thick = (
        Case(layout, model, 4, 0, cables_mm=cables)
        for model, cables in zip(models, ((2.0,), (2.0, 5.0)), strict=True)
    )
    drawn = draw(design.config.catalogue.tolerances, spreads(design.config), len(layout), 6, 0)
    of_thin, of_thick = (bench(case, 3).errors(drawn, columns)[0] for case in (thin, thick))
    found = errors_over((thin, thick), 3, drawn, columns)[0]
    assert found[:, 0] == pytest.approx(np.sqrt((of_thin[:, 0] ** 2 + of_thick[:, 0] ** 2) / 2.0))
    cables = np.sqrt((of_thin[:, 2] ** 2 + 2.0 * of_thick[:, 2] ** 2) / 3.0)
    assert found[:, 2] == pytest.approx(cables)
    assert found[:, 4] == pytest.approx((2.0 * of_thin[:, 4] + 3.0 * of_thick[:, 4]) / 5.0)
    assert (of_thin[:, 2] != of_thick[:, 2]).all()


@pytest.mark.slow
@pytest.mark.parametrize("diameter_mm", [2.0, 4.0, 6.0])
def test_a_cable_of_any_diameter_is_found_on_a_finger_that_is_built_as_drawn(
    diameter_mm: float, design: Resolved
) -> None:
    """The estimator expects this diameter, as that of a search does."""
    layout = design.design.layout
    drawn = draw(design.config.catalogue.tolerances, spreads(design.config), len(layout), 1, 0)
    exact = {name: 0.0 * of for name, of in drawn.items()}
    model = Model.from_layout(layout, diameter_mm)
    found = bench(Case(layout, model, 12, 0, cables_mm=(diameter_mm,))).errors(exact)
    assert found[1, 0, 2] < 0.08
    assert found[1, 0, 4] == 0.0


@pytest.mark.slow
def test_edges_without_a_goal_are_not_tried(
    design_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, goals = str(design_dir / "fingertip.toml"), goals_file(tmp_path, design_dir)
    text = goals.read_text(encoding="utf-8").replace("edge_mm = 0.9\n", "")
    goals.write_text(text.replace("[2.0, 4.0]", "[4.0]", 1), encoding="utf-8")
    assert main(["tolerance", file, "--goals", str(goals), "--out", str(tmp_path), *FEW]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "gap 4 mm: 4 cables of 4 mm" in printed
    assert "rms errors of 0.9 mm (cables) or less" in printed
    found = json.loads((tmp_path / "tolerance.json").read_text(encoding="utf-8"))
    assert [grasp["gap_mm"] for grasp in found["grasps"]] == [4.0], "no cable fits into 2 mm"
    assert "edge_mm" not in found["columns"]["after tare"]


def test_errors_count_in_units_of_their_goals() -> None:
    rows = np.array([[0.1, 1.0, 0.3, 4.0, 0.0]])
    inf = np.inf
    assert worst_of(rows, Goals(0.1, 1.0, 0.6, 2.0)) == pytest.approx(np.array([[1.0, 2.0]]))
    assert worst_of(rows, Goals(inf, inf, 0.6, inf)) == pytest.approx(np.array([[0.5, 4.0]]))


def test_each_error_has_its_own_goal() -> None:
    rows = np.array([[0.1, 1.0, 0.3, 2.0, 0.0], [0.3, 1.0, 0.1, 2.0, 0.0]])
    inf = np.inf
    assert good(rows, Goals(0.2, inf, 0.4, inf)).tolist() == [True, False]
    assert good(rows, Goals(inf, inf, 0.2, inf)).tolist() == [False, True]
    assert good(rows, Goals(inf, inf, inf, 1.5)).tolist() == [False, False]


def test_goals_in_a_file_and_in_options_are_rejected(
    design_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, goals = str(design_dir / "fingertip.toml"), goals_file(tmp_path, design_dir)
    assert main(["tolerance", file, "--goals", str(goals), "--gap", "4", "--angle", "2"]) == 2
    lines = capsys.readouterr().err.strip().splitlines()
    assert [line.split(":")[0] for line in lines] == ["--angle", "--gap"]
    for line in lines:
        assert line.endswith("--goals allows no other goal or gap. Remove one of them.")


def test_a_goal_below_what_can_be_counted_is_rejected_with_its_file(
    design_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, goals = str(design_dir / "fingertip.toml"), goals_file(tmp_path, design_dir, 0.001)
    assert main(["tolerance", file, "--goals", str(goals)]) == 2
    text = capsys.readouterr().err.strip()
    assert text.endswith("goals.toml: goals.edge_mm is 0.001 mm; 0.01 to 1 is allowed")
