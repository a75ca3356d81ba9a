"""A build over one that had readings of the user's prints says which of them it leaves out."""

from pathlib import Path

import pytest

from lumitip_fab.cli import main
from lumitip_fab.cli.readings import readings
from lumitip_fab.errors import BuildError

MINE = """extends = "fingertip.toml"
[printer]
fit_mm = -0.05
[mask]
measured_ruler_mm = [100.0, 99.6]
"""


def build(file: Path, out: Path) -> int:
    return main(["build", str(file), "--out", str(out), "--only", "slicer", "--quiet"])


@pytest.mark.slow
def test_a_build_without_the_readings_of_the_last_one_says_so(
    design_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plain, mine, out = tmp_path / "fingertip.toml", tmp_path / "mine.toml", tmp_path / "out"
    plain.write_bytes((design_dir / "fingertip.toml").read_bytes())
    mine.write_text(MINE, encoding="utf-8")
    assert build(plain, out) == build(mine, out) == 0
    assert capsys.readouterr().err == "", "readings that are new are not lost"
    assert build(mine, out) == 0
    assert capsys.readouterr().err == ""
    assert build(plain, out) == 0
    assert capsys.readouterr().err.splitlines() == [
        f"warning: {out} had {reading}, a reading of your prints; {plain} has none. Build the file "
        "that has it, or write it into this one."
        for reading in ("printer.fit_mm = -0.05", "mask.measured_ruler_mm = [100.0, 99.6]")
    ]


def test_a_build_that_fails_says_so_too(
    design_dir: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its parameters are written before its steps."""
    plain, mine, out = tmp_path / "fingertip.toml", tmp_path / "mine.toml", tmp_path / "out"
    plain.write_bytes((design_dir / "fingertip.toml").read_bytes())
    mine.write_text(MINE, encoding="utf-8")
    assert build(mine, out) == 0

    def fails(*_: object) -> None:
        raise BuildError("no room")

    monkeypatch.setattr("lumitip_fab.parts.settings.print_settings", fails)
    assert build(plain, out) == 1
    assert "had printer.fit_mm = -0.05, a reading of your prints" in capsys.readouterr().err


@pytest.mark.parametrize("text", ["printer = 3", "[printer", "\x00", ""])
def test_a_spoilt_folder_has_no_readings(text: str, tmp_path: Path) -> None:
    (tmp_path / "resolved.toml").write_text(text, encoding="utf-8")
    assert readings(tmp_path) == readings(tmp_path / "missing") == {}
