"""Sheets of auxiliary boards: symbols that say what a part is, pins under their own names."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip_fab.checks.readers.kicad_shapes import Node, child, children, read_nodes, words
from lumitip_fab.design import Design

SLOW = [pytest.param(preset, marks=pytest.mark.slow) for preset in ("small", "integrated")]


@pytest.fixture(params=["published", *SLOW])
def flange(
    boards: Callable[[str], Path], designs: Callable[[str], Design], request: pytest.FixtureRequest
) -> tuple[Design, Node]:
    """A design, and the sheet of its flange's board."""
    sheet = boards(request.param) / "boards/flange/flange.kicad_sch"
    return designs(request.param), read_nodes(sheet)


def _properties(symbol: Node) -> dict[str, str]:
    return {told[0]: told[1] for told in map(words, children(symbol, "property"))}


def _shapes(sheet: Node) -> dict[str, Node]:
    return {words(shape)[0]: shape for shape in children(child(sheet, "lib_symbols"), "symbol")}


def test_a_symbol_s_letter_is_its_part_s(flange: tuple[Design, Node]) -> None:
    """Or KiCad would number the parts anew under other letters."""
    _, sheet = flange
    shapes = _shapes(sheet)
    letters = {
        _properties(symbol)["Reference"]: _properties(shapes[words(child(symbol, "lib_id"))[0]])[
            "Reference"
        ]
        for symbol in children(sheet, "symbol")
    }
    assert {"F1", "Q1", "L1", "U1", "J1", "C1"} <= set(letters)
    assert all(re.fullmatch(rf"{letter}\d+", ref) for ref, letter in letters.items()), letters


def test_pins_have_the_names_of_their_leads(flange: tuple[Design, Node]) -> None:
    design, sheet = flange
    shapes = _shapes(sheet)
    drawn = {_properties(symbol)["Reference"]: symbol for symbol in children(sheet, "symbol")}
    (auxiliary,) = (c for c in design.auxiliary_boards if c.name == "flange")
    named = [d for d in auxiliary.components if d.nets and d.pins and not d.contacts]
    assert {"Q1", "U1"} <= {device.ref for device in named}
    for device in named:
        shape = shapes[words(child(drawn[device.ref], "lib_id"))[0]]
        pins = {
            words(child(pin, "number"))[0]: words(child(pin, "name"))[0]
            for unit in children(shape, "symbol")
            for pin in children(unit, "pin")
        }
        lands = [land.number for land in device.footprint.pads]
        leads = dict(zip(lands, device.pins, strict=True))
        assert pins == {number: leads[number] for number, _ in device.nets}
