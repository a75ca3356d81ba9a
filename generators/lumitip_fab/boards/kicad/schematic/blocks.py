"""Blocks of a finger's sheet: wires with test points, and strings of LEDs."""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from lumitip_fab.boards.kicad.schematic import current_sources, symbols
from lumitip_fab.boards.kicad.schematic.sheet import Block, Sheet
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
        height_mm, shapes = _STRING_MM, {"LED": symbols.led(marked)}
        if wiring.set_ohm:
            width_mm, height_mm = width_mm + current_sources.WIDTH_MM, height_mm + 10.16
            shapes[_SOURCE] = current_sources.symbol(parts[f"U{number}"])
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
        current_sources.draw(_SOURCE, (source, out, setting), sheet, (x + 5.08, y))
        end, start = x + 5.08 + current_sources.WIDTH_MM, start + 34.29
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
