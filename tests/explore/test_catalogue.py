"""An edited catalogue is judged anew where it moves figures."""

from pathlib import Path

import pytest

from lumitip_fab.config.load import Input, load
from lumitip_fab.explore.accuracy import Sample
from lumitip_fab.explore.evaluate import Job

FEW = Sample(fingers=1, poses=3)


@pytest.fixture
def config(design_dir: Path) -> Input:
    """The default design."""
    return load(design_dir / "fingertip.toml")


def _edited(config: Input, design_dir: Path, folder: Path, *edit: str) -> Input:
    """The parameter file with one text of a catalogue file replaced: its name, old, new."""
    name, old, new = edit
    text = (design_dir / "parts" / name).read_text(encoding="utf-8")
    assert old in text
    (folder / "parts").mkdir()
    (folder / "parts" / name).write_text(text.replace(old, new, 1), encoding="utf-8")
    return load(config.sources[0].path, folder)


@pytest.mark.parametrize(
    ("edit", "anew"),
    [
        (("fasteners.toml", "cap_head_mm = 5.5", "cap_head_mm = 5.6"), True),
        (("laminates.toml", "copper_mm = 0.035", "copper_mm = 0.07"), True),
        (("leds.toml", "forward_voltage_v = 1.45", "forward_voltage_v = 1.5"), True),
        (("tolerances.toml", "spread = 0.4", "spread = 0.5"), False),
    ],
)
def test_an_edited_catalogue_is_evaluated_anew_where_it_moves_figures(
    config: Input, edit: tuple[str, ...], anew: bool, design_dir: Path, tmp_path: Path
) -> None:
    own, prices = Job.of(config, (), config.catalogue.prices, FEW), config.catalogue.prices
    other = _edited(config, design_dir, tmp_path, *edit)
    assert (Job.of(other, (), prices, FEW).key != own.key) is anew
