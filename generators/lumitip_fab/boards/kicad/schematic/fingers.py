"""Blocks of the fingers' sheets: wires, strings of LEDs, multiplexers with detectors."""

from collections.abc import Mapping

from lumitip_fab.boards.circuit import GROUND
from lumitip_fab.boards.kicad.schematic.sheet import Drawn, Sheet
from lumitip_fab.boards.kicad.schematic.symbols import ROW_MM, mux_half_mm, mux_pins
from lumitip_fab.design import Component, Multiplexer, Point, Wiring

WIRES_WIDTH_MM = 50.8


def wires_height_mm(ways: int) -> float:
    """Height of the block."""
    return ways * ROW_MM + 25.4


def draw_wires(sheet: Sheet, at: Point, parts: Mapping[str, Component], supply: str) -> None:
    """The connector with a row for each wire, and what the parts at the cells are."""
    wires = parts["J1"]
    ways = len(wires.nets)
    x, first = at[0] + 10.16, at[1] + 17.78
    sheet.texts.append(("Wires", (at[0] + 2.54, at[1] + 5.08), 2.5))
    cells = [part for part in parts.values() if part.kind in ("led", "photodetector")]
    caption = f"{cells[0].ref} to {cells[-1].ref}: {cells[0].value}"
    below = first + ways * ROW_MM + 2.54
    sheet.texts.append((caption, (at[0] + 2.54, below), 1.5))
    middle = first + (ways - 1) / 2 * ROW_MM
    sheet.symbols.append(
        Drawn(
            "Wires",
            "J1",
            wires.value,
            x,
            middle,
            pins=tuple(pad for pad, _ in wires.nets),
            ref_at=(0, -ways / 2 * ROW_MM - 1.27),
        )
    )
    for i, (_, net) in enumerate(wires.nets):
        y = first + i * ROW_MM
        probe, end = x + 12.7, x + 25.4
        point = parts[f"TP{i + 1}"]
        sheet.symbols.append(
            Drawn("TestPoint", point.ref, net, probe, y, pins=("1",), ref_at=(3.048, -3.302))
        )
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


LED_MM = 12.7
STRING_MM = 22.86
_STRING_START_MM = 30.48


def strings_size_mm(wiring: Wiring) -> Point:
    """Width and height of the strings."""
    longest = max(len(string) for string in wiring.strings)
    return _STRING_START_MM + longest * LED_MM + 20.32, len(wiring.strings) * STRING_MM


def draw_strings(
    sheet: Sheet, at: Point, wiring: Wiring, parts: Mapping[str, Component], supply: str
) -> None:
    """Every string with its resistor."""
    for number, string in enumerate(wiring.strings, start=1):
        x, y = at[0], at[1] + (number - 1) * STRING_MM + 12.7
        caption = f"String {number}: {len(string)} LEDs, {wiring.current_ma[number - 1]:.1f} mA"
        sheet.texts.append((caption, (x, y - 10.16), 1.8))
        sheet.power(supply, (x + 5.08, y))
        resistor = parts[f"R{number}"]
        sheet.wire((x + 5.08, y), (x + 8.89, y))
        sheet.symbols.append(
            Drawn(
                "R",
                resistor.ref,
                resistor.value,
                x + 12.7,
                y,
                90,
                ref_at=(0, -2.54),
                value_at=(0, 2.54),
            )
        )
        end = x + 16.51
        for place, cell in enumerate(string):
            middle = x + _STRING_START_MM + place * LED_MM
            sheet.wire((end, y), (middle - 3.81, y))
            net = dict(parts[f"R{number}"].nets)["2"] if not place else f"S{number}_{place}"
            sheet.flag(net, ((end + middle - 3.81) / 2 // 1.27 * 1.27, y), 270)
            led = parts[f"D{cell + 1}"]
            sheet.symbols.append(Drawn("LED", led.ref, led.value, middle, y, ref_at=(0, -5.08)))
            end = middle + 3.81
        sheet.wire((end, y), (end + 5.08, y))
        sheet.power(GROUND, (end + 5.08, y))


_MUX_X_MM = 53.34
_ABOVE_MM, _BELOW_MM = 20.32, 15.24
BLOCK_WIDTH_MM = 101.6


def block_height_mm(mux: Multiplexer) -> float:
    """Height of a block."""
    return 2 * mux_half_mm(mux) + _ABOVE_MM + _BELOW_MM


def draw_block(
    sheet: Sheet,
    at: Point,
    number: int,
    mux: Multiplexer,
    parts: Mapping[str, Component],
    supply: str,
) -> None:
    """A multiplexer with its detectors, its pull-up and its capacitor."""
    ref = f"U{number}"
    nets = dict(parts[ref].nets)
    x, y = at[0] + _MUX_X_MM, at[1] + _ABOVE_MM + mux_half_mm(mux)
    pins = {name: (x + px, y - py) for name, _, (px, py), _, _ in mux_pins(mux)}
    leads = {name: str(lead) for name, lead, *_ in mux_pins(mux)}
    sheet.texts.append((f"{ref} to {nets[str(mux.output)]}", (at[0] + 2.54, at[1] + 5.08), 2.5))
    top = mux_half_mm(mux)
    sheet.symbols.append(
        Drawn(
            "Multiplexer",
            ref,
            parts[ref].value,
            x,
            y,
            pins=tuple(nets),
            ref_at=(-7.62, -top - 1.27),
            value_at=(0, 0),
        )
    )
    _detectors(sheet, at[0], pins, leads, nets, parts)
    _output(sheet, pins["Z"], nets[leads["Z"]], parts[f"R{number}"], supply)
    for name in (name for name in pins if name[0] == "S"):
        px, py = pins[name]
        sheet.wire((px, py), (px + 5.08, py))
        sheet.flag(nets[leads[name]], (px + 5.08, py), 0)
    sheet.power(supply, pins["VCC"])
    grounds = sorted(at_ for name, at_ in pins.items() if name in ("GND", "VEE", "~{E}"))
    low = grounds[0][1] + 2.54
    for ground in grounds:
        sheet.wire(ground, (ground[0], low))
    sheet.wire(*((gx, low) for gx, _ in grounds))
    sheet.junctions += [(gx, low) for gx, _ in grounds[1:-1]]
    sheet.power(GROUND, (grounds[0][0], low))
    if len(grounds) > 1:
        sheet.junctions.append((grounds[0][0], low))
    capacitor = parts[f"C{number}"]
    cx, cy = x + 25.4, y + top - 7.62
    sheet.symbols.append(
        Drawn(
            "C", capacitor.ref, capacitor.value, cx, cy, ref_at=(5.08, -1.27), value_at=(6.35, 1.27)
        )
    )
    sheet.power(supply, (cx, cy - 3.81))
    sheet.power(GROUND, (cx, cy + 3.81))


def _detectors(
    sheet: Sheet,
    left_mm: float,
    pins: dict[str, Point],
    leads: dict[str, str],
    nets: dict[str, str],
    parts: Mapping[str, Component],
) -> None:
    """A detector for each input in use, their emitters on one wire to ground."""
    bus, middle = left_mm + 7.62, left_mm + 17.78
    rows = []
    for name in (name for name in pins if name[0] == "Y"):
        x, y = pins[name]
        net = nets[leads[name]]
        if net == GROUND:
            sheet.wire((x, y), (x - 5.08, y))
            sheet.power(GROUND, (x - 5.08, y))
            continue
        sheet.symbols.append(
            Drawn("Phototransistor", net, parts[net].value, middle, y, ref_at=(-5.08, -2.54))
        )
        sheet.wire((bus, y), (middle - 5.08, y))
        sheet.wire((middle + 5.08, y), (x, y))
        sheet.flag(net, (middle + 8.89, y), 90)
        rows.append(y)
    sheet.wire((bus, rows[0]), *((bus, y) for y in rows[1:]), (bus, rows[-1] + ROW_MM / 2))
    sheet.junctions += [(bus, y) for y in rows[1:]]
    sheet.power(GROUND, (bus, rows[-1] + ROW_MM / 2))


def _output(sheet: Sheet, at: Point, net: str, resistor: Component, supply: str) -> None:
    """The analog line with its pull-up."""
    x, y = at
    sheet.wire((x, y), (x + 8.89, y), (x + 17.78, y))
    sheet.junctions.append((x + 8.89, y))
    sheet.flag(net, (x + 17.78, y), 0)
    sheet.symbols.append(
        Drawn(
            "R",
            resistor.ref,
            resistor.value,
            x + 8.89,
            y - 3.81,
            ref_at=(3.81, -1.27),
            value_at=(3.81, 1.27),
        )
    )
    sheet.power(supply, (x + 8.89, y - 7.62))
