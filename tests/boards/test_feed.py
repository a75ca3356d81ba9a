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
from lumitip_fab.docs.wiring import wiring_note
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
board = "{controller}"
[breakout]
feed_diode = "{diode}"
"""


def _low(
    design_dir: Path, folder: Path, diode: str, controller: str = "arduino_nano_33_ble"
) -> Design:
    """LEDs and controller on a supply of 5 V."""
    mine = Path(shutil.copytree(design_dir, folder / "design")) / "low.toml"
    mine.write_text(LOW.format(diode=diode, controller=controller), encoding="utf-8")
    return derive(load(mine))


def test_a_diode_that_leaves_too_little_is_refused(design_dir: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"breakout\.feed_diode is '1N5819HW', which leaves"):
        _low(design_dir, tmp_path, "1N5819HW", "arduino_nano_esp32")


def test_by_itself_there_is_no_diode_on_the_leds_supply(design_dir: Path, tmp_path: Path) -> None:
    design = _low(design_dir, tmp_path, "auto")
    assert design.feed and design.feed.diode is None
    assert "Never switch this supply on while USB is plugged in" in wiring_note(design)


@pytest.mark.parametrize("diode", ["1N5819HW", "none"])
def test_on_the_leds_supply_the_wire_is_behind_the_fuse(
    design_dir: Path, tmp_path: Path, diode: str
) -> None:
    design = _low(design_dir, tmp_path, diode)
    assert [board.name for board in design.entered] == ["breakout"]
    folder = _built(design, tmp_path)
    found = list(board.measure_board(folder, design, "breakout"))
    assert [m for m in found if not m.passed] == []
    assert "board.feed" in {m.check for m in found}


def _with_controller(design_dir: Path, folder: Path, old: str, new: str) -> Design:
    """The default design with another entry of its controller."""
    design = Path(shutil.copytree(design_dir, folder / "design"))
    parts = design / "parts/controllers.toml"
    before = parts.read_text(encoding="utf-8")
    assert old in before
    parts.write_text(before.replace(old, new, 1), encoding="utf-8")
    return derive(load(design / "fingertip.toml"))


def test_a_controller_whose_current_is_not_known(design_dir: Path, tmp_path: Path) -> None:
    feed = _with_controller(design_dir, tmp_path, "draws_ma = 50.0\n", "").feed
    assert feed and feed.diode == "1N5819HW" and feed.drop_v == pytest.approx(0.32)


@pytest.mark.parametrize(
    ("old", "new", "supply"),
    [
        ('"RST", "GND", "VIN"]', '"RST", "GND", "5V"]', "5V"),
        ('"VUSB", "RST"', '"5V", "RST"', "VIN"),
    ],
    ids=["supply pin", "spare pin"],
)
def test_a_pin_that_is_called_like_the_wire_is_not_joined_to_it(
    design_dir: Path, tmp_path: Path, old: str, new: str, supply: str
) -> None:
    text = (design_dir / "parts/controllers.toml").read_text(encoding="utf-8")
    own = text[text.index(old) : text.index('supply = "VIN"') + len('supply = "VIN"')]
    changed = own.replace(old, new, 1).replace('"VIN"', f'"{supply}"')
    design = _with_controller(design_dir, tmp_path, own, changed)
    (diode,) = (part for part in _breakout(design).components if part.ref == "VD1")
    (_, behind), (_, before) = diode.nets
    assert before == "5V" != behind
    at_pins = {
        name: dict(part.nets)[str(number)]
        for part in _breakout(design).components
        for number, name in enumerate(part.pins, start=1)
        if part.kind == "socket"
    }
    assert at_pins[supply] == behind
    assert "5V" not in at_pins.values()


def test_the_spec_says_what_usb_feeds(design_dir: Path) -> None:
    behind = {row.quantity: row for row in outside(_design(design_dir))}["feed of the controller"]
    assert behind.computed == "through 1N5819HW"
    design = _design(design_dir, breakout__feed_diode="none")
    joined = {row.quantity: row for row in outside(design)}["feed of the controller"]
    assert joined.computed == "joined" and "Never join the wire of 5V" in joined.reason


@pytest.mark.parametrize(("joined", "most_v", "least_v"), [(False, 0.1, 0.0), (True, 5.0, 1.0)])
def test_usb_does_not_feed_the_robots_supply(joined: bool, most_v: float, least_v: float) -> None:
    """The way back from USB by ngspice: the diode on the controller's board, ours with its greatest
    leakage, the flange's coil, the body diode of the regulator's switch, its MOSFET with the least
    threshold of 1 V and the divider of its gate, and a robot whose supply is off (1 kohm)."""
    ours = "R9 wire vin 1m" if joined else "D9 wire vin schottky"
    netlist = f"""USB at the controller while the robot is off
Vusb usb 0 5
D1 usb vin schottky
{ours}
L1 wire sw 4.7u
D2 sw input body
R3 input board 4.7
M1 robot gate board board pfet
R1 board gate 100k
R2 gate 0 100k
Rload robot 0 1k
.model schottky d (is=50u n=1.05 rs=0.05)
.model body d (is=1p n=1.0 rs=0.1)
.model pfet pmos (vto=-1 kp=2)
.op
.control
run
print v(robot)
.endc
.end
"""
    ran = subprocess.run(
        [program("ngspice"), "-b"], input=netlist, capture_output=True, text=True, check=True
    )
    found = re.search(r"v\(robot\) = (\S+)", ran.stdout)
    assert found and least_v <= float(found[1]) <= most_v
