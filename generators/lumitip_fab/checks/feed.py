"""The way from the wire of 5 V to the controller's supply pin, followed along the copper: USB,
which the controller joins to that pin, must not go back to the robot's supply."""

import math
from collections.abc import Iterator

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.plug_in import FROM_SUPPLY, TO_EMITTER, at_contact
from lumitip_fab.checks.result import Measurement

_CATHODE, _ANODE = "1", "2"
_CABLES = (TO_EMITTER, FROM_SUPPLY)
"""Wires to the emitter and from the supply. Where both have a wire of 5 V, that to the emitter is
behind the board's fuse and MOSFET, as the controller is."""
_CONDUCT = ("resistor", "inductor", "fuse", "schottky diode")
"""Kinds of parts with two terminals that a current goes through."""


def measure_feed(read: ReadBoard) -> Iterator[Measurement]:
    """The diode's ends, other ways from pin to wire, and what is left for the controller; of a
    board without the diode the wire is joined to the pin."""
    feed = read.design.feed
    if feed is None or feed.board != read.name:
        return
    ends = [at_contact(read, cable, feed.wire) for cable in _CABLES]
    wire, pin = next((end for end in ends if end is not None), None), _socket(read, feed.pin)
    if feed.diode is None:
        joined = [] if wire is not None and wire == pin else [f"{feed.pin} is not on {feed.wire}"]
        yield read.count("feed", joined, "pins")
        return
    yield read.count("feed", list(_wrong(read, wire, pin)), "parts")
    left_v = feed.wire_v - feed.drop_v
    note = f"at {feed.pin} of the controller, {feed.drop_v:.2f} V less than at the wire"
    yield read.figure("feed_voltage", left_v, feed.least_v, math.inf, "V", note)


def _wrong(read: ReadBoard, wire: int | None, pin: int | None) -> Iterator[str]:
    """A diode that is missing or turned round, and what else joins pin and wire."""
    if wire is None or pin is None or wire == pin:
        yield "wire and pin are joined"
        return
    found = 0
    for device in (d for d in read.components if d.kind in _CONDUCT):
        ends = read.group(device.ref, _CATHODE), read.group(device.ref, _ANODE)
        if device.kind == "schottky diode" and ends == (pin, wire):
            found += 1
        elif set(ends) == {wire, pin}:
            yield device.ref
    if not found:
        yield "no diode from wire to pin"


def _socket(read: ReadBoard, pin: str) -> int | None:
    """Copper of the controller's pin, at its socket."""
    sockets = [d.ref for d in read.components if d.kind == "socket" and pin in d.pins]
    return at_contact(read, sockets[0], pin) if sockets else None
