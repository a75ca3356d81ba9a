"""Grids far from the published one: built whole and held against every check."""

import shutil
from pathlib import Path

import pytest

from lumitip_fab.checks.run import run_checks
from lumitip_fab.cli.build import build
from lumitip_fab.design.encoding import read_design

_FILE = """\
extends = "published.toml"
name = "Patch"

[grid]
columns = {columns}

[emitter]
resistor = "1206"
resistor_side = "front"
current_ma = 6.0
"""


@pytest.mark.slow
@pytest.mark.parametrize("columns", [[3], [1] * 8, [5, 2, 5]], ids=str)
def test_a_patch_passes_every_check(columns: list[int], design_dir: Path, tmp_path: Path) -> None:
    file = Path(shutil.copytree(design_dir, tmp_path / "design")) / "presets" / "patch.toml"
    file.write_text(_FILE.format(columns=columns), encoding="utf-8")
    build(file, tmp_path / "out")
    failed = run_checks(tmp_path / "out").failed
    assert [f"{m.check} {m.subject}: {m.measured} {m.limit}" for m in failed] == []


@pytest.mark.slow
def test_a_finger_of_twelve_rows_passes_every_check_at_a_lower_force(
    design_dir: Path, tmp_path: Path
) -> None:
    """It is twice as long as the published one: what it bears at its tip is less than 40 N."""
    file = Path(shutil.copytree(design_dir, tmp_path / "design")) / "long.toml"
    columns = [12, 11, 12, 11, 12, 11, 12]
    file.write_text(f'extends = "fingertip.toml"\n[grid]\ncolumns = {columns}\n', encoding="utf-8")
    build(file, tmp_path / "out")
    result = run_checks(tmp_path / "out")
    assert [f"{m.check} {m.subject}: {m.measured} {m.limit}" for m in result.failed] == []
    assert 20 < read_design(tmp_path / "out" / "design.json").strength.rated_force_n < 40
