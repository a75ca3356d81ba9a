"""Box headers on the flange's board: room round their shrouds, and the count of their contacts."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import moved_part, swapped_pads
from lumitip_fab.checks import board
from lumitip_fab.checks.result import Measurement
from lumitip_fab.config.load import load
from lumitip_fab.design import footprints
from lumitip_fab.design.encoding import read_design

FLANGE = "boards/flange/flange.kicad_pcb"
KICAD_PADS = {"1": (0.0, 0.0), "2": (2.54, 0.0), "3": (0.0, 2.54), "13": (0.0, 15.24)}
"""Places of pads of IDC-Header_2x07_P2.54mm_Horizontal of KiCad's libraries; the page is y down."""
KICAD_SHROUD = 4.38, 13.28
"""From the row of pad 1 to the back and to the front of the shroud."""


def figure(folder: Path, check: str) -> Measurement:
    design = read_design(folder / "design.json")
    (found,) = (m for m in board.measure_board(folder, design, "flange") if m.check == check)
    return found


def test_pads_lie_as_in_a_published_land_pattern(design_dir: Path) -> None:
    strips = load(design_dir / "presets" / "published.toml").catalogue.strips
    shape = footprints.rows("Header", strips["box header 2x7"])
    places = {pad.number: (pad.x_mm, pad.y_mm) for pad in shape.pads}
    first = places["1"]
    for number, (out, along) in KICAD_PADS.items():
        moved = places[number][0] - first[0], places[number][1] - first[1]
        assert moved == pytest.approx((along, out)), number
    assert shape.shroud is not None
    ends = [y - first[1] for y in shape.shroud.box.bounds_mm[1::2]]
    assert ends == pytest.approx(KICAD_SHROUD, abs=0.06)


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["switched", "integrated"])
@pytest.mark.parametrize("check", ["board.shroud_room", "board.socket_contacts"])
def test_headers_have_room_and_count_as_sockets_do(
    boards: Callable[[str], Path], preset: str, check: str
) -> None:
    assert figure(boards(preset), check).passed


@pytest.mark.slow
def test_wire_pads_under_a_shroud_are_seen(boards: Callable[[str], Path], tmp_path: Path) -> None:
    folder = Path(shutil.copytree(boards("integrated"), tmp_path / "moved"))
    text = (folder / FLANGE).read_text()
    (folder / FLANGE).write_text(moved_part(text, "J4", 0.0, 1.8))
    found = figure(folder, "board.shroud_room")
    assert not found.passed
    assert "J2 to J4" in found.note


@pytest.mark.slow
@pytest.mark.parametrize("ref", ["J2", "J3"])
def test_pads_counted_in_another_way_are_seen(
    boards: Callable[[str], Path], tmp_path: Path, ref: str
) -> None:
    folder = Path(shutil.copytree(boards("switched"), tmp_path / "counted"))
    text = (folder / FLANGE).read_text()
    (folder / FLANGE).write_text(swapped_pads(text, ref, "2", "3"))
    found = figure(folder, "board.socket_contacts")
    assert not found.passed
    assert found.note == f"{ref}.3; {ref}.2"


@pytest.mark.slow
def test_boards_without_box_headers_have_no_such_figures(boards: Callable[[str], Path]) -> None:
    design = read_design(boards("switched") / "design.json")
    for name in ("breakout", "receiver"):
        found = {m.check for m in board.measure_board(boards("switched"), design, name)}
        assert not found & {"board.shroud_room", "board.socket_contacts"}
