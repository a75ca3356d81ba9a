"""The functions that `lumitip_fab` offers to programs."""

from pathlib import Path

import lumitip_fab


def test_paths_may_be_text(design_dir: Path, tmp_path: Path) -> None:
    file = str(design_dir / "presets/asymmetric.toml")
    assert lumitip_fab.load(file).parameters.grid.pitch_mm == 5.0
    assert len(lumitip_fab.derived(file).cells) == 20
    lumitip_fab.build(file, str(tmp_path / "out"), only=["firmware"])
    assert (tmp_path / "out/firmware").is_dir() and not (tmp_path / "out/boards").exists()
