"""The transistor that switches the LEDs: what is refused, and what its checks find damaged."""

import math
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import in_part, swapped_pads
from damages import failing
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.docs.wiring import wiring_files
from lumitip_fab.errors import InputError
from lumitip_fab.firmware.files import firmware_files
from spice_runs import needs_ngspice, simulated

pytestmark = pytest.mark.slow

EMITTER = "boards/emitter/emitter.kicad_pcb"
HEADER = "firmware/layout.h"
Damage = Callable[[str], str]


@pytest.fixture
def folder(boards: Callable[[str], Path], designs: Callable[[str], Design], tmp_path: Path) -> Path:
    """Boards, cables and firmware of a design with a switch, to damage."""
    out = Path(shutil.copytree(boards("switched"), tmp_path / "switched"))
    design = designs("switched")
    for artefact in (*wiring_files(design), *firmware_files(design)):
        (out / artefact.path).parent.mkdir(exist_ok=True)
        (out / artefact.path).write_bytes(artefact.data)
    return out


def gate_and_source(text: str) -> str:
    return swapped_pads(text, "Q1", "1", "2")


def source_and_drain(text: str) -> str:
    return swapped_pads(text, "Q1", "2", "3")


def pull_down_wrong(text: str) -> str:
    return in_part(text, "R3", r'value "100K"', 'value "1K"')


def pull_down_lost(text: str) -> str:
    return in_part(text, "R3", r'reference "R3"', 'reference "X3"')


def gate_at_another_wire(text: str) -> str:
    return swapped_pads(text, "J1", "1", "3")


DAMAGES: dict[Damage, set[str]] = {
    gate_and_source: {"lands", "silk_marks", "switch"},
    source_and_drain: {"lands", "strings", "switch", "current", "polarity"},
    pull_down_wrong: {"switch"},
    pull_down_lost: {"switch"},
}


def hurt(folder: Path, file: str, damage: Damage) -> None:
    before = (folder / file).read_text()
    (folder / file).write_text(damage(before))
    assert (folder / file).read_text() != before


def test_an_undamaged_board_passes(folder: Path) -> None:
    assert failing(folder, "board", "emitter") == set()
    assert failing(folder, "wiring") == set()
    assert "pins" not in failing(folder, "firmware")


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_the_switch(damage: Damage, folder: Path) -> None:
    hurt(folder, EMITTER, damage)
    assert failing(folder, "board", "emitter") == DAMAGES[damage]


def test_a_gate_at_another_wire(folder: Path) -> None:
    hurt(folder, EMITTER, gate_at_another_wire)
    assert {"switch", "strings"} <= failing(folder, "board", "emitter")


def test_a_firmware_that_switches_another_pin(folder: Path) -> None:
    hurt(folder, HEADER, lambda text: text.replace("EMITTER_PIN 5", "EMITTER_PIN 4"))
    assert failing(folder, "wiring") == {"pins"}
    assert "pins" in failing(folder, "firmware")


def test_a_socket_whose_pin_is_at_another_net(folder: Path) -> None:
    hurt(
        folder,
        "boards/breakout/breakout.kicad_pcb",
        lambda text: swapped_pads(text, "J2", "8", "9"),
    )
    assert "pins" in failing(folder, "wiring")


def test_a_firmware_that_does_not_wait(folder: Path) -> None:
    hurt(folder, HEADER, lambda text: re.sub(r"EMITTER_US \d+", "EMITTER_US 370", text))
    assert "converter" in failing(folder, "firmware")


def test_no_pin_is_defined_where_the_leds_are_always_on(designs: Callable[[str], Design]) -> None:
    (header,) = (a.data for a in firmware_files(designs("small")) if a.path == HEADER)
    assert b"EMITTER" not in header
    assert designs("small").emitter.connector.signals == ("GND", "12V")


REFUSED = [
    ('[emitter]\nswitch = "Si2309CDS"\n', "emitter.switch", "a P-channel MOSFET"),
    ('[flange]\ntransistor = "AO3400A"\n', "flange.transistor", "an N-channel MOSFET"),
    ('[emitter]\nswitch = "AO3400A"\n', "emitter.switch", "do not settle"),
    (
        '[emitter]\nswitch = "AO3400A"\n[receiver]\nload = "each"\npull_up_ohm = 18000.0\n'
        "[supply]\nvoltage_v = 36.0\n[flange]\nenabled = false\n",
        "emitter.switch",
        "rated for 30 V; a supply of 36 V needs 39.6 V",
    ),
]


@pytest.mark.parametrize(("text", "field", "says"), REFUSED)
def test_a_written_part_that_cannot_be_is_refused(
    design_dir: Path, tmp_path: Path, text: str, field: str, says: str
) -> None:
    with pytest.raises(InputError) as caught:
        derive(load(_mine(design_dir, tmp_path, text)))
    assert any(p.field == field and says in p.message for p in caught.value.problems)


AUTOMATIC = [
    ("", "AO3400A", "default"),
    ('[receiver]\nload = "shared"\n', "none", "do not settle"),
    ("[supply]\nvoltage_v = 36.0\n[flange]\nenabled = false\n", "none", "rated for 30 V"),
]


@pytest.mark.parametrize(("text", "name", "reason"), AUTOMATIC)
def test_the_automatic_part_is_left_out_where_it_cannot_be(
    design_dir: Path, tmp_path: Path, text: str, name: str, reason: str
) -> None:
    design = derive(load(_mine(design_dir, tmp_path, text, base="../fingertip.toml")))
    choice = next(c for c in design.choices if c.field == "emitter.switch")
    assert choice.value == repr(name)
    assert reason in choice.reason
    assert (design.packages.switch is None) == (name == "none")


def test_a_controller_without_a_pin_leaves_the_leds_on(design_dir: Path, tmp_path: Path) -> None:
    parts = Path(shutil.copytree(design_dir, tmp_path / "design"))
    file = parts / "parts" / "controllers.toml"
    file.write_text(file.read_text().replace('emitter_pin = "D5"\n', ""))
    design = derive(load(parts / "fingertip.toml"))
    choice = next(c for c in design.choices if c.field == "emitter.switch")
    assert choice.value == "'none'"
    assert "has no emitter_pin" in choice.reason


def test_without_a_board_the_wire_goes_to_the_controller(design_dir: Path, tmp_path: Path) -> None:
    text = "[breakout]\nenabled = false\n[flange]\nenabled = false\n"
    design = derive(load(_mine(design_dir, tmp_path, text, base="../fingertip.toml")))
    lit, read, switching = design.cabling.cables
    assert [wire.end.board for wire in lit.wires] == ["supply", "supply"]
    (wire,) = switching.wires
    assert (wire.signal, wire.start.pin, wire.end.board, wire.end.pin) == (
        "LED",
        "3",
        "controller",
        "D5",
    )
    assert abs(switching.length_mm - read.length_mm) < lit.length_mm - switching.length_mm


@needs_ngspice
def test_the_slowest_detector_is_dark_after_the_wait(
    designs: Callable[[str], Design], tmp_path: Path
) -> None:
    """From full light to none: ngspice against the closed form."""
    electrical, ohm = designs("switched").electrical, designs("switched").wiring.pull_up_ohm
    channel, ambient = electrical.channel, electrical.ambient
    assert ambient is not None
    gain, base_pf = channel.gain[1], channel.base_pf[1]
    light_us = math.ceil(ambient.light_us)
    netlist = f"""\
* a detector whose light goes off
Vs s 0 {channel.supply_v}
R1 s c {ohm}
C1 c 0 {channel.detector_pf}p
Q1 c b 0 det
I1 c b pulse({channel.light_current_ua / gain:g}u 0 5000u 1u 1u 1)
.model det npn(is=1e-14 bf={gain} br=2 cjc={base_pf}p mjc=0 cje={base_pf}p mje=0)
.options abstol=1e-15 chgtol=1e-17 gmin=1e-14
.control
tran 2u 10000u 0 2u
meas tran v_dark find v(c) at={5000 + light_us}u
let wrong = 255*({channel.supply_v}-v_dark)/{channel.supply_v}
print wrong
.endc
.end
"""
    wrong = simulated(netlist, tmp_path)["wrong"]
    assert 0.7 * ambient.near_counts < wrong <= ambient.near_counts


def _mine(design_dir: Path, tmp_path: Path, text: str, base: str = "published.toml") -> Path:
    """A parameter file beside a copy of the presets."""
    folder = Path(shutil.copytree(design_dir, tmp_path / "mine"))
    file = folder / "presets" / "mine.toml"
    file.write_text(f'extends = "{base}"\n{text}')
    return file
