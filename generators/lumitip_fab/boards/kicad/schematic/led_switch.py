"""The transistor that switches the LEDs, with the pull-down at its gate."""

from lumitip_fab.boards.kicad.schematic import mosfets
from lumitip_fab.boards.kicad.schematic.sheet import Block, Sheet
from lumitip_fab.boards.model import GROUND
from lumitip_fab.design import Component, Point

_NAME = "LED_switch"
_TALL_MM, _WIDE_MM = 43.18, 60.96
_DOWN_MM = 7.62  # from the gate's line to the middle of its resistor


def block(transistor: Component, pull_down: Component) -> Block:
    """Gate line from the left, the resistor below it, drain above and source below."""

    def draw(sheet: Sheet, at: Point) -> None:
        _draw(transistor, pull_down, sheet, at)

    return Block(_WIDE_MM, _TALL_MM, draw, {_NAME: mosfets.switch(transistor)})


def _draw(transistor: Component, pull_down: Component, sheet: Sheet, at: Point) -> None:
    nets = dict(zip(transistor.pins, (net for _, net in transistor.nets), strict=True))
    x, y = at[0] + 30.48, at[1] + 20.32
    sheet.texts.append(("Switch of the LEDs", (at[0], at[1] + 5.08), 2.5))
    sheet.part(_NAME, transistor, (x, y), ref_at=(8.89, -1.27), value_at=(10.16, 1.27))
    gate, node = x - 5.08, x - 12.7
    sheet.flag(nets["G"], (node - 5.08, y), 180)
    sheet.wire((node - 5.08, y), (node, y))
    sheet.wire((node, y), (gate, y))
    sheet.junctions.append((node, y))
    middle = y + _DOWN_MM
    sheet.wire((node, y), (node, middle - 3.81))
    sheet.part("R", pull_down, (node, middle), ref_at=(-3.81, -1.27), value_at=(-5.08, 1.27))
    sheet.wire((node, middle + 3.81), (node, middle + 5.08))
    sheet.power(GROUND, (node, middle + 5.08))
    sheet.wire((x + 2.54, y - 5.08), (x + 2.54, y - 7.62), (x + 7.62, y - 7.62))
    sheet.flag(nets["D"], (x + 7.62, y - 7.62), 0)
    sheet.wire((x + 2.54, y + 5.08), (x + 2.54, middle + 5.08))
    sheet.power(GROUND, (x + 2.54, middle + 5.08))
