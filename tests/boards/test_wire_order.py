"""The order of the receiver's wires: what its check finds on damaged boards."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import once, swapped_pads
from lumitip_fab.checks import board
from lumitip_fab.checks.result import Measurement
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import read_design

pytestmark = pytest.mark.slow

DAMAGES = {"receiver": ("U1", "16", "3"), "breakout": ("J1", "2", "4")}


@pytest.fixture
def folder(boards: Callable[[str], Path], tmp_path: Path) -> Path:
    """Boards with wires apart, to damage."""
    return Path(shutil.copytree(boards("switched"), tmp_path / "ordered"))


def order(folder: Path, name: str) -> list[Measurement]:
    """What is measured of the order of wires on a board."""
    design = read_design(folder / "design.json")
    found = board.measure_board(folder, design, name)
    return [m for m in found if m.check == "board.wire_order"]


@pytest.mark.parametrize("name", DAMAGES)
def test_wires_apart_pass(folder: Path, name: str) -> None:
    (found,) = order(folder, name)
    assert (found.measured, found.passed) == (0, True)


@pytest.mark.parametrize("name", ["emitter", "flange"])
def test_a_board_without_such_wires_is_not_measured(folder: Path, name: str) -> None:
    assert order(folder, name) == []


@pytest.mark.parametrize("name", DAMAGES)
def test_an_analog_line_at_the_wire_beside_a_select_one_is_seen(folder: Path, name: str) -> None:
    """Leads of the supply and of the analog line with each other's number."""
    path = folder / f"boards/{name}/{name}.kicad_pcb"
    path.write_text(swapped_pads(path.read_text(), *DAMAGES[name]))
    (found,) = order(folder, name)
    assert not found.passed
    assert found.note == "S2 is beside 3V3"


@pytest.mark.parametrize("name", ["receiver", "breakout"])
def test_boards_in_the_published_order_are_not_apart(
    boards: Callable[[str], Path], tmp_path: Path, name: str
) -> None:
    folder = Path(shutil.copytree(boards("small"), tmp_path / "published"))
    text = (folder / "design.json").read_text()
    (folder / "design.json").write_text(once(text, r'"apart": ?false', '"apart": true'))
    (found,) = order(folder, name)
    assert (found.measured, found.passed) == (1, False)


def test_the_published_order_is_reported(boards: Callable[[str], Path]) -> None:
    (found,) = order(boards("small"), "receiver")
    assert (found.measured, found.passed) == (1, True)
    assert found.note == "the published order: reported only; S2 is beside A0"


def test_supplies_lie_between_select_and_analog_lines(
    designs: Callable[[str], Design], design_dir: Path
) -> None:
    assert designs("small").receiver.connector.signals[:3] == ("GND", "3V3", "S0")
    wires = derive(load(design_dir / "fingertip.toml")).receiver.connector
    assert wires.signals == ("S0", "S1", "S2", "3V3", "GND", "A0", "A1", "A2", "A3")
    assert wires.supply == "3V3"
