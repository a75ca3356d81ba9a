"""What the boards take from an entry of the catalogue."""

import shutil
from pathlib import Path

import pytest

from lumitip_fab import derived
from lumitip_fab.design.encoding import canonical


@pytest.mark.slow
def test_another_source_does_not_route_the_boards_again(design_dir: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    file = folder / "presets/published.toml"
    before = canonical(derived(file).packages)
    leds = folder / "parts/leds.toml"
    text = leds.read_text(encoding="utf-8")
    leds.write_text(text.replace('source = "', 'source = "read again: '), encoding="utf-8")
    assert canonical(derived(file).packages) == before
    leds.write_text(text.replace("pad_mm = [0.8", "pad_mm = [0.7", 1), encoding="utf-8")
    assert canonical(derived(file).packages) != before
