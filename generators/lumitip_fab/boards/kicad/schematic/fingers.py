"""Blocks of the fingers' sheets: wires, strings of LEDs, multiplexers with detectors."""

from collections.abc import Mapping, Sequence
from itertools import chain, count

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
PULL_UPS_MM, PULL_UP_ABOVE_MM = 30.48, 2.54
"""Resistors of the detectors' own pull-ups: from the block's left, and above their lines."""
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
    title = f"{ref} to {nets[str(mux.output)]}"
    if f"R{number}" not in parts:
        title += f", pull-ups of {parts['RN1'].value}"
    sheet.texts.append((title, (at[0] + 2.54, at[1] + 5.08), 2.5))
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
    pull_ups = None if f"R{number}" in parts else at[0] + PULL_UPS_MM
    rows, free = _detectors(sheet, at[0], pull_ups, pins, leads, nets, parts)
    if pull_ups is not None:
        _own_pull_ups(sheet, pull_ups, rows, free, parts, supply)
    _output(sheet, pins["Z"], nets[leads["Z"]], parts.get(f"R{number}"), supply)
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
    pull_ups_mm: float | None,
    pins: dict[str, Point],
    leads: dict[str, str],
    nets: dict[str, str],
    parts: Mapping[str, Component],
) -> tuple[dict[str, float], list[float]]:
    """A detector for each input in use, their emitters on one wire to ground. Their lines have a
    corner where their own pull-ups join them, if they have any.

    Returns:
        Height of each detector's line by its net, and heights of the lines without one.
    """
    bus, middle = left_mm + 7.62, left_mm + 17.78
    rows: dict[str, float] = {}
    free: list[float] = []
    for name in (name for name in pins if name[0] == "Y"):
        x, y = pins[name]
        net = nets[leads[name]]
        if net == GROUND:
            sheet.wire((x, y), (x - 5.08, y))
            sheet.power(GROUND, (x - 5.08, y))
            free.append(y)
            continue
        sheet.symbols.append(
            Drawn("Phototransistor", net, parts[net].value, middle, y, ref_at=(-5.08, -2.54))
        )
        sheet.wire((bus, y), (middle - 5.08, y))
        joins = [] if pull_ups_mm is None else [(pull_ups_mm, y)]
        sheet.wire((middle + 5.08, y), *joins, (x, y))
        sheet.flag(net, (middle + 8.89, y), 90)
        rows[net] = y
    first, *others = rows.values()
    end = (others or [first])[-1] + ROW_MM / 2
    sheet.wire((bus, first), *((bus, y) for y in others), (bus, end))
    sheet.junctions += [(bus, y) for y in others]
    sheet.power(GROUND, (bus, end))
    return rows, free


def _own_pull_ups(
    sheet: Sheet,
    x_mm: float,
    rows: Mapping[str, float],
    free: Sequence[float],
    parts: Mapping[str, Component],
    supply: str,
) -> None:
    """A resistor of an array above the line of each detector, and the supply that they share.

    Args:
        sheet: to draw on.
        x_mm: where the resistors begin.
        rows: height of each detector's line.
        free: heights of the lines without a detector; spare resistors are drawn there.
        parts: the board's parts.
        supply: its net.
    """
    bus = x_mm + 7.62
    above = (min(rows.values()) - k * ROW_MM for k in count(1))
    left = chain(sorted(free), above)
    tops = []
    for array in (part for part in parts.values() if part.kind == "resistor array"):
        half = len(array.nets) // 2
        near = [net for _, net in array.nets[:half]]
        if rows.keys().isdisjoint(near):
            continue
        for unit, net in enumerate(near, start=1):
            y = (rows[net] if net in rows else next(left)) - PULL_UP_ABOVE_MM
            pins = str(unit), str(2 * half + 1 - unit)
            at = x_mm + 3.81, y
            sheet.symbols.append(
                Drawn(
                    "R_Array", array.ref, array.value, *at, 90, pins, ref_at=(0, -1.905), unit=unit
                )
            )
            tops.append(y)
            if net in rows:
                sheet.wire((x_mm, rows[net]), (x_mm, y))
                sheet.junctions.append((x_mm, rows[net]))
            else:
                tops.append(y - PULL_UP_ABOVE_MM)
                sheet.wire((x_mm, y), (x_mm, tops[-1]), (bus, tops[-1]))
    tops.sort()
    end = bus, tops[0] - ROW_MM / 2
    sheet.wire(end, *((bus, y) for y in tops))
    sheet.junctions += [(bus, y) for y in tops[:-1]]
    sheet.power(supply, end)


def _output(sheet: Sheet, at: Point, net: str, resistor: Component | None, supply: str) -> None:
    """The analog line, with a shared pull-up if there is one."""
    x, y = at
    sheet.wire((x, y), (x + 8.89, y), (x + 17.78, y))
    sheet.flag(net, (x + 17.78, y), 0)
    if resistor is None:
        return
    sheet.junctions.append((x + 8.89, y))
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
