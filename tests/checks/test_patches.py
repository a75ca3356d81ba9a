"""Grids far from the published one: built whole and held against every check."""

import shutil
from pathlib import Path

import pytest

from lumitip_fab.checks.run import run_checks
from lumitip_fab.cli.build import build

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
