"""Damage the flange's board with the controller on it, and exactly the right checks fail."""

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import in_part, moved_part, once, swapped_pads
from damages import failing
from lumitip_fab.checks import board
from lumitip_fab.design.encoding import read_design

Damage = Callable[[str], str]
FLANGE = "boards/flange/flange.kicad_pcb"
RULE = r'\n  \(zone\n    \(net 0\)\n    \(net_name ""\)'
pytestmark = pytest.mark.slow


@pytest.fixture
def damaged_flange(built: Callable[[str], Path], tmp_path: Path) -> Path:
    """A copy of the preset's board, to damage."""
    folder = built("integrated")
    shutil.copytree(folder / "boards/flange", tmp_path / "boards/flange")
    shutil.copy(folder / "design.json", tmp_path / "design.json")
    return tmp_path


def _ground(text: str) -> str:
    found = re.search(r'\(net (\d+) "GND"\)', text)
    assert found
    return found[1]


def track_under_the_antenna(text: str) -> str:
    track = "(segment (start 123.5 99) (end 125.0 99) (width 0.2) "
    return text.rstrip()[:-1] + f'{track}(layer "B.Cu") (net {_ground(text)}))\n)\n'


def via_under_the_antenna(text: str) -> str:
    via = "(via (at 124.0 102) (size 0.6) (drill 0.3) "
    return text.rstrip()[:-1] + f'{via}(layers "F.Cu" "B.Cu") (net {_ground(text)}))\n)\n'


def rule_missing(text: str) -> str:
    return once(text, RULE + r"(\n    .*)*\n  \)", "")


def rule_lets_the_pour_in(text: str) -> str:
    return once(text, r"\(copperpour not_allowed\)", "(copperpour allowed)")


def rule_of_one_side(text: str) -> str:
    return once(
        text,
        RULE + r'\n    \(layers "F.Cu" "B.Cu"\)',
        '\n  (zone\n    (net 0)\n    (net_name "")\n    (layers "F.Cu")',
    )


def pads_exchanged(text: str) -> str:
    """Pads of A2 and A3 with each other's number: their copper and its nets stay."""
    return swapped_pads(text, "U2", "14", "10")


def supply_at_an_analog_pad(text: str) -> str:
    """Pads of A2 and VDD with each other's number: A2 leaves by the wire beside S2."""
    return swapped_pads(text, "U2", "14", "28")


def diode_turned(text: str) -> str:
    """Pads of a diode at an analog wire with each other's number."""
    return swapped_pads(text, "Z5", "1", "2")


def diode_of_usb_turned(text: str) -> str:
    """Pads of the diode at D- with each other's number."""
    return swapped_pads(text, "Z14", "1", "2")


def resistor_small(text: str) -> str:
    return in_part(text, "R8", r'value "1K"', 'value "100R"')


def capacitor_large(text: str) -> str:
    return in_part(text, "C11", r'value "22pF"', 'value "47pF"')


def module_askew(text: str) -> str:
    return moved_part(text, "U2", 0.02, 0.0)


def edge_beyond_the_antenna(text: str) -> str:
    """The board's left end a millimetre farther to the left."""
    lines = text.split("\n")
    return "\n".join(
        re.sub(r"\((start|mid|end) (1[23]\S*) ", lambda m: f"({m[1]} {float(m[2]) - 1:g} ", line)
        if '"Edge.Cuts"' in line
        else line
        for line in lines
    )


def switched_tracks_at_the_crystal(text: str) -> str:
    """Every track of the crystal's first net as one of the regulator's switches."""
    numbers = {name: number for number, name in re.findall(r'\(net (\d+) "(.*?)"\)', text)}
    return re.sub(rf"(\(segment .*\(net ){numbers['XL1']}\)", rf"\g<1>{numbers['SW']})", text)


DAMAGES: dict[Damage, set[str]] = {
    switched_tracks_at_the_crystal: {"crystal", "short", "supply_width"},
    track_under_the_antenna: {"keep_out"},
    via_under_the_antenna: {"keep_out"},
    rule_missing: {"keep_out_rule"},
    rule_lets_the_pour_in: {"keep_out_rule"},
    rule_of_one_side: {"keep_out_rule"},
    pads_exchanged: {"lands", "joined", "apart", "protection"},
    supply_at_an_analog_pad: {
        *("lands", "joined", "apart", "wire_order"),
        *("protection", "protection_line", "protection_pins", "protection_pulse"),
    },
    diode_turned: {"lands", "joined", "apart", "silk_marks"}
    | {"protection", "protection_reach", "protection_pulse"},
    diode_of_usb_turned: {"lands", "joined", "apart", "silk_marks"}
    | {"protection", "protection_reach", "protection_pulse"},
    resistor_small: {"protection_pulse"},
    capacitor_large: {"protection_line"},
    module_askew: {"lands", "clearance"},  # its tracks stay where they are
    edge_beyond_the_antenna: {"outline", "antenna_edge"},
}


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_the_module(damage: Damage, damaged_flange: Path) -> None:
    path = damaged_flange / FLANGE
    before = path.read_text()
    path.write_text(damage(before))
    assert path.read_text() != before
    assert failing(damaged_flange, "board", "flange") == DAMAGES[damage]


def test_the_module_passes(damaged_flange: Path) -> None:
    assert failing(damaged_flange, "board", "flange") == set()
    design = read_design(damaged_flange / "design.json")
    names = {m.check for m in board.measure_board(damaged_flange, design, "flange")}
    assert {"board.keep_out", "board.keep_out_rule", "board.antenna_edge"} <= names
