"""The power LED of the flange's board, followed along the copper, with its currents."""

import math
import re
from collections.abc import Iterator

from lumitip_fab.checks.board_read import ReadBoard, ohm
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design.electrical import Indicator

LED, RESISTOR = "D2", "R4"
_CATHODE, _ANODE = "1", "2"
_COIL, _TVS = "L1", "D1"


def measure_indicator(read: ReadBoard) -> Iterator[Measurement]:
    """The way from the output over resistor and LED to ground, the side that the LED stands on, its
    currents, and the resistor's power; all from the values on the written board."""
    if not any(flange.auxiliary == read.name for flange in read.design.flanges):
        return
    for lit in read.design.electrical.indicators:
        yield read.count("indicator", list(_wrong(read)), "pads")
        resistor = ohm(read.parts[RESISTOR].value) if RESISTOR in read.parts else math.nan
        low_ma, high_ma, watt = _figures(lit, resistor)
        unseen = "at the lowest output, highest forward voltage and highest resistance"
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


def _wrong(read: ReadBoard) -> Iterator[str]:
    """Pads that are not where they belong, and an LED that cannot be seen."""
    node = _ends(read) - {output_of(read), None}
    for ref, pad, found, wanted in (
        (RESISTOR, "supply end", {output_of(read)} & _ends(read), {output_of(read)}),
        (LED, "anode", {read.group(LED, _ANODE)}, node),
        (LED, "cathode", {read.group(LED, _CATHODE)}, {read.group(_TVS, "2")}),
    ):
        if not wanted or None in wanted or found != wanted:
            yield f"{ref}: {pad}"
    part = read.parts.get(LED)
    if part is not None and not part.front:
        yield f"{LED}: on the side of the contacts"


def _ends(read: ReadBoard) -> set[int | None]:
    return {read.group(RESISTOR, 1), read.group(RESISTOR, 2)}


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
