"""The bulk capacitor of the receiver: where it is on the written board, and what its value does."""

import math
import re
from collections.abc import Iterator

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.result import Measurement

GROUND = "GND"
_VALUE = re.compile(r"(\d+(?:\.\d+)?)([unp])F")
_MICRO = {"u": 1.0, "n": 1e-3, "p": 1e-6}


def measure_bulk(read: ReadBoard) -> Iterator[Measurement]:
    """Between supply and ground, near the supply's wire; the dip of the supply with the capacitance
    that is left of the value on the board."""
    bulk, ref = read.design.electrical.bulk, f"C{read.muxes + 1}"
    if bulk is None or not read.muxes:
        return
    supply = read.supply
    rails = {read.wire(supply), read.wire(GROUND)}
    there = {read.group(ref, 1), read.group(ref, 2)}
    wrong = [] if there == rails and None not in rails else [f"{ref} is not at {supply} and GND"]
    yield read.count("bulk", wrong, "capacitors")
    part, wires = read.parts.get(ref), read.parts.get("J1")
    pads = [t.at for t in (part.terminals if part else ()) if _joined(read, ref, t.number, supply)]
    number = str(read.signals.index(supply) + 1)
    ends = [t.at for t in (wires.terminals if wires else ()) if t.number == number]
    far = min((math.dist(a, b) for a in pads for b in ends), default=math.inf)
    yield read.figure("bulk_reach", far, 0, bulk.reach_mm, note="to the supply's wire")
    least_uf = _micro(part.value if part else "") * bulk.left * (1 - bulk.tolerance)
    dip_mv = bulk.step_ma * math.sqrt(bulk.wire_uh / least_uf)
    note = f"with {least_uf:.1f} µF left by DC bias and tolerance"
    yield read.figure("bulk_dip", dip_mv, 0, bulk.most_mv, "mV", note)


def _joined(read: ReadBoard, ref: str, number: str, supply: str) -> bool:
    return read.group(ref, number) == read.wire(supply) is not None


def _micro(value: str) -> float:
    """Capacitance of a value such as 10uF (µF); not a number of any other text."""
    match = _VALUE.fullmatch(value)
    return float(match[1]) * _MICRO[match[2]] if match else math.nan
