"""Engraved letters follow the line width of every printer of the catalogue."""

import shutil
import tomllib
from pathlib import Path

import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.finger.outline import BETWEEN, LEAST_MM, least_letter_mm
from lumitip_fab.errors import InputError

PRINTERS = tomllib.loads(
    (Path(__file__).parents[2] / "design/parts/printers.toml").read_text(encoding="utf-8")
)
THINNER = "min_wall_mm = 0.8\n"
"""The couplings and the flange's contacts leave walls of 0.8 mm, less than two lines of 0.65 mm."""
GROOVE = "[flex]\ngroove_mm = 1.6\n"
NEEDED = {
    ("published", "fdm 0.6"): THINNER,
    ("wsg50", "fdm 0.6"): THINNER,
    ("flex", "fdm 0.6"): THINNER + GROOVE,
}


@pytest.fixture
def copied_design(design_dir: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(design_dir, tmp_path / "design"))


def _file(design_dir: Path, preset: str, more: str) -> Path:
    file = design_dir / "printer.toml"
    file.write_text(f'extends = "presets/{preset}.toml"\n[printer]\n{more}', encoding="utf-8")
    return file


@pytest.mark.slow
@pytest.mark.parametrize("printer", PRINTERS)
@pytest.mark.parametrize("preset", ["published", "flex", "wsg50"])
def test_a_line_fits_between_the_strokes_and_round_the_letters(
    copied_design: Path, preset: str, printer: str
) -> None:
    more = NEEDED.get((preset, printer), "")
    file = _file(copied_design, preset, f'profile = "{printer}"\n{more}')
    design = derive(load(file))
    line_mm, mould, mount = design.printing.line_mm, design.mould, design.mount
    assert line_mm == PRINTERS[printer]["line_mm"]
    rim_mm = mould.wall_mm + design.stack.cover_mm
    for letter, top_mm in ((mould.letter, rim_mm), (mount.letter, mount.land_mm)):
        assert letter.box.length_mm * BETWEEN >= line_mm
        assert letter.box.y_min_mm >= line_mm - 1e-9
        assert top_mm - letter.box.y_max_mm >= line_mm - 1e-9
    for interface in design.interfaces:
        assert interface.letter.box.length_mm * BETWEEN >= line_mm


def test_the_mould_s_wall_grows_for_the_letters_of_a_wide_line(copied_design: Path) -> None:
    file = _file(copied_design, "published", f'profile = "fdm 0.6"\n{THINNER}')
    design = derive(load(file))
    assert design.mould.wall_mm == 2.5
    (choice,) = [choice for choice in design.choices if choice.field == "mould.wall_mm"]
    assert "2.66 mm is needed" in choice.reason


def test_a_wall_without_room_for_the_letter_is_refused(copied_design: Path) -> None:
    more = f'profile = "fdm 0.6"\n{THINNER}[mould]\nwall_mm = 2.4\n'
    with pytest.raises(InputError) as refusal:
        derive(load(_file(copied_design, "published", more)))
    assert "mould.wall_mm is 2.4, which leaves 2.60 mm" in str(refusal.value)
    assert "Use a wall of 2.46 mm or more." in str(refusal.value)


@pytest.mark.parametrize("line_mm", [0.28, 0.42, 0.45])
def test_lines_of_usual_nozzles_ask_for_no_larger_letter(line_mm: float) -> None:
    assert least_letter_mm(line_mm) == LEAST_MM
