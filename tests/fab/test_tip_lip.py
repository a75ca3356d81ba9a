"""Where silicone can wrap the tip: thinner or none by itself, refused where the file writes it."""

import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from lumitip_fab.config.load import Input, load
from lumitip_fab.derive import derive
from lumitip_fab.derive.auto.resolve import resolve
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.tip_slots import LIP
from lumitip_fab.derive.once import derive_once
from lumitip_fab.design import Design
from lumitip_fab.errors import InputError

pytestmark = pytest.mark.slow


def config_of(design_dir: Path, tmp_path: Path, lines: str) -> Input:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    file = folder / "mine.toml"
    file.write_text(f'extends = "fingertip.toml"\n{lines}', encoding="utf-8")
    return load(file)


def of_lines(design_dir: Path, tmp_path: Path, lines: str) -> Design:
    return derive(config_of(design_dir, tmp_path, lines))


NO_ROOM = {
    "[tip]\nangle_deg = 5\n": "at a tip edge of 1.88 the mould's wall",
    "[outline]\ntip_fraction = 0.1\n": "its straight part is 5.8 long",
    "[outline]\ntip_margin_mm = 3.0\n": "0.51 of the plate is left between them and the pocket",
}


@pytest.mark.parametrize("lines", NO_ROOM)
def test_without_room_the_skin_ends_at_the_edge(
    lines: str, design_dir: Path, tmp_path: Path
) -> None:
    design = of_lines(design_dir, tmp_path, lines)
    assert design.tip.slots == () and design.props == ()
    assert design.mould.level_mm(design.outline.tip_y_mm) == 0.0
    assert design.mould.guided_mm == design.stack.guided_mm
    (choice,) = [c for c in design.choices if c.field == LIP]
    assert float(choice.value) == 0 and NO_ROOM[lines] in choice.reason


@pytest.mark.parametrize("lines", NO_ROOM)
def test_a_lip_that_the_file_writes_is_never_left_out(
    lines: str, design_dir: Path, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=re.escape(NO_ROOM[lines])) as refused:
        of_lines(design_dir, tmp_path, f"{lines}[mould]\ntip_lip_mm = 0.4\n")
    assert [p.field for p in refused.value.problems] == [LIP]


def test_an_automatic_lip_is_as_thin_as_it_must_be(design_dir: Path, tmp_path: Path) -> None:
    design = of_lines(design_dir, tmp_path, "[tip]\nangle_deg = 11\n")
    assert design.props[0].lip_mm == 0.3
    (choice,) = [c for c in design.choices if c.field == LIP]
    assert choice.reason.startswith("otherwise it is 0.4; at a tip edge of 1.23")


def test_as_much_as_the_refusal_says_is_accepted(design_dir: Path, tmp_path: Path) -> None:
    lines = "[mould]\ntip_lip_mm = {}\n"
    with pytest.raises(InputError) as refused:
        of_lines(design_dir, tmp_path / "more", lines.format(1.5))
    (most,) = re.findall(r"holds at most ([\d.]+)", str(refused.value))
    design = of_lines(design_dir, tmp_path / "most", lines.format(most))
    assert design.props[0].lip_mm == float(most)
    assert design.stack.guided_mm < design.mould.guided_mm < design.stack.plate_mm


def test_an_unwrapped_design_is_the_same_from_its_resolved_file(
    design_dir: Path, tmp_path: Path
) -> None:
    resolved = resolve(config_of(design_dir, tmp_path, "[tip]\nangle_deg = 5\n"))
    again = derive_once(resolved.config, Diagnostics(resolved.config))
    assert again.props == resolved.design.props == ()
    assert replace(again, choices=resolved.design.choices) == resolved.design
