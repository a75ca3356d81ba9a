"""The list of cables, its note and its diagram against the boards, the firmware and the layout."""

import math
import re
from collections import Counter
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

from lumitip_fab.checks.cable_prose import measure_prose
from lumitip_fab.checks.cables import (
    Row,
    note_row,
    read_diagram,
    read_list,
    read_note,
    text_of,
)
from lumitip_fab.checks.connections import PINOUTS
from lumitip_fab.checks.diagram_texts import misread
from lumitip_fab.checks.readers.kicad_board import KicadBoard, read_board
from lumitip_fab.checks.result import Measurement, count, unreadable
from lumitip_fab.checks.wire_ways import reach_mm, run_mm
from lumitip_fab.design import Design
from lumitip_fab.design.cabling import COLOURS, codes_of
from lumitip_fab.errors import OutputError

READS = ("wiring/*", "boards/*.kicad_pcb", "firmware/layout.h")
_LIST, _NOTE, _DIAGRAM = "wiring/cables.csv", "wiring/cables.md", "wiring/wiring.svg"
_HEADER = "firmware/layout.h"
_CONNECTORS = {
    "emitter": ("J1",),
    "receiver": ("J1",),
    "breakout": ("J5", "J6", "J7"),
    "flange": ("J4", "J5"),  # which are there if the controller is
}
_OHM_MM2_PER_M = 0.0178
_PF_PER_M = 96.1  # ground, signal, ground in 3M's cable 3560 (TS-0672-B)
_FIXED = {"GND": "BK", "3V3": "OG"}
_BEFORE_FUSE = "_IN"
"""End of a supply's net before its board's fuse; the wire has the supply's name."""

Nets = dict[str, dict[str, str]]
"""Net of each pad, by board and by `"J1.3"`."""


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Read the list, follow every wire from board to board, and compare note and diagram."""
    try:
        rows = read_list(outputs / _LIST)
        boards = {
            name: read_board(outputs / f"boards/{name}/{name}.kicad_pcb")
            for name in ("emitter", "receiver", *(c.name for c in design.auxiliary_boards))
        }
    except OutputError as error:
        yield unreadable("wiring.readable", _LIST, str(error))
        return
    nets = {name: _nets(board) for name, board in boards.items()}
    yield count("wiring.ends", _LIST, _wrong_ends(rows, nets), "pads")
    yield count(
        "wiring.pins", _LIST, _wrong_pins(outputs, rows, boards["receiver"], nets, design), "pins"
    )
    yield count("wiring.neighbours", _LIST, _beside_supply(nets, design), "pads beside the supply")
    yield count("wiring.colours", _LIST, _wrong_colours(rows, design), "wires")
    yield _lengths(rows, boards, design)
    yield from _currents(rows, design)
    yield _capacitance(rows, design)
    yield from _note(outputs, rows, design)
    yield from _diagram(outputs, rows, design)


def _nets(board: KicadBoard) -> dict[str, str]:
    return {f"{p.ref}.{t.number}": t.net for p in board.parts for t in p.terminals}


def _wrong_ends(rows: tuple[Row, ...], nets: Nets) -> list[str]:
    """Pads wired never or twice, and wires whose ends are of different nets."""
    taken = Counter(end for row in rows for end in (row.start, row.end))
    pads = {
        (board, pad)
        for board, of in nets.items()
        for pad in of
        if pad.partition(".")[0] in _CONNECTORS.get(board, ())
    }
    wrong = [f"{board} {pad}" for board, pad in sorted(pads) if taken[board, pad] != 1]
    wrong += [f"{' '.join(end)} twice" for end, times in taken.items() if times > 1]
    for row in rows:
        signals = {
            nets[board].get(pad, "none").removesuffix(_BEFORE_FUSE)
            for board, pad in (row.start, row.end)
            if board in nets
        }
        if signals != {row.signal}:
            wrong.append(f"{row.wire}: {' and '.join(sorted(signals))}")
    twice = [wire for wire, times in Counter(row.wire for row in rows).items() if times > 1]
    return wrong + [f"{wire} twice" for wire in twice]


def _beside_supply(nets: Nets, design: Design) -> list[str]:
    """Pads of wires beside one of the LEDs' supply that are not ground's: a bridge of solder there
    would lead the supply to a controller."""
    supply, wrong = design.emitter.connector.supply, []
    for board, of in nets.items():
        for ref in _CONNECTORS.get(board, ()):
            row = {
                int(pad.partition(".")[2]): net
                for pad, net in of.items()
                if re.fullmatch(rf"{ref}\.\d+", pad)
            }
            carried = [row[number].removesuffix(_BEFORE_FUSE) for number in sorted(row)]
            wrong += [
                f"{board} {ref}: {one} beside {other}"
                for one, other in pairwise(carried)
                if supply in (one, other) and not {one, other} <= {supply, "GND"}
            ]
    return wrong


def _wrong_pins(
    outputs: Path, rows: tuple[Row, ...], receiver: KicadBoard, nets: Nets, design: Design
) -> list[str]:
    """From each multiplexer's leads along the wires to the pin that the firmware uses."""
    analog, select = _header(outputs, "LUMITIP_ADC_PINS"), _header(outputs, "LUMITIP_SELECT_PINS")
    used = {cell.adc_pin for cell in design.cells}
    analog = [pin for pin in analog if pin in used]
    arrives = {row.signal: _arrives(row, nets, design) for row in rows if "receiver" in row.start}
    muxes = [p for p in receiver.parts if re.fullmatch(r"U\d+", p.ref)]
    wrong = [] if len(muxes) == len(analog) else [f"{len(analog)} analog pins"]
    for mux in sorted(muxes, key=lambda part: int(part.ref[1:])):
        pinout = next((p for p in PINOUTS if p.leads == len(mux.terminals)), None)
        net = {t.number: t.net for t in mux.terminals}
        if pinout is None or not {pinout.output, *pinout.select} <= net.keys():
            wrong.append(f"{mux.ref} has {len(mux.terminals)} leads, as no multiplexer has")
            continue
        wanted = {net[pinout.output]: analog[int(mux.ref[1:]) - 1 :][:1]}
        wanted |= {net[lead]: [pin] for lead, pin in zip(pinout.select, select, strict=False)}
        wrong += [
            f"{mux.ref}: {arrives.get(name)}, not {pins}"
            for name, pins in wanted.items()
            if [arrives.get(name)] != pins
        ]
    return wrong + _wrong_switch(outputs, rows, nets, design)


def _wrong_switch(outputs: Path, rows: tuple[Row, ...], nets: Nets, design: Design) -> list[str]:
    """From the gate of the LEDs' switch along its wire to the pin that the firmware uses."""
    part, found = design.packages.switch, _header(outputs, "LUMITIP_EMITTER_PIN")
    pin = found[0].split()[0] if found else "none"
    if part is None:
        return [] if pin == "none" else [f"firmware switches pin {pin}, no LED"]
    gate = nets["emitter"].get(f"Q1.{part.names.index('G') + 1}")
    ends = [_arrives(r, nets, design) for r in rows if r.start[0] == "emitter" and r.signal == gate]
    return [] if ends == [pin] else [f"switch of the LEDs: {' and '.join(ends)}, not {pin}"]


def _arrives(row: Row, nets: Nets, design: Design) -> str:
    """The controller's pin at the other end, as the firmware names it: straight, through the socket
    of the breakout, or at the pads of a module; through a resistor where one is before the pin."""
    board, pad = row.end
    pin = pad
    for auxiliary in (c for c in design.auxiliary_boards if c.name == board):
        reached = {nets[board].get(pad)}
        for device in (d for d in auxiliary.components if d.kind == "resistor"):
            ends = {nets[board].get(f"{device.ref}.{number}") for number in (1, 2)}
            reached |= ends if nets[board].get(pad) in ends else set()
        pins = {
            name
            for device in auxiliary.components
            if device.kind in ("socket", "module")
            for land, name in zip(device.footprint.pads, device.pins, strict=True)
            if nets[board].get(f"{device.ref}.{land.number}") in reached
        }
        pin = "+".join(sorted(pins))
    return re.sub(r"^D(?=\d+$)", "", pin)


def _header(outputs: Path, name: str) -> list[str]:
    try:
        text = (outputs / _HEADER).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return []
    found = re.search(rf"^#define {name} (.*)$", text, re.MULTILINE)
    return found[1].split(", ") if found else []


def _wrong_colours(rows: tuple[Row, ...], design: Design) -> list[str]:
    """Ground black, the LEDs' supply red, known codes, and no colour twice in a cable."""
    fixed = _FIXED | {design.emitter.connector.supply: "RD"}
    wrong = []
    seen: set[tuple[str, str]] = set()
    for row in rows:
        known = set(codes_of(row.colour)) <= set(COLOURS)
        reserved = row.colour in fixed.values() and fixed.get(row.signal) != row.colour
        other = fixed.get(row.signal, row.colour) != row.colour
        if not known or reserved or other or (row.cable, row.colour) in seen:
            wrong.append(f"{row.wire} {row.colour}")
        seen.add((row.cable, row.colour))
    return wrong


def _lengths(rows: tuple[Row, ...], boards: dict[str, KicadBoard], design: Design) -> Measurement:
    """How far the worst wire is from the way that it has to go; up to a centimetre is rounding."""
    cabling, over = design.cabling, []
    for row in rows:
        way = cabling.slack_mm
        if row.start[0] in ("emitter", "receiver"):
            way += cabling.travel_mm + reach_mm(boards[row.start[0]], design)
            way += sum(c.added_mm for c in cabling.cables if c.name == row.cable)
            way += run_mm(row, boards.get("breakout"), design)
        else:
            way += cabling.supply_mm
        over.append(row.length_mm - way)
    worst = max(over, key=lambda mm: abs(mm - cabling.step_mm / 2), default=math.nan)
    note = "longer than reach, travel, way, slack and what bends need"
    return Measurement("wiring.lengths", _LIST, worst, 0, cabling.step_mm, "mm", note)


def _currents(rows: tuple[Row, ...], design: Design) -> Iterator[Measurement]:
    """Current of the supply wires against the strings, and its voltage drop in the copper."""
    supply = design.emitter.connector.supply
    lit_ma = sum(design.electrical.strings.high_ma)
    feeding = [row for row in rows if row.signal == supply]
    least = min((row.current_ma for row in feeding), default=math.nan)
    note = "least rating of the LEDs' supply"
    yield Measurement("wiring.current", _LIST, least, lit_ma - 0.01, math.inf, "mA", note)
    dense = max((r.current_ma / 1000 / r.section_mm2 for r in rows), default=math.nan)
    most = design.cabling.most_a_per_mm2
    yield Measurement("wiring.density", _LIST, dense, 0, most, "A/mm²")
    drop = sum(
        row.current_ma / 1000 * _OHM_MM2_PER_M * row.length_mm / 1000 / row.section_mm2
        for row in rows
        if row.signal == supply or (row.signal == "GND" and "receiver" not in row.start)
    )
    most = design.cabling.most_drop * design.wiring.supply_v
    yield Measurement("wiring.drop", _LIST, drop, 0, most, "V", "supply to emitter and back")


def _capacitance(rows: tuple[Row, ...], design: Design) -> Measurement:
    """Of the longest wire of an analog signal, against what the firmware's wait is for."""
    analog = {cell.adc_pin for cell in design.cells}
    longest_mm = max((row.length_mm for row in rows if row.signal in analog), default=math.nan)
    pf, most = _PF_PER_M * longest_mm / 1000, design.electrical.channel.wire_pf
    return Measurement("wiring.capacitance", _LIST, pf, 0, most, "pF", "longest analog wire")


def _note(outputs: Path, rows: tuple[Row, ...], design: Design) -> Iterator[Measurement]:
    try:
        text = text_of(outputs / _NOTE)
    except OutputError as error:
        yield unreadable("wiring.note", _NOTE, str(error))
        return
    noted = read_note(text)
    wanted = {row.wire: note_row(row) for row in rows}
    wrong = [w for w in sorted({*wanted, *noted}) if wanted.get(w) != noted.get(w)]
    yield count("wiring.note", _NOTE, wrong, "wires")
    yield from measure_prose(text, rows, design)


def _diagram(outputs: Path, rows: tuple[Row, ...], design: Design) -> Iterator[Measurement]:
    """Each line ends on the pads of the list, in the ink of its colour, with its own label."""
    try:
        drawn = read_diagram(outputs / _DIAGRAM)
    except OutputError as error:
        yield unreadable("wiring.diagram", _DIAGRAM, str(error))
        return
    wrong = sorted({*drawn} ^ {row.wire for row in rows})
    for row in rows:
        wire = drawn.get(row.wire)
        if wire is None:
            continue
        ends = (wire.start, wire.end, wire.inks, wire.label.split()[:2])
        inks = tuple(COLOURS.get(code, ("", ""))[1] for code in codes_of(row.colour))
        if ends != (".".join(row.start), ".".join(row.end), inks, [row.wire, row.colour]):
            wrong.append(f"{row.wire} from {wire.start} to {wire.end}")
    yield count("wiring.diagram", _DIAGRAM, wrong, "wires")
    try:
        texts = list(misread(outputs / _DIAGRAM, rows, design.cabling))
    except (ValueError, LookupError) as error:
        yield unreadable("wiring.texts", _DIAGRAM, f"cannot be measured: {error!r:.120}")
        return
    yield count("wiring.texts", _DIAGRAM, texts, "words that stand elsewhere")
