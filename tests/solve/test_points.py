"""`lumitip-fab design --build`: the points of a front are built, and each passes every check."""

import json
from pathlib import Path

import pytest

from goals_file import write_goals
from lumitip_fab import derived
from lumitip_fab.checks.run import run_checks
from lumitip_fab.cli import main

GOALS = """\
[goals]
edge_mm = 0.2
cables_mm = []
[fixed]
coupling.gripper = "wsg50"
supply.voltage_v = 12.0
grid.columns = [3, 2, 3]
[vary]
mask.hole_mm = [2.5, 4.4]
emitter.current_ma = [12.8, 19.2]
"""


@pytest.mark.slow
def test_points_are_built_and_pass_every_check(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, out = write_goals(tmp_path, GOALS), tmp_path / "out"
    assert main(["design", str(file), "--out", str(out), "--points", "2", "--build"]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    points = json.loads((out / "study.json").read_text())["points"]
    assert [point["name"] for point in points] == ["base", "point-1", "point-2"]
    for point in points[1:]:
        folder = out / point["name"]
        assert f"{folder}: built, passes" in printed
        assert not run_checks(folder).failed
        design = derived(folder / "resolved.toml")
        assert design.layout.optics.hole_mm == point["changes"]["mask.hole_mm"]
        assert sum(design.wiring.current_ma) == pytest.approx(
            point["figures"]["current_ma"], rel=1e-4
        )
