"""Symbols of MOSFETs."""

from lumitip_fab.boards.kicad.schematic.symbols import PIN_MM, line, pin, symbol
from lumitip_fab.boards.kicad.sexpr import Node
from lumitip_fab.design import Component


def transistor(part: Component) -> Node:
    """A P-channel MOSFET: gate to the left, source above, drain below, its diode to the right."""
    body = [
        line((0.127, 0), (1.524, 0), (1.524, 1.524)),  # the body is at the source
        line((0.635, 0.381), (1.27, 0), (0.635, -0.381), (0.635, 0.381)),
    ]
    return _mosfet(part, body, ("S", "D"))


def switch(part: Component) -> Node:
    """An N-channel MOSFET: gate to the left, drain above, source below, its diode to the right."""
    body = [
        line((0.127, 0), (1.524, 0), (1.524, -1.524)),  # the body is at the source
        line((1.27, 0.381), (0.635, 0), (1.27, -0.381), (1.27, 0.381)),
    ]
    return _mosfet(part, body, ("D", "S"))


def _mosfet(part: Component, body: list[Node], ends: tuple[str, str]) -> Node:
    """A MOSFET between two leads, the upper one first; its diode conducts upwards."""
    number = {name: land for (land, _), name in zip(part.nets, part.pins, strict=True)}
    upper, lower = ends
    return symbol(
        "Q",
        [
            line((-2.54, 0), (-0.508, 0)),
            line((-0.508, 1.905), (-0.508, -1.905)),
            *(line((0.127, y + 0.508), (0.127, y - 0.508)) for y in (1.524, 0, -1.524)),
            line((0.127, 1.524), (2.54, 1.524), (2.54, 2.54)),
            line((0.127, -1.524), (2.54, -1.524), (2.54, -2.54)),
            *body,
            line((2.54, 1.524), (3.556, 1.524), (3.556, -1.524), (2.54, -1.524)),
            line((3.048, 0.381), (4.064, 0.381)),
            line((3.556, 0.381), (3.048, -0.381), (4.064, -0.381), (3.556, 0.381)),
        ],
        [
            pin(number["G"], -5.08, 0, 0, PIN_MM, "G", "input"),
            pin(number[upper], 2.54, 5.08, 270, PIN_MM, upper),
            pin(number[lower], 2.54, -5.08, 90, PIN_MM, lower),
        ],
    )
