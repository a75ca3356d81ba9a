"""Symbols that only auxiliary boards have: supplies and the controller. y up, in mm."""

import math

from lumitip_fab.boards.kicad.schematic.symbols import PIN_MM, box, hand_drawn, line, pin, symbol
from lumitip_fab.boards.kicad.sexpr import Node
from lumitip_fab.design import Component

WIDE_MM = 15.24
"""Width of the box of a part with named pins."""
_TURNS = 4


def upright(kind: str) -> tuple[str, Node] | None:
    """Name and symbol of a part with two terminals, first at the top; none of other kinds."""
    match kind:
        case "resistor":
            return "R", hand_drawn()["R"]
        case "capacitor":
            return "C", hand_drawn()["C"]
        case "fuse":
            return "F", _two("F", [box(-0.762, -2.54, 0.762, 2.54), line((0, 2.54), (0, -2.54))])
        case "tvs diode":
            band = line((-1.778, 0.762), (-1.27, 1.27), (1.27, 1.27), (1.778, 1.778))
            anode = line((-1.27, -1.27), (1.27, -1.27), (0, 1.27), (-1.27, -1.27))
            return "D_TVS", _two("D", [band, anode], 1.27)
        case "inductor":
            return "L", _two("L", [_coil()])
        case "crystal":
            quartz = box(-1.27, -0.635, 1.27, 0.635)
            plates = [line((-1.27, y), (1.27, y)) for y in (1.27, -1.27)]
            return "Y", _two("Y", [quartz, *plates], 1.27)
    return None


def transistor(device: Component) -> Node:
    """A P-channel MOSFET: gate to the left, source above, drain below, its diode to the right."""
    number = {name: land for (land, _), name in zip(device.nets, device.pins, strict=True)}
    return symbol(
        "Q",
        [
            line((-2.54, 0), (-0.508, 0)),
            line((-0.508, 1.905), (-0.508, -1.905)),
            *(line((0.127, y + 0.508), (0.127, y - 0.508)) for y in (1.524, 0, -1.524)),
            line((0.127, 1.524), (2.54, 1.524), (2.54, 2.54)),
            line((0.127, -1.524), (2.54, -1.524), (2.54, -2.54)),
            line((0.127, 0), (1.524, 0), (1.524, 1.524)),  # the body is at the source
            line((0.635, 0.381), (1.27, 0), (0.635, -0.381), (0.635, 0.381)),
            line((2.54, 1.524), (3.556, 1.524), (3.556, -1.524), (2.54, -1.524)),
            line((3.048, 0.381), (4.064, 0.381)),
            line((3.556, 0.381), (3.048, -0.381), (4.064, -0.381), (3.556, 0.381)),
        ],
        [
            pin(number["G"], -5.08, 0, 0, PIN_MM, "G"),
            pin(number["S"], 2.54, 5.08, 270, PIN_MM, "S"),
            pin(number["D"], 2.54, -5.08, 90, PIN_MM, "D"),
        ],
    )


def chip(device: Component, pitch_mm: float) -> Node:
    """A box with the names of those pins that are joined, first at the top."""
    names = dict(zip((land.number for land in device.footprint.pads), device.pins, strict=True))
    half = len(device.nets) / 2 * pitch_mm
    pins = [
        pin(number, 5.08, half - (i + 0.5) * pitch_mm, 180, PIN_MM, names[number])
        for i, (number, _) in enumerate(device.nets)
    ]
    body = box(PIN_MM - WIDE_MM, -half, PIN_MM, half, fill="background")
    return symbol("U", [body], pins, shown=True)


def _two(prefix: str, body: list[Node], half_mm: float = 2.54) -> Node:
    reach = 3.81 - half_mm
    return symbol(prefix, body, [pin("1", 0, 3.81, 270, reach), pin("2", 0, -3.81, 90, reach)])


def _coil() -> Node:
    """Half circles, one below the other."""
    radius = 2.54 / _TURNS
    angles = [math.radians(step * 15) for step in range(13)]
    return line(
        *(
            (radius * math.sin(a), 2.54 - (2 * turn + 1) * radius + radius * math.cos(a))
            for turn in range(_TURNS)
            for a in angles
        )
    )
