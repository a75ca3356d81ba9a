"""Holes for a thread beside the wires of fingers: on every rigid board that has room for them."""

import shutil
from pathlib import Path

import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design

DESIGN = Path(__file__).parents[2] / "design"
FILES = (DESIGN / "fingertip.toml", *sorted((DESIGN / "presets").glob("*.toml")))
NARROW = """\
extends = "presets/published.toml"
[grid]
columns = [4, 5, 4, 5]
"""


def _derived(tmp_path: Path, text: str) -> Design:
    for part in ("parts", "presets"):
        shutil.copytree(DESIGN / part, tmp_path / part)
    (tmp_path / "mine.toml").write_text(text)
    return derive(load(tmp_path / "mine.toml"))


@pytest.mark.slow_cases
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_every_rigid_board_has_two_holes_at_its_wires(file: Path) -> None:
    design = derive(load(file))
    for finger in design.fingers:
        if design.board.flexible:
            assert finger.ties == ()
            continue
        (tie,) = finger.ties
        pads_x = [x for x, _ in finger.connector.pads]
        left, right = sorted(x for x, _ in tie.holes)
        assert left < min(pads_x) < max(pads_x) < right or len(pads_x) < 4
        reach = tie.hole_mm / 2
        assert all(abs(x) + reach <= finger.notch.x_max_mm + 1e-9 for x, _ in tie.holes)


def test_a_narrow_board_does_not_grow_for_holes(tmp_path: Path) -> None:
    design = _derived(tmp_path, NARROW)
    assert design.receiver.ties == ()
    pads_x = [x for x, _ in design.receiver.connector.pads]
    beside = design.receiver.notch.x_max_mm - max(pads_x) - design.receiver.connector.pad_mm / 2
    assert beside < design.receiver.connector.pad_mm
