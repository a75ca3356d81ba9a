"""Blocks of a finger's sheet: wires with test points, strings of LEDs, and what drives them."""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from lumitip_fab.boards.kicad.schematic import shapes, symbols
from lumitip_fab.boards.kicad.schematic.sheet import Block, Sheet
from lumitip_fab.boards.kicad.sexpr import Node
from lumitip_fab.boards.model import AT_CELLS, GROUND
from lumitip_fab.design import Component, Point, Wiring

ROW_MM = 7.62
"""Between the lines that a row of parts hangs on."""
_BULK_MM = 20.32  # height of a capacitor between its supplies
_COLUMN_MM = 50.8  # width of a part by itself, and of the wires
Parts = Mapping[str, Component]


def wires_block(parts: Parts, supply: str) -> Block:
    """The connector J1 with a test point at each of its wires."""
    ways = len(parts["J1"].nets)
    shape = symbols.contacts(tuple(str(i + 1) for i in range(ways)), ROW_MM)
    height_mm = ways * ROW_MM + 25.4 + (_BULK_MM if _bulk(parts) else 0.0)
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
    if bulk := _bulk(parts):
        cx, cy = x, below + _BULK_MM / 2 + 2.54
        sheet.part("C", bulk, (cx, cy), ref_at=(5.08, -1.27), value_at=(6.35, 1.27))
        sheet.power(supply, (cx, cy - 3.81))
        sheet.power(GROUND, (cx, cy + 3.81))
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


def _bulk(parts: Parts) -> Component | None:
    """The capacitor that belongs to no multiplexer."""
    capacitors = (part for part in parts.values() if part.kind == "capacitor")
    return next((part for part in capacitors if f"U{part.ref[1:]}" not in parts), None)


_LED_MM = 12.7
_STRING_MM = 22.86
_STRING_START_MM = 30.48
_SOURCE = "Current_source"


def string_blocks(
    parts: Parts, supply: str, cathodes: str, wiring: Wiring, marked: str
) -> Iterator[Block]:
    """A block for each string of LEDs with its resistor or its current source."""
    for number, string in enumerate(wiring.strings, start=1):
        width_mm = _STRING_START_MM + len(string) * _LED_MM + 20.32
        height_mm, shapes = _STRING_MM, {"LED": symbols.polar("Emitter", marked)}
        if wiring.set_ohm:
            width_mm, height_mm = width_mm + SOURCE_MM, height_mm + 10.16
            shapes[_SOURCE] = source_symbol(parts[f"U{number}"])
        draw = partial(_string, parts, (supply, cathodes), number, string, wiring)
        yield Block(width_mm, height_mm, draw, shapes)


def _string(
    parts: Parts,
    ends: tuple[str, str],
    number: int,
    string: Sequence[int],
    wiring: Wiring,
    sheet: Sheet,
    at: Point,
) -> None:
    (supply, cathodes), x, y = ends, at[0], at[1] + 12.7
    caption = f"String {number}: {len(string)} LEDs, {wiring.current_ma[number - 1]:.1f} mA"
    sheet.texts.append((caption, (x, y - 10.16), 1.8))
    sheet.power(supply, (x + 5.08, y))
    start = x + _STRING_START_MM
    if wiring.set_ohm:
        driving = (f"U{number}", f"R{number}", f"R{len(wiring.strings) + number}")
        source, out, setting = (parts[ref] for ref in driving)
        draw_source(_SOURCE, (source, out, setting), sheet, (x + 5.08, y))
        end, start = x + 5.08 + SOURCE_MM, start + 34.29
    else:
        sheet.wire((x + 5.08, y), (x + 8.89, y))
        resistor = parts[f"R{number}"]
        sheet.part("R", resistor, (x + 12.7, y), 90, ref_at=(0, -2.54), value_at=(0, 2.54))
        end = x + 16.51
    for place, cell in enumerate(string):
        middle = start + place * _LED_MM
        sheet.wire((end, y), (middle - 3.81, y))
        sheet.flag(f"S{number}_{place}", ((end + middle - 3.81) / 2 // 1.27 * 1.27, y), 270)
        sheet.part("LED", parts[f"D{cell + 1}"], (middle, y), ref_at=(0, -5.08))
        end = middle + 3.81
    sheet.wire((end, y), (end + 5.08, y))
    if cathodes == GROUND:
        sheet.power(GROUND, (end + 5.08, y))
    else:
        sheet.flag(cathodes, (end + 5.08, y), 0)


_SWITCH = "LED_switch"
_TALL_MM, _WIDE_MM = 43.18, 60.96
_DOWN_MM = 7.62  # from the gate's line to the middle of its resistor


def switch_block(transistor: Component, pull_down: Component) -> Block:
    """Gate line from the left, the resistor below it, drain above and source below."""

    def draw(sheet: Sheet, at: Point) -> None:
        _draw_switch(transistor, pull_down, sheet, at)

    return Block(_WIDE_MM, _TALL_MM, draw, {_SWITCH: shapes.mosfet(transistor, "N")})


def _draw_switch(transistor: Component, pull_down: Component, sheet: Sheet, at: Point) -> None:
    nets = dict(zip(transistor.pins, (net for _, net in transistor.nets), strict=True))
    x, y = at[0] + 30.48, at[1] + 20.32
    sheet.texts.append(("Switch of the LEDs", (at[0], at[1] + 5.08), 2.5))
    sheet.part(_SWITCH, transistor, (x, y), ref_at=(8.89, -1.27), value_at=(10.16, 1.27))
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


_SOURCE_HALF_MM, _SET_MM = 7.62, 7.62  # half the width of its box; OUT to SET
SOURCE_MM = 41.91
"""From the end of the wire that feeds it to that of the wire at its resistors."""


def source_symbol(part: Component) -> Node:
    """A box with IN to the left, OUT and SET to the right. Leads of one name are one pin: those
    after the first are hidden, and passive, as KiCad asks of pins on top of each other."""
    reach = _SOURCE_HALF_MM + symbols.PIN_MM
    places = {"IN": (-reach, 0.0, 0), "OUT": (reach, 0.0, 180), "SET": (reach, -_SET_MM, 180)}
    pins, names = [], set()
    for number, _ in part.nets:
        name = part.pins[int(number) - 1]
        hide = name in names
        kind = "passive" if hide else shapes.pin_type(part, name)
        pins.append(symbols.pin(number, *places[name], symbols.PIN_MM, name, kind, hide))
        names.add(name)
    body = symbols.box(
        -_SOURCE_HALF_MM, _SET_MM / 2, _SOURCE_HALF_MM, -_SET_MM * 1.5, fill="background"
    )
    return symbols.symbol("U", [body], pins, shown=True)


def draw_source(
    name: str, parts: tuple[Component, Component, Component], sheet: Sheet, at: Point
) -> None:
    """The source and its resistors on a line from the left.

    Args:
        name: of the symbol.
        parts: the source, the resistor at its OUT, and that at its SET.
        sheet: drawn on.
        at: end of the wire that feeds it.
    """
    source, out, setting = parts
    x, y = at
    middle, lower = x + _SOURCE_HALF_MM + 2 * symbols.PIN_MM, y + _SET_MM
    sheet.wire((x, y), (x + symbols.PIN_MM, y))
    sheet.part(name, source, (middle, y), ref_at=(-5.08, -5.08), value_at=(3.81, -5.08))
    right = middle + _SOURCE_HALF_MM + symbols.PIN_MM
    resistor, end = right + 8.89, x + SOURCE_MM
    for part, line, way in ((out, y, 90), (setting, lower, 270)):
        sheet.wire((right, line), (resistor - 3.81, line))
        sheet.flag(part.nets[0][1], (right + 2.54, line), way)
        sheet.part("R", part, (resistor, line), 90, ref_at=(0, -2.54), value_at=(0, 2.54))
        sheet.wire((resistor + 3.81, line), (end, line))
    sheet.wire((end, lower), (end, y))
    sheet.junctions.append((end, y))
