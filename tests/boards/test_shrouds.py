"""Room from the shrouds of box headers to other parts' pads, on the flange's board."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import moved_part
from lumitip_fab.checks import board
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design.encoding import read_design

pytestmark = pytest.mark.slow
FLANGE = "boards/flange/flange.kicad_pcb"


def shroud_room(folder: Path) -> Measurement:
    design = read_design(folder / "design.json")
    (found,) = (
        m for m in board.measure_board(folder, design, "flange") if m.check == "board.shroud_room"
    )
    return found


@pytest.mark.parametrize("preset", ["switched", "integrated"])
def test_no_pad_is_under_a_shroud(boards: Callable[[str], Path], preset: str) -> None:
    assert shroud_room(boards(preset)).passed


def test_wire_pads_under_a_shroud_are_seen(boards: Callable[[str], Path], tmp_path: Path) -> None:
    folder = Path(shutil.copytree(boards("integrated"), tmp_path / "moved"))
    text = (folder / FLANGE).read_text()
    (folder / FLANGE).write_text(moved_part(text, "J4", 0.0, 1.8))
    found = shroud_room(folder)
    assert not found.passed
    assert "J2 to J4" in found.note


def test_boards_without_box_headers_have_no_such_figure(boards: Callable[[str], Path]) -> None:
    design = read_design(boards("switched") / "design.json")
    for name in ("breakout", "receiver"):
        found = board.measure_board(boards("switched"), design, name)
        assert "board.shroud_room" not in {m.check for m in found}
