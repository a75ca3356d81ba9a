"""Masks by themselves, to damage."""

import shutil
from pathlib import Path

import pytest

from finger_notes import written_masks
from lumitip_fab.config.load import load


@pytest.fixture(scope="session")
def masks(tmp_path_factory: pytest.TempPathFactory, design_dir: Path) -> Path:
    """The masks of the published design and nothing else. Do not change them."""
    config = load(design_dir / "presets" / "published.toml")
    return written_masks(config, tmp_path_factory.mktemp("masks") / "out")


@pytest.fixture
def damaged_masks(masks: Path, tmp_path: Path) -> Path:
    """A copy of the masks, to damage."""
    return Path(shutil.copytree(masks, tmp_path / "damaged"))
