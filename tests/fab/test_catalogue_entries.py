"""Every LED, detector, film, silicone, printer and controller in the published design's place."""

import math
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.config.load import Input
from lumitip_fab.config.parts import NAMED
from lumitip_fab.derive import derive
from lumitip_fab.design import Design

PARTS = Path(__file__).parents[2] / "design" / "parts"
FIELDS = (
    "emitter.led",
    "receiver.photodetector",
    "mask.film",
    "mould.silicone",
    "printer.profile",
    "controller.board",
)
LEAST = {"leds": 5, "photodetectors": 4, "films": 2, "silicones": 2, "printers": 4}
OWN_PINS = {"arduino_nano_33_ble", "arduino_nano_rp2040_connect", "arduino_nano_esp32"}
COOL = {"emitter.current_ma": 10.0, "emitter.resistor": "1210"}
NEEDED: dict[str, dict[str, Any]] = {
    "VSMY1850": COOL | {"emitter.string_leds": 11},
    "VSMB1940X01": COOL,
    "APT1608F3C": COOL,
    "XL-1608HIRC-850": COOL,
    "TPU 150um": {"stack.film_mm": 0.15},
    "TPU black 100um": {"mask.route": "cut"},
    "vinyl black 70um": {"mask.route": "cut", "stack.film_mm": 0.07},
    "fdm 0.6": {"tip.edge_mm": 0.65, "mould.wall_mm": 2.5},
}
"""What an entry asks of other fields."""


def _entries(field: str) -> dict[str, Any]:
    return tomllib.loads((PARTS / f"{NAMED[field]}.toml").read_text(encoding="utf-8"))


CASES = [(field, name) for field in FIELDS for name in _entries(field)]


@pytest.mark.slow_cases
@pytest.mark.parametrize(("field", "name"), CASES)
def test_every_entry_derives_in_the_published_design(
    inputs: dict[str, Input],
    vary: Callable[..., Input],
    wiring_faults: Callable[[Design], Iterator[str]],
    field: str,
    name: str,
) -> None:
    config = vary(inputs["published"], {field: name, **NEEDED.get(name, {})})
    design = derive(config)
    assert list(wiring_faults(design)) == []
    assert len(design.layout) == 32
    assert config.parts_by_field()[field].source


@pytest.mark.parametrize("kind", LEAST)
def test_there_is_a_choice_of_each_kind(kind: str) -> None:
    entries = tomllib.loads((PARTS / f"{kind}.toml").read_text(encoding="utf-8"))
    assert len([name for name in entries if not name.startswith("generic")]) >= LEAST[kind]
    assert all(e["confidence"] and len(e["source"]) > 40 for e in entries.values())


def test_exponents_follow_from_the_half_angles_that_their_sources_name(
    inputs: dict[str, Input],
) -> None:
    parts = inputs["published"].catalogue
    half_deg = {"VSMY1850": 60, "VSMB1940X01": 60, "APT1608F3C": 75}
    detectors = {"TEMT7100X01": 60, "TEMT7000X01": 60}
    for entries, angles in ((parts.leds, half_deg), (parts.photodetectors, detectors)):
        for name, angle in angles.items():
            exponent = math.log(0.5) / math.log(math.cos(math.radians(angle)))
            assert entries[name].exponent == pytest.approx(exponent, abs=1e-3)
            assert f"{angle}°" in entries[name].source


def test_boards_of_the_nanos_shape_plug_into_the_same_sockets(inputs: dict[str, Input]) -> None:
    boards = inputs["published"].catalogue.controllers
    ble = boards["arduino_nano_33_ble"]
    for name in OWN_PINS:
        plug, like = boards[name].plug, ble.plug
        assert plug and like
        assert (plug.spacing_mm, plug.body_mm) == (like.spacing_mm, like.body_mm)
        for row, other in zip(plug.rows, like.rows, strict=True):
            assert [p for p in row if p not in {"B0", "B1", "REC"}] == [
                p for p, mine in zip(other, row, strict=True) if mine not in {"B0", "B1", "REC"}
            ]
        assert boards[name].select_pins == ble.select_pins


def test_an_rp2040_reads_as_many_multiplexers_as_it_has_inputs(
    inputs: dict[str, Input], vary: Callable[..., Input]
) -> None:
    config = vary(inputs["published"], {"controller.board": "arduino_nano_rp2040_connect"})
    assert derive(config).wiring.adc_pins == ("A0", "A1", "A2", "A3")
    board = config.catalogue.controllers["arduino_nano_rp2040_connect"]
    assert not {"A4", "A5", "A6", "A7"} & {*board.analog_pins}
