"""The power LED of a board beside the fingers, followed along the copper, with its currents."""

import math
import re
from collections.abc import Iterator

from lumitip_fab.checks.board_read import ReadBoard, ohm
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design.electrical import Indicator

_CATHODE, _ANODE = "1", "2"
_FLANGE = "flange"
_COIL, _TVS = "L1", "D1"


def measure_indicator(read: ReadBoard) -> Iterator[Measurement]:
    """The way from what feeds it over resistor and LED to ground, the side that the LED stands on,
    its currents, and the resistor's power; all from the values on the written board."""
    for lit in (lit for lit in read.design.electrical.indicators if lit.board == read.name):
        yield read.count("indicator", list(_wrong(read, lit)), "pads")
        part = read.parts.get(lit.resistor_ref)
        resistor = ohm(part.value) if part is not None else math.nan
        low_ma, high_ma, watt = _figures(lit, resistor)
        unseen = "at the lowest supply, highest forward voltage and highest resistance"
        yield read.figure("indicator_dim", low_ma, lit.visible_ma, math.inf, "mA", unseen)
        yield read.figure("indicator_bright", high_ma, 0, lit.max_ma, "mA", "at the other ends")
        share = 100 * watt / lit.rated_w
        note = "of its resistor's rated power"
        yield read.figure("indicator_load", share, 0, 100 * lit.load, "%", note)


def _figures(lit: Indicator, resistor: float) -> tuple[float, float, float]:
    """Least and greatest current (mA), and the power of the resistor (W)."""
    least_v, most_v = lit.forward_v
    low_v = lit.output_v * (1 - lit.supply_tolerance) - most_v
    high_v = lit.output_v * (1 + lit.supply_tolerance) - least_v
    least_ohm = resistor * (1 - lit.resistor_tolerance)
    most_ohm = resistor * (1 + lit.resistor_tolerance)
    return 1000 * low_v / most_ohm, 1000 * high_v / least_ohm, high_v**2 / least_ohm


def _wrong(read: ReadBoard, lit: Indicator) -> Iterator[str]:
    """Pads that are not where they belong, and an LED that cannot be seen."""
    led, supply = lit.led_ref, _feeding(read, lit)
    ends = {read.group(lit.resistor_ref, 1), read.group(lit.resistor_ref, 2)}
    for ref, pad, found, wanted in (
        (lit.resistor_ref, "supply end", {supply} & ends, {supply}),
        (led, "anode", {read.group(led, _ANODE)}, ends - {supply, None}),
        (led, "cathode", {read.group(led, _CATHODE)}, {_ground(read, lit)}),
    ):
        if not wanted or None in wanted or found != wanted:
            yield f"{ref}: {pad}"
    part = read.parts.get(led)
    if part is not None and not part.front:
        yield f"{led}: on the back"


def _feeding(read: ReadBoard, lit: Indicator) -> int | None:
    """The flange's output; on another board the controller's supply, at the receiver's wire."""
    if lit.board == _FLANGE:
        return output_of(read)
    return _at_wire(read, read.design.receiver.connector.supply)


def _ground(read: ReadBoard, lit: Indicator) -> int | None:
    return read.group(_TVS, "2") if lit.board == _FLANGE else _at_wire(read, GROUND)


def _at_wire(read: ReadBoard, net: str) -> int | None:
    """The copper at a cable's wire."""
    for device in (d for d in read.components if d.kind == "wires" and d.pins):
        for number, name in device.nets:
            if name == net:
                return read.group(device.ref, number)
    return None


def output_of(read: ReadBoard) -> int | None:
    """The output's copper: the coil's end away from the regulator; the supply behind the MOSFET
    where there is no regulator."""
    if _COIL not in read.parts:
        return read.group(_TVS, "1")
    names = next((device.pins for device in read.components if device.ref == "U1"), ())
    switch = read.group("U1", names.index("SW") + 1) if "SW" in names else None
    ends = {read.group(_COIL, 1), read.group(_COIL, 2)} - {switch, None}
    return ends.pop() if len(ends) == 1 else None


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
