"""Before the answers: gauge and notes of the first step, and the options that name features."""

from pathlib import Path
from typing import Any

import pytest
from build123d import Shape

from fingertip_shapes import block, plain
from lumitip_fab.cli import main
from lumitip_fab.parts.export import step


def begun(shape: Shape, folder: Path, *options: str) -> list[str]:
    """The first step's command for a fingertip."""
    file = folder / "tip.step"
    file.write_bytes(step(shape, "tip"))
    out = ["--from-step", str(file), "--out", str(folder / "out"), "--replace"]
    return ["gripper", "new", "jaw", *out, *options]


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
