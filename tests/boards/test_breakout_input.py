"""The supply's input on the breakout without a flange: what is there, and what its check finds
damaged."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import in_part, swapped_pads
from damages import failing
from lumitip_fab.boards.files import board_files
from lumitip_fab.checks import board
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import design_text, read_design
from lumitip_fab.docs.spec import outside

pytestmark = pytest.mark.slow

BREAKOUT = "boards/breakout/breakout.kicad_pcb"
OWN = {"supply_input", "tvs", "plug_in_voltage"}
Damage = Callable[[str], str]


def _design(design_dir: Path, **values: object) -> Design:
    config = load(design_dir / "presets/franka_hand.toml")
    return derive(config.with_values({k.replace("__", "."): v for k, v in values.items()}))


@pytest.fixture(scope="module")
def built(design_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The breakout of a Franka Hand, with its design."""
    folder, design = tmp_path_factory.mktemp("franka"), _design(design_dir)
    (folder / "design.json").write_text(design_text(design), encoding="utf-8")
    for made in board_files(design, design.entered[0]):
        path = folder / made.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(made.data)
    return folder


@pytest.fixture
def folder(built: Path, tmp_path: Path) -> Path:
    """The same, to damage."""
    return Path(shutil.copytree(built, tmp_path / "damaged"))


def test_an_undamaged_breakout_passes(built: Path) -> None:
    found = list(board.measure_board(built, read_design(built / "design.json"), "breakout"))
    assert [m for m in found if not m.passed] == []
    assert {m.check.removeprefix("board.") for m in found} >= OWN


def transistor_reversed(text: str) -> str:
    """Drain and source: its diode lets a reversed supply through."""
    return swapped_pads(text, "Q1", "2", "3")


def tvs_reversed(text: str) -> str:
    return swapped_pads(text, "D1", "1", "2")


def tvs_missing(text: str) -> str:
    return in_part(text, "D1", r'reference "D1"', 'reference "D9"')


def fuse_missing(text: str) -> str:
    return in_part(text, "F1", r'reference "F1"', 'reference "F9"')


def supply_past_the_fuse(text: str) -> str:
    """The wires' pads in another order: the supply is on the pad of the 5 V."""
    return swapped_pads(text, "J7", "1", "3")


def resistor_of_the_gate_missing(text: str) -> str:
    return in_part(text, "R10", r'reference "R10"', 'reference "R99"')


DAMAGES: dict[Damage, set[str]] = {
    transistor_reversed: {"supply_input", "tvs"},
    tvs_reversed: {"tvs"},
    tvs_missing: {"tvs"},
    fuse_missing: {"supply_input"},
    supply_past_the_fuse: {"supply_input"},
    resistor_of_the_gate_missing: {"supply_input"},
}


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_the_input(damage: Damage, folder: Path) -> None:
    path = folder / BREAKOUT
    before = path.read_text()
    path.write_text(damage(before))
    assert failing(folder, "board", "breakout") & OWN == DAMAGES[damage]


@pytest.mark.parametrize("volts", [4.0, 36.0])
def test_a_supply_that_no_part_is_made_for_is_not_refused(design_dir: Path, volts: float) -> None:
    design = _design(design_dir, supply__voltage_v=volts)
    assert design.entered == () and design.electrical.plug_ins == ()
    rows = {row.quantity: row.computed for row in outside(design)}
    assert rows[f"input of the {volts:g} V"] == "no fuse, no MOSFET, no TVS diode"


def test_the_published_circuit_has_none_and_says_so(design_dir: Path) -> None:
    values = {"protection__diode": "none", "breakout__board_mm": (45.72, 33.02)}
    design = _design(design_dir, **values)
    assert design.entered == ()
    rows = {row.quantity: row.computed for row in outside(design)}
    assert rows["input of the 24 V"] == "no fuse, no MOSFET, no TVS diode"
    assert design.auxiliary_boards[0].box.length_mm == pytest.approx(33.02)


def test_a_breakout_that_is_too_small_has_no_automatic_diodes(design_dir: Path) -> None:
    design = _design(design_dir, breakout__board_mm=(45.72, 33.02))
    assert design.entered == () and design.electrical.protection is None


def test_with_a_flange_the_breakout_has_none(design_dir: Path) -> None:
    design = derive(load(design_dir / "fingertip.toml"))
    (board_with_it,) = design.entered
    assert board_with_it.name == "flange"
    breakout = next(b for b in design.auxiliary_boards if b.name == "breakout")
    assert not {"F1", "Q1"} & {part.ref for part in breakout.components}


@pytest.mark.parametrize("volts", [5.0, 12.0, 24.0])
def test_every_supply_has_its_parts(design_dir: Path, volts: float) -> None:
    design = _design(design_dir, supply__voltage_v=volts)
    (breakout,) = design.entered
    assert {"F1", "Q1", "D1"} <= {part.ref for part in breakout.components}
    cables = {cable.name: cable for cable in design.cabling.cables}
    assert f"{volts:g}V" in {wire.signal for wire in cables["W3"].wires}
