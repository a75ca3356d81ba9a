"""A string's current source with its two resistors, and its symbol."""

from lumitip_fab.boards.kicad.schematic import symbols
from lumitip_fab.boards.kicad.schematic.sheet import Sheet
from lumitip_fab.boards.kicad.sexpr import Node
from lumitip_fab.design import Component, Point

_HALF_MM, _SET_MM = 7.62, 7.62  # half the width of its box; OUT to SET
WIDTH_MM = 41.91
"""From the end of the wire that feeds it to that of the wire at its resistors."""


def symbol(part: Component) -> Node:
    """A box with IN to the left, OUT and SET to the right; leads of one name are one pin."""
    reach = _HALF_MM + symbols.PIN_MM
    places = {"IN": (-reach, 0.0, 0), "OUT": (reach, 0.0, 180), "SET": (reach, -_SET_MM, 180)}
    pins, names = [], set()
    for number, _ in part.nets:
        name = part.pins[int(number) - 1]
        pins.append(symbols.pin(number, *places[name], symbols.PIN_MM, name, hide=name in names))
        names.add(name)
    body = symbols.box(-_HALF_MM, _SET_MM / 2, _HALF_MM, -_SET_MM * 1.5, fill="background")
    return symbols.symbol("U", [body], pins, shown=True)


def draw(name: str, parts: tuple[Component, Component, Component], sheet: Sheet, at: Point) -> None:
    """The source and its resistors on a line from the left.

    Args:
        name: of the symbol.
        parts: the source, the resistor at its OUT, and that at its SET.
        sheet: drawn on.
        at: end of the wire that feeds it.
    """
    source, out, setting = parts
    x, y = at
    middle, lower = x + _HALF_MM + 2 * symbols.PIN_MM, y + _SET_MM
    sheet.wire((x, y), (x + symbols.PIN_MM, y))
    sheet.part(name, source, (middle, y), ref_at=(-5.08, -5.08), value_at=(3.81, -5.08))
    right = middle + _HALF_MM + symbols.PIN_MM
    resistor, end = right + 8.89, x + WIDTH_MM
    for part, line, way in ((out, y, 90), (setting, lower, 270)):
        sheet.wire((right, line), (resistor - 3.81, line))
        sheet.flag(part.nets[0][1], (right + 2.54, line), way)
        sheet.part("R", part, (resistor, line), 90, ref_at=(0, -2.54), value_at=(0, 2.54))
        sheet.wire((resistor + 3.81, line), (end, line))
    sheet.wire((end, lower), (end, y))
    sheet.junctions.append((end, y))
