"""Folders and numbers that `explore` and `design` refuse: one error, no traceback."""

from pathlib import Path

import pytest

from goals_file import PUBLISHED, write_goals
from lumitip_fab.cli import main
from lumitip_fab.cli.design import _fails
from lumitip_fab.errors import OutputError
from lumitip_fab.explore import report
from lumitip_fab.explore.run import Found, Study
from lumitip_fab.pipeline.build import locked

GOALS = "[goals]\nedge_mm = 0.2\n[vary]\nmask.hole_mm = [2.4, 2.5]\n"


def _command(name: str, folder: Path) -> list[str]:
    if name == "design":
        return ["design", str(write_goals(folder, GOALS))]
    return ["explore", str(PUBLISHED), "--vary", "mask.hole_mm=2.4,2.5"]


@pytest.mark.parametrize("name", ["explore", "design"])
@pytest.mark.parametrize("place", ["file", "file/below"])
def test_a_file_in_the_place_of_the_folder(
    name: str, place: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("kept")
    out = tmp_path / place
    assert main([*_command(name, tmp_path), "--out", str(out)]) == 2
    text = capsys.readouterr().err.strip()
    assert text.startswith(f"{out}: cannot be written: ")
    assert text.endswith("a folder is needed, and is made if missing. Choose another with --out.")
    assert (tmp_path / "file").read_text() == "kept"


def test_errors_of_the_holder_of_a_folder_are_its_own(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError), locked(tmp_path):
        raise FileNotFoundError


@pytest.mark.parametrize(
    ("option", "value", "text"),
    [
        ("--seed", "-1", "--seed: is -1; 0 to 4294967295 is allowed"),
        ("--points", "1000000000", "--points: is 1000000000; 1 to 10000 is allowed"),
    ],
)
def test_numbers_out_of_range(
    option: str, value: str, text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = [*_command("explore", tmp_path), "--out", str(tmp_path / "out"), option, value]
    assert main(command) == 2
    assert capsys.readouterr().err.strip() == text


def test_a_table_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "designs.csv").mkdir()
    study = Study((), (Found((), (5, 4), {}, ("too wide",)),), "EUR", 1)
    with pytest.raises(OutputError, match=r"designs\.csv: cannot be written: "):
        report.write(study, tmp_path)


def test_a_point_whose_folder_cannot_be_used_fails(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "point-1.toml").write_bytes(PUBLISHED.read_bytes())
    (tmp_path / "point-1").write_text("kept")
    assert _fails(tmp_path / "point-1", silent=True)
    text = " ".join(capsys.readouterr().err.split())
    assert f"{tmp_path / 'point-1'}: not built and checked: " in text
    assert "cannot be written" in text
