"""Blocks of the sheets: wires with test points, strings of LEDs, and parts by themselves."""

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from lumitip_fab.boards.kicad.schematic import symbols
from lumitip_fab.boards.kicad.schematic.sheet import Block, Sheet
from lumitip_fab.boards.kicad.schematic.symbols import GRID_MM, PITCH_MM
from lumitip_fab.boards.model import AT_CELLS, GROUND
from lumitip_fab.design import Component, Point, Wiring

ROW_MM = 7.62
"""Between the lines that a row of parts hangs on."""
_COLUMN_MM = 50.8  # width of a part by itself, and of the wires
Parts = Mapping[str, Component]


def wires_block(parts: Parts, supply: str) -> Block:
    """The connector J1 with a test point at each of its wires."""
    ways = len(parts["J1"].nets)
    shape = symbols.contacts(tuple(str(i + 1) for i in range(ways)), ROW_MM)
    height_mm = ways * ROW_MM + 25.4
    return Block(_COLUMN_MM, height_mm, partial(_wires, parts, supply), {"Wires": shape})


def _wires(parts: Parts, supply: str, sheet: Sheet, at: Point) -> None:
    """The connector with a row for each wire, and what the parts at the cells are."""
    wires = parts["J1"]
    ways = len(wires.nets)
    x, first = at[0] + 10.16, at[1] + 17.78
    sheet.texts.append(("Wires", (at[0] + 2.54, at[1] + 5.08), 2.5))
    cells = [part for part in parts.values() if part.kind in AT_CELLS]
    caption = f"{cells[0].ref} to {cells[-1].ref}: {cells[0].value}"
    below = first + ways * ROW_MM + 2.54
    sheet.texts.append((caption, (at[0] + 2.54, below), 1.5))
    middle = first + (ways - 1) / 2 * ROW_MM
    sheet.part("Wires", wires, (x, middle), ref_at=(0, -ways / 2 * ROW_MM - 1.27))
    for i, (_, net) in enumerate(wires.nets):
        y = first + i * ROW_MM
        probe, end = x + 12.7, x + 25.4
        sheet.part("TestPoint", parts[f"TP{i + 1}"], (probe, y), ref_at=(3.048, -3.302))
        if net == supply:
            end += ROW_MM  # or it would point into ground, which is the row above
        corners = [(x + 5.08, y), (probe, y), (end, y)]
        sheet.junctions.append((probe, y))
        if net in (GROUND, supply):
            corners.insert(2, (x + 19.05, y))
            sheet.junctions.append((x + 19.05, y))
            sheet.power("PWR_FLAG", (x + 19.05, y))
            sheet.power(net, (end, y))
        else:
            sheet.flag(net, (end, y), 0)
        sheet.wire(*corners)


_LED_MM = 12.7
_STRING_MM = 22.86
_STRING_START_MM = 30.48


def string_blocks(
    parts: Parts, supply: str, cathodes: str, wiring: Wiring, marked: str
) -> Iterator[Block]:
    """A block for each string of LEDs with its resistor, then those of their switch."""
    for number, string in enumerate(wiring.strings, start=1):
        width_mm = _STRING_START_MM + len(string) * _LED_MM + 20.32
        current_ma = wiring.current_ma[number - 1]
        draw = partial(_string, parts, (supply, cathodes), number, string, current_ma)
        yield Block(width_mm, _STRING_MM, draw, {"LED": symbols.led(marked)})
    if wiring.emitter_pin is not None:
        yield Block(0.0, ROW_MM, _switch_title, {})
        yield part_block(parts["Q1"])
        yield part_block(parts[wiring.pull_down_ref])


def _string(
    parts: Parts,
    ends: tuple[str, str],
    number: int,
    string: Sequence[int],
    current_ma: float,
    sheet: Sheet,
    at: Point,
) -> None:
    (supply, cathodes), x, y = ends, at[0], at[1] + 12.7
    caption = f"String {number}: {len(string)} LEDs, {current_ma:.1f} mA"
    sheet.texts.append((caption, (x, y - 10.16), 1.8))
    sheet.power(supply, (x + 5.08, y))
    resistor = parts[f"R{number}"]
    sheet.wire((x + 5.08, y), (x + 8.89, y))
    sheet.part("R", resistor, (x + 12.7, y), 90, ref_at=(0, -2.54), value_at=(0, 2.54))
    end = x + 16.51
    for place, cell in enumerate(string):
        middle = x + _STRING_START_MM + place * _LED_MM
        sheet.wire((end, y), (middle - 3.81, y))
        sheet.flag(f"S{number}_{place}", ((end + middle - 3.81) / 2 // 1.27 * 1.27, y), 270)
        sheet.part("LED", parts[f"D{cell + 1}"], (middle, y), ref_at=(0, -5.08))
        end = middle + 3.81
    sheet.wire((end, y), (end + 5.08, y))
    if cathodes == GROUND:
        sheet.power(GROUND, (end + 5.08, y))
    else:
        sheet.flag(cathodes, (end + 5.08, y), 0)


def _switch_title(sheet: Sheet, at: Point) -> None:
    sheet.texts.append(("Switch of the LEDs", (at[0], at[1] + ROW_MM), 1.8))


_ABOVE_MM = 12.7  # of a part, for its reference
_UPRIGHT_MM = 25.4  # a part whose terminals are above and below
_LETTER_MM = 1.2
_LABEL_MM = 5.08  # wire from a pin to its label


_UPPER_LEAD = {"transistor": "S", "switch": "D"}


def heading(words: str) -> Block:
    """The title of parts by themselves."""
    return Block(0.0, 0.0, lambda sheet, at: sheet.texts.append((words, at, 2.5)))


def part_block(part: Component) -> Block:
    """A part by itself, with the names of its nets at its pins."""
    name, shape = symbols.of_part(part)
    tall_mm, draw = _UPRIGHT_MM, _two
    if part.kind in _UPPER_LEAD:
        draw = _transistor
    elif part.kind not in symbols.TWO_TERMINALS:
        tall_mm, draw = len(part.nets) * PITCH_MM + _ABOVE_MM, _row
    joined = {number for number, _ in part.nets}
    pads = part.footprint.pads if part.contacts else ()
    left_open = [pad.number for pad in pads if pad.number not in joined]

    def drawn(sheet: Sheet, at: Point) -> None:
        draw(part, name, sheet, at)
        if left_open:
            words, y = f"open: {', '.join(left_open)}", at[1] + tall_mm + PITCH_MM
            sheet.texts.append((words, (at[0], y), 1.27))

    return Block(_COLUMN_MM, tall_mm, drawn, {name: shape})


def _middle(at: Point) -> Point:
    """Middle of an upright part below a place, on the grid."""
    x, y = at
    return (x + 4 * PITCH_MM) // GRID_MM * GRID_MM, (y + _UPRIGHT_MM / 2) // GRID_MM * GRID_MM


def _beside(words: str, edge_mm: float, y_mm: float) -> Point:
    """Middle of a text that begins at an edge, or ends there on the left."""
    return edge_mm + math.copysign(len(words) * _LETTER_MM / 2, edge_mm), y_mm


def _transistor(part: Component, symbol: str, sheet: Sheet, at: Point) -> None:
    """Its channel upright, its gate to the left."""
    x, y = _middle(at)
    shown = _beside(part.ref, 5.08, -1.27), _beside(part.value, 5.08, 1.27)
    sheet.part(symbol, part, (x, y), ref_at=shown[0], value_at=shown[1])
    nets = dict(zip(part.pins, (net for _, net in part.nets), strict=True))
    sheet.wire((x - _LABEL_MM, y), (x - 1.5 * _LABEL_MM, y))
    sheet.flag(nets["G"], (x - 1.5 * _LABEL_MM, y), 180)
    upper = _UPPER_LEAD[part.kind]
    for name, way in ((upper, -1), ("D" if upper == "S" else "S", 1)):
        beside = x + 2 * _LABEL_MM, y + way * 7.62
        sheet.wire((x + 2.54, y + way * 5.08), (x + 2.54, beside[1]), beside)
        sheet.flag(nets[name], beside, 0)


def _two(part: Component, symbol: str, sheet: Sheet, at: Point) -> None:
    """A part with two terminals, upright, each with the name of its net."""
    x, y = _middle(at)
    shown = _beside(part.ref, -2.54, -1.27), _beside(part.value, -2.54, 1.27)
    sheet.part(symbol, part, (x, y), ref_at=shown[0], value_at=shown[1])
    for (_, net), way in zip(part.nets, (-1, 1), strict=True):
        sheet.wire((x, y + way * 3.81), (x, y + way * 7.62), (x + _LABEL_MM, y + way * 7.62))
        sheet.flag(net, (x + _LABEL_MM, y + way * 7.62), 0)


def _row(part: Component, symbol: str, sheet: Sheet, at: Point) -> None:
    """A row of contacts, first at the top, each with the name of its net."""
    ways = len(part.nets)
    # A row of contacts is drawn to the right of its place, a chip to the left.
    x, first = at[0] + (2.54 if part.contacts else 12.7), at[1] + _ABOVE_MM
    middle, end = first + (ways - 1) / 2 * PITCH_MM, ways / 2 * PITCH_MM + 1.27
    sheet.part(symbol, part, (x, middle), ref_at=(0, -end), value_at=(0, end))
    for i, (_, net) in enumerate(part.nets):
        y = first + i * PITCH_MM
        sheet.wire((x + _LABEL_MM, y), (x + 2 * _LABEL_MM, y))
        sheet.flag(net, (x + 2 * _LABEL_MM, y), 0)
