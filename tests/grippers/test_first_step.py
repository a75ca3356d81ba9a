"""Before the answers: gauge and notes of the first step, and the options that name features."""

import json
from pathlib import Path
from typing import Any

import pytest
import trimesh
from build123d import Shape

from fingertip_shapes import block, bolts, face_at, plain
from lumitip_fab.cli import main
from lumitip_fab.parts.export import step


def begun(shape: Shape, folder: Path, *options: str) -> list[str]:
    """The first step's command for a fingertip."""
    file = folder / "tip.step"
    file.write_bytes(step(shape, "tip"))
    out = ["--from-step", str(file), "--out", str(folder / "out"), "--replace"]
    return ["gripper", "new", "jaw", *out, *options]


@pytest.mark.slow
def test_a_gauge_is_written_once_its_figures_are_certain(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tip, gauge = block(*bolts(-7, 7)), tmp_path / "out/jaw_gauge.stl"
    assert main(begun(tip, tmp_path)) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "No gauge is written: bolt_w_mm, pad_w_mm must be known first." in printed
    assert not gauge.exists()
    assert 'pad_w_mm = "?"' in (tmp_path / "out/jaw.toml").read_text(encoding="utf-8")
    assert main(begun(tip, tmp_path, "--pad", str(face_at(tip, -8.0)))) == 0
    assert "No gauge" not in capsys.readouterr().out
    assert trimesh.load(gauge).bounds[:, 0] == pytest.approx([-12.0, 12.0], abs=0.01)
    assert main(begun(tip, tmp_path)) == 0
    assert not gauge.exists(), "it was of figures that are open again"


@pytest.mark.slow
def test_a_gauge_that_cannot_be_made_says_why(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tip = block(*bolts(-7.5, 7.5))
    assert main(begun(tip, tmp_path, "--pad", str(face_at(tip, -8.0)), "--json")) == 0
    notes = json.loads(capsys.readouterr().out)["notes"]
    assert len(notes) == 1
    assert notes[0].startswith("No gauge is written: with the finger of ")
    assert "block has 0.50 mm of wall beside its counterbores" in notes[0]


def test_the_gauge_of_the_first_step_is_that_of_the_named_finger(
    design_dir: Path, tmp_path: Path
) -> None:
    gauges = []
    for number, file in enumerate(([], ["--file", str(design_dir / "presets/flex.toml")])):
        out = tmp_path / str(number)
        like = ["gripper", "new", "jaw", "--like", "two_hole_jaw", "--out", str(out), "--quiet"]
        assert main([*like, *file]) == 0
        gauges.append((out / "jaw_gauge.stl").read_bytes())
    assert gauges[0] != gauges[1]


def test_options_that_name_features_need_numbers_and_a_step_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["gripper", "new", "jaw", "--pad", "1", "--out", str(tmp_path / "out")]) == 2
    assert "--pad: needs --from-step" in capsys.readouterr().err
    for option, value in (("--bolts", "1;2"), ("--bolts", "0"), ("--mount", "1,2"), ("--pad", "x")):
        assert main(begun(block(*plain(-7, 7)), tmp_path, option, value)) == 2
        printed: Any = capsys.readouterr().err
        assert f"{option} is '{value}'; numbers of the list that is printed are needed" in printed
    assert not (tmp_path / "out").exists()
