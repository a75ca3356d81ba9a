"""Masks by themselves, to damage."""

import shutil
from pathlib import Path

import pytest

from finger_notes import noted_mask
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design.encoding import design_text
from lumitip_fab.parts.coupon import coupon_files
from lumitip_fab.parts.sheet import sheet_files


@pytest.fixture(scope="session")
def masks(tmp_path_factory: pytest.TempPathFactory, design_dir: Path) -> Path:
    """The masks of the published design and nothing else. Do not change them."""
    out = tmp_path_factory.mktemp("masks")
    d = derive(load(design_dir / "presets" / "published.toml"))
    (out / "mask").mkdir()
    (out / "design.json").write_text(design_text(d), encoding="utf-8")
    for finger in d.fingers:
        made = (*noted_mask(d, finger), *sheet_files(d, finger))
        for artefact in made:
            (out / artefact.path).write_bytes(artefact.data)
    for artefact in coupon_files(d):
        (out / artefact.path).write_bytes(artefact.data)
    return out


@pytest.fixture
def damaged_masks(masks: Path, tmp_path: Path) -> Path:
    """A copy of the masks, to damage."""
    return Path(shutil.copytree(masks, tmp_path / "damaged"))
