"""Blocks of multiplexers with their detectors, pull-ups and capacitors."""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import chain, count

from lumitip_fab.boards.kicad.schematic import symbols
from lumitip_fab.boards.kicad.schematic.blocks import ROW_MM, Parts
from lumitip_fab.boards.kicad.schematic.sheet import Block, Sheet
from lumitip_fab.boards.kicad.schematic.symbols import PIN_MM, box, pin, symbol
from lumitip_fab.boards.kicad.sexpr import Node
from lumitip_fab.boards.model import GROUND
from lumitip_fab.design import Component, Multiplexer, Packages, Point

_SIDE_MM = 10.16  # half the width of a multiplexer's body
_MUX_X_MM = 53.34
_PULL_UPS_MM, _PULL_UP_ABOVE_MM = 30.48, 2.54
"""Resistors of the detectors' own pull-ups: from the block's left, and above their lines."""
_ABOVE_MM, _BELOW_MM = 20.32, 15.24
_WIDTH_MM = 101.6


def multiplexer_blocks(parts: Parts, supply: str, packages: Packages) -> Iterator[Block]:
    """A block for each multiplexer with its detectors, its pull-ups and its capacitor."""
    mux = packages.multiplexer
    shapes = {
        "Phototransistor": symbols.polar("Phototransistor", packages.photodetector.marked),
        "Multiplexer": _symbol(mux),
        "R_Array": _array(packages.array.resistors),
    }
    height_mm = 2 * _half_mm(mux) + _ABOVE_MM + _BELOW_MM
    for number in range(1, sum(part.kind == "multiplexer" for part in parts.values()) + 1):
        yield Block(_WIDTH_MM, height_mm, partial(_draw, parts, supply, mux, number), shapes)


def _symbol(mux: Multiplexer) -> Node:
    """A multiplexer: inputs to the left, output and select lines to the right."""
    pins = [
        pin(str(lead), *at, angle, PIN_MM, name, "input" if name[0] in "SE~" else kind)
        for name, lead, at, angle, kind in _pins(mux)
    ]
    top = _half_mm(mux)
    return symbol("U", [box(-_SIDE_MM, -top, _SIDE_MM, top, fill="background")], pins, shown=True)


def _half_mm(mux: Multiplexer) -> float:
    """Half the height of a multiplexer's body."""
    return (mux.channels + 1) / 2 * ROW_MM


def _pins(mux: Multiplexer) -> list[tuple[str, int, Point, int, str]]:
    """Name, lead, place of its outer end, angle and kind of each pin."""
    first, top = (mux.channels - 1) / 2 * ROW_MM, _half_mm(mux) + PIN_MM
    side = _SIDE_MM + PIN_MM
    pins: list[tuple[str, int, Point, int, str]] = [
        (f"Y{i}", lead, (-side, first - i * ROW_MM), 0, "passive")
        for i, lead in enumerate(mux.input_leads)
    ]
    pins.append(("Z", mux.output, (side, first), 180, "passive"))
    pins += [
        (f"S{i}", lead, (side, first - 2 * ROW_MM - i * 5.08), 180, "input")
        for i, lead in enumerate(mux.select)
    ]
    pins.append(("VCC", mux.supply, (0, top), 270, "power_in"))
    pins += [
        ("GND", mux.ground, (-5.08, -top), 90, "power_in"),
        ("~{E}", mux.enable, (5.08, -top), 90, "input"),
    ]
    if mux.negative is not None:
        pins.append(("VEE", mux.negative, (0, -top), 90, "power_in"))
    return pins


def _array(resistors: int) -> Node:
    """Separate resistors, each a unit that is drawn by itself."""
    _, resistor = symbols.two_terminals("resistor")
    body, *_ = (v for v in resistor if isinstance(v, tuple) and v[0] == "symbol")
    frame = symbol("RN", [], [])[:-2]
    units = (
        (
            "symbol",
            f"{i}_1",
            *body[2:],
            pin(str(i), 0, 3.81, 270, 1.27),
            pin(str(2 * resistors + 1 - i), 0, -3.81, 90, 1.27),
        )
        for i in range(1, resistors + 1)
    )
    return (*frame, *units)


def _draw(
    parts: Parts, supply: str, mux: Multiplexer, number: int, sheet: Sheet, at: Point
) -> None:
    ref = f"U{number}"
    nets = dict(parts[ref].nets)
    x, y = at[0] + _MUX_X_MM, at[1] + _ABOVE_MM + _half_mm(mux)
    pins = {name: (x + px, y - py) for name, _, (px, py), _, _ in _pins(mux)}
    leads = {name: str(lead) for name, lead, *_ in _pins(mux)}
    title = f"{ref} to {nets[str(mux.output)]}"
    if f"R{number}" not in parts:
        title += f", pull-ups of {parts['RN1'].value}"
    sheet.texts.append((title, (at[0] + 2.54, at[1] + 5.08), 2.5))
    top = _half_mm(mux)
    ref_at = -7.62, -top - 1.27
    sheet.part("Multiplexer", parts[ref], (x, y), ref_at=ref_at, value_at=(0, 0))
    pull_ups = None if f"R{number}" in parts else at[0] + _PULL_UPS_MM
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
    cx, cy = x + 25.4, y + top - 7.62
    sheet.part("C", parts[f"C{number}"], (cx, cy), ref_at=(5.08, -1.27), value_at=(6.35, 1.27))
    sheet.power(supply, (cx, cy - 3.81))
    sheet.power(GROUND, (cx, cy + 3.81))


def _detectors(
    sheet: Sheet,
    left_mm: float,
    pull_ups_mm: float | None,
    pins: dict[str, Point],
    leads: dict[str, str],
    nets: dict[str, str],
    parts: Parts,
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
        sheet.part("Phototransistor", parts[net], (middle, y), ref_at=(-5.08, -2.54))
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
    parts: Parts,
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
            y = (rows[net] if net in rows else next(left)) - _PULL_UP_ABOVE_MM
            pins = str(unit), str(2 * half + 1 - unit)
            at = x_mm + 3.81, y
            sheet.part("R_Array", array, at, 90, pins, ref_at=(0, -1.905), unit=unit)
            tops.append(y)
            if net in rows:
                sheet.wire((x_mm, rows[net]), (x_mm, y))
                sheet.junctions.append((x_mm, rows[net]))
            else:
                tops.append(y - _PULL_UP_ABOVE_MM)
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
    sheet.part("R", resistor, (x + 8.89, y - 3.81), ref_at=(3.81, -1.27), value_at=(3.81, 1.27))
    sheet.power(supply, (x + 8.89, y - 7.62))
