"""Current sources of the strings: by ngspice, by rules, and damages of their board."""

import dataclasses
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import in_part, swapped_pads
from damages import failing
from lumitip_fab.boards.spice import simulation
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.auto.resolve import resolve
from lumitip_fab.derive.wiring.sources import source_string
from lumitip_fab.design import Design
from lumitip_fab.errors import InputError
from spice_runs import needs_ngspice, simulated

EMITTER = "boards/emitter/emitter.kicad_pcb"
ENDS = ("i_0_0", "i_0_1", "i_1_0", "i_1_1")
MOST_CHANGE = 0.03
MOST_SHARE = 0.6


@pytest.fixture(scope="module")
def regulated(design_dir: Path) -> Design:
    return derive(load(design_dir / "fingertip.toml"))


def _ends(design: Design, folder: Path) -> dict[str, float]:
    made, *_ = simulation(design, design.emitter)
    return simulated(made.data.decode(), folder)


def _with_leds(design: Design, sign: float) -> Design:
    """LEDs at one end of their forward voltage."""
    strings = design.electrical.strings
    forward_v = strings.forward_v + sign * strings.forward_tolerance_v
    strings = dataclasses.replace(strings, forward_v=forward_v)
    return dataclasses.replace(
        design, electrical=dataclasses.replace(design.electrical, strings=strings)
    )


@needs_ngspice
@pytest.mark.parametrize("sign", [-1.0, 0.0, 1.0])
def test_ngspice_holds_the_current_over_supply_and_temperature(
    regulated: Design, sign: float, tmp_path: Path
) -> None:
    found = _ends(_with_leds(regulated, sign), tmp_path)
    held = regulated.electrical.strings.regulation
    assert held
    assert found["i_ma"] == pytest.approx(regulated.wiring.current_ma[0], rel=0.003)
    worst = max(abs(found[end] / found["i_ma"] - 1) for end in ENDS)
    assert worst <= MOST_CHANGE
    assert worst <= held.change + 0.001  # the closed form is not below it


@needs_ngspice
def test_ngspice_loses_the_current_where_the_supply_is_too_low(
    regulated: Design, tmp_path: Path
) -> None:
    held = regulated.electrical.strings.regulation
    assert held
    volts = regulated.wiring.supply_v - held.left_v - 3.0
    wiring = dataclasses.replace(regulated.wiring, supply_v=volts)
    low = _with_leds(dataclasses.replace(regulated, wiring=wiring), 1.0)
    found = _ends(low, tmp_path)
    assert found["i_0_0"] < 0.9 * regulated.wiring.current_ma[0]


def test_a_source_keeps_its_rules(regulated: Design) -> None:
    held = regulated.electrical.strings.regulation
    assert held
    assert held.change <= MOST_CHANGE
    assert held.power_w <= MOST_SHARE * held.rated_w
    assert held.left_v >= 0
    assert len(regulated.wiring.set_ohm) == len(regulated.wiring.strings)
    assert all(part.side == "front" for part in regulated.emitter.parts)
    assert regulated.emitter.reliefs == ()


@pytest.mark.parametrize("current_ma", [0.5, 2.0, 8.0, 15.0, 20.0, 50.0])
def test_sold_resistors_set_any_current(design_dir: Path, current_ma: float) -> None:
    config = load(design_dir / "fingertip.toml")
    string = source_string(config, 4, current_ma)
    assert string.nominal_ma == pytest.approx(current_ma, rel=0.01)
    assert string.set_ohm
    set_v = config.parts.emitter.source.set_ua * 1e-6 * string.set_ohm
    assert 0.4 <= set_v <= 0.8


def _drive(design_dir: Path, tmp_path: Path, text: str) -> tuple[str, str]:
    """Chosen drive of a parameter file, and the reason."""
    folder = shutil.copytree(design_dir, tmp_path / "design")
    path = folder / "mine.toml"
    path.write_text(f'extends = "fingertip.toml"\n{text}')
    resolved = resolve(load(path))
    reasons = {choice.field: choice.reason for choice in resolved.design.choices}
    return resolved.config.parameters.emitter.drive, reasons.get("emitter.drive", "")


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    ("text", "drive", "reason"),
    [
        ("[supply]\nvoltage_v = 12.0\n", "source", "holds the current"),
        ("[supply]\nvoltage_v = 5.0\n", "resistor", "do not fit"),
        ("[supply]\nvoltage_v = 4.0\n[flange]\nenabled = false\n", "resistor", "does not feed"),
        ('[emitter]\nresistor_side = "back"\n', "resistor", "resistor_side"),
        ('[emitter]\ndrive = "resistor"\n', "resistor", ""),
    ],
)
def test_resistors_where_sources_do_not_work(
    design_dir: Path, tmp_path: Path, text: str, drive: str, reason: str
) -> None:
    chosen, why = _drive(design_dir, tmp_path, text)
    assert chosen == drive
    assert reason in why


def test_a_written_source_that_does_not_work_is_refused(design_dir: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"emitter\.drive.*at the worst case"):
        _drive(
            design_dir,
            tmp_path,
            '[supply]\nvoltage_v = 3.0\n[flange]\nenabled = false\n[emitter]\ndrive = "source"\n',
        )


def set_resistor_larger(text: str) -> str:
    return in_part(text, "R5", r'value "75K"', 'value "82K"')


def set_resistor_far_larger(text: str) -> str:
    return in_part(text, "R5", r'value "75K"', 'value "750K"')


def out_resistor_smaller(text: str) -> str:
    return in_part(text, "R1", r'value "39R"', 'value "10R"')


def leads_swapped(text: str) -> str:
    """OUT and SET of U1."""
    return swapped_pads(text, "U1", "4", "5")


def source_turned(text: str) -> str:
    """U1 turned by half: IN where OUT was."""
    turned = text
    for one, other in (("1", "5"), ("2", "6"), ("3", "7"), ("4", "8")):
        turned = swapped_pads(turned, "U1", one, other)
    return turned


def source_lost(text: str) -> str:
    return in_part(text, "U1", r'reference "U1"', 'reference "X1"')


def source_taller(text: str) -> str:
    return in_part(text, "U1", r"(SOT\w+X)100-8N", r"\g<1>190-8N")


DAMAGES: dict[Callable[[str], str], set[str]] = {
    set_resistor_larger: {"current"},
    set_resistor_far_larger: {"current", "source_headroom"},
    out_resistor_smaller: {"current", "source_load"},
    leads_swapped: {"sources", "current", "lands"},
    source_turned: {
        "sources",
        "current",
        "strings",
        "lands",
        "source_load",
        "source_headroom",
        "silk_marks",
    },
    source_lost: {"sources", "current", "strings", "source_load", "source_headroom"},
    source_taller: {"height_front", "lands"},
}


@pytest.mark.slow
@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_a_source(
    damage: Callable[[str], str], boards: Callable[[str], Path], tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(boards("asymmetric"), tmp_path / "damaged"))
    path = folder / EMITTER
    before = path.read_text()
    assert re.search(r'value "39R"', before)
    path.write_text(damage(before))
    assert path.read_text() != before
    assert failing(folder, "board", "emitter") == DAMAGES[damage]
