"""The diode before the controller: what is there, what its check finds damaged, and that USB stays
away from the robot's supply by ngspice."""

import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import in_part, swapped_pads
from lumitip_fab.boards.files import board_files
from lumitip_fab.checks import board
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import AuxiliaryBoard, Design
from lumitip_fab.design.encoding import design_text, read_design
from lumitip_fab.docs.spec import outside
from lumitip_fab.errors import InputError
from programs import program

pytestmark = pytest.mark.slow

BREAKOUT = "boards/breakout/breakout.kicad_pcb"
Damage = Callable[[str], str]


def _design(design_dir: Path, **values: object) -> Design:
    config = load(design_dir / "fingertip.toml")
    return derive(config.with_values({k.replace("__", "."): v for k, v in values.items()}))


def _breakout(design: Design) -> AuxiliaryBoard:
    return next(made for made in design.auxiliary_boards if made.name == "breakout")


@pytest.fixture(scope="module")
def built(design_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The breakout of the default design, with its design."""
    return _built(_design(design_dir), tmp_path_factory.mktemp("fed"))


def _built(design: Design, folder: Path) -> Path:
    (folder / "design.json").write_text(design_text(design), encoding="utf-8")
    for made in board_files(design, _breakout(design)):
        path = folder / made.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(made.data)
    return folder


def test_an_undamaged_breakout_passes(built: Path) -> None:
    found = list(board.measure_board(built, read_design(built / "design.json"), "breakout"))
    assert [m for m in found if not m.passed] == []
    assert {"board.feed", "board.feed_voltage"} <= {m.check for m in found}


def diode_reversed(text: str) -> str:
    """The controller has no supply, and USB feeds the robot's."""
    return swapped_pads(text, "VD1", "1", "2")


def diode_missing(text: str) -> str:
    return in_part(text, "VD1", r'reference "VD1"', 'reference "VD9"')


@pytest.mark.parametrize("damage", [diode_reversed, diode_missing])
def test_a_damaged_diode_is_found(built: Path, tmp_path: Path, damage: Damage) -> None:
    folder = Path(shutil.copytree(built, tmp_path / "damaged"))
    path = folder / BREAKOUT
    path.write_text(damage(path.read_text(encoding="utf-8")), encoding="utf-8")
    found = board.measure_board(folder, read_design(folder / "design.json"), "breakout")
    assert "board.feed" in {m.check for m in found if not m.passed}


def test_a_wire_that_does_not_reach_the_pin_is_found(design_dir: Path, tmp_path: Path) -> None:
    """Without the diode: the pads of the cable's 24 V and 5 V exchanged."""
    folder = _built(_design(design_dir, breakout__feed_diode="none"), tmp_path)
    design = read_design(folder / "design.json")
    found = {m.check: m.passed for m in board.measure_board(folder, design, "breakout")}
    assert found["board.feed"] and "board.feed_voltage" not in found
    path = folder / BREAKOUT
    path.write_text(swapped_pads(path.read_text(encoding="utf-8"), "J7", "2", "3"))
    found = {m.check: m.passed for m in board.measure_board(folder, design, "breakout")}
    assert not found["board.feed"]


LOW = """extends = "fingertip.toml"
[supply]
voltage_v = 5.0
[flange]
enabled = false
[emitter]
drive = "resistor"
[controller]
board = "arduino_nano_esp32"
[breakout]
feed_diode = "{diode}"
"""


def _low(design_dir: Path, folder: Path, diode: str) -> Design:
    """The controller that draws most, on a supply of 5 V."""
    mine = Path(shutil.copytree(design_dir, folder / "design")) / "low.toml"
    mine.write_text(LOW.format(diode=diode), encoding="utf-8")
    return derive(load(mine))


def test_a_diode_that_leaves_too_little_is_refused(design_dir: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"breakout\.feed_diode is '1N5819HW', which leaves"):
        _low(design_dir, tmp_path, "1N5819HW")


def test_by_itself_no_diode_leaves_too_little(design_dir: Path, tmp_path: Path) -> None:
    feed = _low(design_dir, tmp_path, "auto").electrical.feed
    assert feed and feed.diode is None


def test_the_spec_says_what_usb_feeds(design_dir: Path) -> None:
    behind = {row.quantity: row for row in outside(_design(design_dir))}["feed of the controller"]
    assert behind.computed == "through 1N5819HW"
    design = _design(design_dir, breakout__feed_diode="none")
    joined = {row.quantity: row for row in outside(design)}["feed of the controller"]
    assert joined.computed == "joined" and "Never join the wire of 5V" in joined.reason


@pytest.mark.parametrize(("joined", "most_v", "least_v"), [(False, 0.1, 0.0), (True, 5.0, 3.0)])
def test_usb_does_not_feed_the_robots_supply(joined: bool, most_v: float, least_v: float) -> None:
    """The way back from USB by ngspice: the diode on the controller's board, ours, the flange's
    coil, the body diode of the regulator's switch, and a robot whose supply is off (1 kohm)."""
    ours = "R9 wire vin 1m" if joined else "D9 wire vin schottky"
    netlist = f"""USB at the controller while the robot is off
Vusb usb 0 5
D1 usb vin schottky
{ours}
L1 wire sw 4.7u
D2 sw input body
R3 input supply 4.7
Rload supply 0 1k
.model schottky d (is=1u n=1.05 rs=0.05)
.model body d (is=1p n=1.0 rs=0.1)
.op
.control
run
print v(supply)
.endc
.end
"""
    ran = subprocess.run(
        [program("ngspice"), "-b"], input=netlist, capture_output=True, text=True, check=True
    )
    found = re.search(r"v\(supply\) = (\S+)", ran.stdout)
    assert found and least_v <= float(found[1]) <= most_v
