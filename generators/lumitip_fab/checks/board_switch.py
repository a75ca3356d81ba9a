"""The transistor between the strings of LEDs and ground, followed along the copper."""

import math
from collections.abc import Iterator

from lumitip_fab.checks.board_read import ReadBoard, ohm
from lumitip_fab.checks.result import Measurement

SWITCH, GROUND = "Q1", "GND"


def sink(read: ReadBoard) -> int | None:
    """The group that the last cathode of each string is to be in: the transistor's drain, or ground
    where there is none."""
    return read.wire(GROUND) if _lead(read, "D") is None else _group(read, "D")


def measure_switch(read: ReadBoard) -> Iterator[Measurement]:
    """Source at ground, drain on a net of its own, gate at its wire and at one pull-down."""
    if read.strings and read.design.packages.switch is not None:
        yield read.count("switch", list(_faults(read)), "leads")


def _faults(read: ReadBoard) -> Iterator[str]:
    supply, gate, ground = read.supply, _group(read, "G"), read.wire(GROUND)
    driven = read.wire(read.signals[2]) if len(read.signals) > 2 else None
    if gate is None or gate != driven:
        yield "gate is not at its wire"
    if _group(read, "S") is None or _group(read, "S") != ground:
        yield "source is not at ground"
    if _group(read, "D") in (None, ground, driven, read.wire(supply)):
        yield "drain is at a wire"
    wanted = read.design.wiring.pull_down_ohm
    pulling = [
        ref
        for ref, part in read.parts.items()
        if ref.startswith("R")
        and {read.group(ref, 1), read.group(ref, 2)} == {gate, ground}
        and math.isclose(ohm(part.value), wanted, rel_tol=1e-6)
    ]
    if len(pulling) != 1:
        yield f"{len(pulling)} pull-downs of {wanted:g} ohm at the gate, not 1"


def _lead(read: ReadBoard, name: str) -> int | None:
    """Number of a lead by the catalogue; none without a switch."""
    part = read.design.packages.switch
    return None if part is None else part.names.index(name) + 1


def _group(read: ReadBoard, name: str) -> int | None:
    lead = _lead(read, name)
    return None if lead is None else read.group(SWITCH, lead)
