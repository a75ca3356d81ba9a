"""Parts that the manual lists together: a string's, and the photodetectors of a multiplexer."""

from pathlib import Path

import pytest

from lumitip_fab.boards.fab.groups import groups
from lumitip_fab.boards.placement import place
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design

DESIGN = Path(__file__).parents[2] / "design"


@pytest.fixture(params=["fingertip.toml", "presets/published.toml", "presets/dense.toml"])
def design(request: pytest.FixtureRequest) -> Design:
    return derive(load(DESIGN / request.param))


def test_each_string_has_its_leds_and_what_sets_its_current(design: Design) -> None:
    found = groups(place(design, design.emitter), design.wiring.adc_pins)
    assert [group["name"] for group in found] == [
        f"string {n}" for n in range(1, len(design.wiring.strings) + 1)
    ]
    sources = 1 if design.wiring.set_ohm else 0
    for group, cells in zip(found, design.wiring.strings, strict=True):
        refs = group["refs"]
        assert {ref for ref in refs if ref[0] == "D"} >= {f"D{cell + 1}" for cell in cells}
        assert sum(ref[0] == "D" for ref in refs) == len(cells)
        assert sum(ref[0] == "U" for ref in refs) == sources
        assert sum(ref[0] == "R" for ref in refs) == 1 + sources


def test_each_multiplexer_has_the_cells_that_it_reads(design: Design) -> None:
    found = groups(place(design, design.receiver), design.wiring.adc_pins)
    pins = design.wiring.adc_pins
    assert {group["name"]: set(group["refs"]) for group in found} == {
        f"U{which + 1}, read at {pin}": {
            f"Q{cell.index + 1}" for cell in design.cells if cell.adc_pin == pin
        }
        for which, pin in enumerate(pins)
    }


def test_a_board_without_cells_has_none(design: Design) -> None:
    breakout = next(b for b in design.auxiliary_boards if b.name == "breakout")
    assert groups(place(design, breakout), design.wiring.adc_pins) == []
