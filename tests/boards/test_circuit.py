"""What is connected to what on the boards, against the published circuit and the layout."""

import re
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest

from lumitip_fab.boards.circuit import circuit
from lumitip_fab.boards.placement import place
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Component, Design
from lumitip_fab.text import resistor_code

PRESETS = ("published", "asymmetric", "dense", "mux16")
# Leads of the 74HC4051 by its data sheet.
HC4051 = {
    "VCC": "16",
    "GND": "8",
    "VEE": "7",
    "E": "6",
    "Z": "3",
    "S0": "11",
    "S1": "10",
    "S2": "9",
}
HC4051_INPUTS = ("13", "14", "15", "12", "1", "5", "2", "4")


@pytest.fixture(scope="module")
def designs(design_dir: Path) -> dict[str, Design]:
    """Every preset, derived."""
    return {name: derive(load(design_dir / "presets" / f"{name}.toml")) for name in PRESETS}


def _circuit(design: Design, name: str) -> tuple[Component, ...]:
    finger = getattr(design, name)
    return circuit(design, finger)


def _pins(parts: tuple[Component, ...]) -> dict[str, list[tuple[str, str]]]:
    """Reference and pad of everything on each net."""
    found = defaultdict(list)
    for part in parts:
        for pad, net in part.nets:
            found[net].append((part.ref, pad))
    return found


@pytest.mark.slow_cases
@pytest.mark.parametrize("preset", PRESETS)
def test_current_passes_every_led_of_a_string_once(designs: dict[str, Design], preset: str) -> None:
    design = designs[preset]
    pins = _pins(_circuit(design, "emitter"))
    supply = design.emitter.connector.supply
    seen = []
    for number, string in enumerate(design.wiring.strings, start=1):
        net = f"S{number}_0"
        if design.wiring.set_ohm:
            setting = f"R{len(design.wiring.strings) + number}"
            assert {(f"U{number}", "7"), (f"U{number}", "8")} <= set(pins[supply])
            out = [(f"U{number}", lead) for lead in ("2", "3", "4")]
            assert sorted(pins[f"S{number}_OUT"]) == [(f"R{number}", "1"), *out]
            assert sorted(pins[f"S{number}_SET"]) == [(setting, "1"), (f"U{number}", "5")]
            assert (setting, "2") in pins[net]
        else:
            assert (f"R{number}", "1") in pins[supply]
        assert (f"R{number}", "2") in pins[net]
        for cell in string:
            ref = f"D{cell + 1}"
            assert (ref, "2") in pins[net], "the anode, as pad 1 is the marked cathode"
            net = next(n for n, on in pins.items() if (ref, "1") in on)
            seen.append(cell)
        assert net == ("GND" if design.packages.switch is None else "LEDK")
    assert sorted(seen) == list(range(len(design.layout)))
    between = [on for net, on in pins.items() if re.fullmatch(r"S\d+_[1-9]\d*", net)]
    assert len(between) == len(seen) - len(design.wiring.strings)
    assert all(len(on) == 2 for on in between)


@pytest.mark.parametrize("preset", PRESETS)
def test_every_detector_hangs_on_the_input_that_the_layout_says(
    designs: dict[str, Design], preset: str
) -> None:
    design = designs[preset]
    plan = _circuit(design, "receiver")
    pins, mux = _pins(plan), design.packages.multiplexer
    first = design.packages.photodetector.marked == "collector"
    collector, emitter = ("1", "2") if first else ("2", "1")
    for cell in design.layout.cells:
        ref = f"Q{cell.index + 1}"
        others = [pin for pin in pins[ref] if not pin[0].startswith("RN")]
        assert sorted(others) == sorted(
            [(ref, collector), (f"U{cell.mux + 1}", str(mux.inputs[str(cell.channel)]))]
        )
        assert len(pins[ref]) - len(others) == int(design.wiring.own_pull_ups)
        assert (ref, emitter) in pins["GND"]
        assert (f"U{cell.mux + 1}", str(mux.output)) in pins[cell.adc_pin]


def test_the_4051_is_wired_as_its_data_sheet_says(designs: dict[str, Design]) -> None:
    plan = _circuit(designs["published"], "receiver")
    nets = dict(next(part for part in plan if part.ref == "U2").nets)
    told = {name: nets[lead] for name, lead in HC4051.items()}
    assert told == {
        "VCC": "3V3",
        "GND": "GND",
        "VEE": "GND",
        "E": "GND",
        "Z": "A1",
        "S0": "S0",
        "S1": "S1",
        "S2": "S2",
    }
    layout = designs["published"].layout
    for channel, lead in enumerate(HC4051_INPUTS):
        (cell,) = np.flatnonzero((layout.mux == 1) & (layout.channel == channel))
        assert nets[lead] == f"Q{cell + 1}"


def test_the_published_parts_are_ordered_by_their_numbers(designs: dict[str, Design]) -> None:
    design = designs["published"]
    parts = {
        p.ref: (p.value, p.part, p.footprint.name)
        for name in ("emitter", "receiver")
        for p in _circuit(design, name)
        if p.part
    }
    assert parts["D1"] == ("15406085BA300", "15406085BA300", "LEDC1608X60N")
    assert parts["Q32"] == ("SML-H10TBT86", "SML-H10TBT86", "PTRC2012X80N")
    assert parts["U4"] == ("74HC4051PW", "74HC4051PW,118", "SOP65P640X110-16N")
    assert parts["R4"] == ("75K", "RC0603FR-0775KL", "RESC1608X50N")
    assert parts["C1"] == ("100nF", "CC0603KRX7R9BB104", "CAPC1608X90N")
    string_resistors = [p for p in _circuit(design, "emitter") if p.kind == "resistor"]
    assert [p.value for p in string_resistors] == ["150R", "150R"]


@pytest.mark.parametrize("preset", PRESETS)
def test_each_multiplexer_has_its_pull_up_and_capacitor_and_no_floating_input(
    designs: dict[str, Design], preset: str
) -> None:
    design = designs[preset]
    plan = _circuit(design, "receiver")
    parts = {part.ref: dict(part.nets) for part in plan}
    for i, pin in enumerate(design.wiring.adc_pins, start=1):
        if not design.wiring.own_pull_ups:
            assert parts[f"R{i}"] == {"1": "3V3", "2": pin}
        assert parts[f"C{i}"] == {"1": "3V3", "2": "GND"}
        assert len(parts[f"U{i}"]) == design.packages.multiplexer.leads


@pytest.mark.parametrize("preset", ["asymmetric", "mux16"])
def test_each_detector_has_a_pull_up_of_its_own_beside_its_multiplexer(
    designs: dict[str, Design], preset: str
) -> None:
    design = designs[preset]
    plan = _circuit(design, "receiver")
    arrays = [dict(part.nets) for part in plan if part.kind == "resistor array"]
    joined = [{nets[str(i)], nets[str(9 - i)]} - {"3V3"} for nets in arrays for i in (1, 2, 3, 4)]
    assert all(nets[str(i)] == "3V3" for nets in arrays for i in (5, 6, 7, 8))
    found = sorted(net for pair in joined for net in pair)
    assert found == sorted(f"Q{cell.index + 1}" for cell in design.layout.cells)
    assert not any(part.kind == "resistor" for part in plan)


@pytest.mark.slow_cases
@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("finger", ["emitter", "receiver"])
def test_every_signal_has_a_test_point_and_a_class(
    designs: dict[str, Design], preset: str, finger: str
) -> None:
    design = designs[preset]
    plan = _circuit(design, finger)
    points = {part.nets[0][1] for part in plan if part.kind == "test point"}
    signals = set(getattr(design, finger).connector.signals)
    assert points == signals
    nets = place(design, getattr(design, finger)).nets
    classes = {net.name: net.net_class for net in nets}
    assert len(classes) == len(nets)
    assert {n for n, kind in classes.items() if kind == "supply"} == signals & {
        "GND",
        "3V3",
        "24V",
        "12V",
    } | ({"LEDK"} & set(classes))
    assert set(classes) == {net for part in plan for _, net in part.nets}
    assert sum(part.kind == "fiducial" for part in plan) == 3


@pytest.mark.parametrize(
    ("ohm", "code"),
    [(150, "150R"), (75e3, "75K"), (4990, "4K99"), (10.2, "10R2"), (1e6, "1M"), (0.47, "0R47")],
)
def test_resistor_codes(ohm: float, code: str) -> None:
    assert resistor_code(ohm) == code
