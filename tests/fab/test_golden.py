"""Reference files: what the presets derive to. `make golden` writes them anew; read the diff."""

import os
from pathlib import Path

import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design.encoding import design_text

GOLDEN = Path(__file__).parents[1] / "golden"
PRESETS = (
    "published",
    "asymmetric",
    "dense",
    "mux16",
    "integrated",
    "robotiq_2f140",
    "wsg50",
    "franka_hand",
    "flex",
)


@pytest.mark.golden
@pytest.mark.parametrize("preset", PRESETS)
def test_a_preset_derives_as_recorded(preset: str, design_dir: Path) -> None:
    text = design_text(derive(load(design_dir / "presets" / f"{preset}.toml")))
    file = GOLDEN / f"{preset}.design.json"
    if os.environ.get("LUMITIP_GOLDEN"):
        file.write_text(text, encoding="utf-8")
    assert file.read_text(encoding="utf-8") == text


def test_the_file_to_edit_starts_as_the_published_sensor(design_dir: Path) -> None:
    fingertip, published = (
        derive(load(design_dir / name)) for name in ("fingertip.toml", "presets/published.toml")
    )
    assert fingertip.layout == published.layout
    assert fingertip.outline == published.outline
    assert fingertip.mould == published.mould
