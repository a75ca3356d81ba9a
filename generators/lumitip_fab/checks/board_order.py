"""The order of wires: select lines, whose edges are steep, do not run beside analog lines."""

import math
from collections.abc import Iterator
from itertools import pairwise

from lumitip_fab.checks.board_protection import line_of
from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.readers.kicad_board import Part, Terminal
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Component

SELECT, ANALOG = "select", "analog"
PUBLISHED = "the published order: reported only"


def measure_wire_order(read: ReadBoard) -> Iterator[Measurement]:
    """In each row of a cable's wire pads, how many analog lines are next to a select line. What a
    pad carries is followed along the copper, from the multiplexers or from the controller."""
    kinds = _kinds(read)
    if not kinds:
        return
    beside = [
        f"{one.net} is beside {other.net}"
        for row in _rows(read)
        for one, other in pairwise(_in_order(row))
        if {_kind(read, kinds, one), _kind(read, kinds, other)} == {SELECT, ANALOG}
    ]
    if read.design.wiring.apart:
        yield read.count("wire_order", beside, "pairs of wires")
    else:
        note = f"{PUBLISHED}; {', '.join(beside)}"
        yield read.figure("wire_order", len(beside), 0, math.inf, "pairs of wires", note)


def _kinds(read: ReadBoard) -> dict[int, str]:
    """What the copper of each line carries; empty on boards without such lines."""
    found = {(SELECT, group) for group in _selects(read)}
    found |= {(ANALOG, group) for group in _analogs(read)}
    return {group: kind for kind, group in found if group is not None}


def _selects(read: ReadBoard) -> Iterator[int | None]:
    for which in range(1, read.muxes + 1):
        for lead in read.design.packages.multiplexer.select:
            yield read.group(f"U{which}", lead)
    yield from _at_pins(read, read.design.wiring.select_pins)


def _analogs(read: ReadBoard) -> Iterator[int | None]:
    for which in range(1, read.muxes + 1):
        yield read.group(f"U{which}", read.design.packages.multiplexer.output)
    yield from _at_pins(read, read.design.wiring.adc_pins)


def _at_pins(read: ReadBoard, pins: tuple[str, ...]) -> Iterator[int | None]:
    """The copper of the wires of the controller's pins, by its socket or by its own pads."""
    for device in read.components:
        if device.kind in ("socket", "module"):
            for land, pin in zip(device.footprint.pads, device.pins, strict=True):
                if pin in pins:
                    yield line_of(read, read.group(device.ref, land.number))


def _rows(read: ReadBoard) -> Iterator[Part]:
    """Wire pads that a cable ends at. Those beside a controller's socket are in its own order."""
    rows = {"J1"} if read.finger else {d.ref for d in read.components if _is_cable(d)}
    yield from (part for ref, part in read.parts.items() if ref in rows)


def _is_cable(device: Component) -> bool:
    return device.kind == "wires" and bool(device.pins)


def _in_order(row: Part) -> list[Terminal]:
    """Its pads as they lie on the board."""
    return sorted((t for t in row.terminals if t.copper is not None), key=lambda t: t.at)


def _kind(read: ReadBoard, kinds: dict[int, str], pad: Terminal) -> str:
    group = read.clusters.of(pad.copper) if pad.copper is not None else None
    return kinds.get(group, "") if group is not None else ""
