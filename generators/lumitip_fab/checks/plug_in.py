"""The input of the board that the robot's supply enters, followed along the copper, and computed
again as it is plugged into a live supply."""

import math
from collections.abc import Iterator
from itertools import product

from lumitip_fab.checks.board_read import ReadBoard, ohm
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Component
from lumitip_fab.design.electrical import PlugIn

MELTING_SHARE = 20.0
"""Of its melting I²t that a fuse takes as often as a robot is switched on, in percent."""
_STEP_S = 2e-9
_END_S = 100e-6
FROM_SUPPLY, TO_EMITTER = "J7", "J6"
"""Cables of the breakout."""
_BREAKOUT = "breakout"
_CONTACTS = "J1"
_GROUND = "GND"
_FUSE, _MOSFET, _TVS = "F1", "Q1", "D1"
"""On both boards."""


def measure_plug_in(read: ReadBoard) -> Iterator[Measurement]:
    """The way of the supply over fuse and MOSFET, the TVS diode, and what they let through; of the
    flange's board, and without a flange of a breakout that protects its pins."""
    if read.name != _entered(read):
        return
    entry, ground = _poles(read)
    yield read.count("supply_input", list(_wrong_way(read, entry, ground)), "pads")
    yield read.count("tvs", list(_wrong_tvs(read, ground)), "pads")
    plug_in = next((p for p in read.design.electrical.plug_ins if p.board == read.name), None)
    if plug_in is None:
        yield read.figure("plug_in_voltage", math.nan, 0, 0, "V", "no figures in the design")
        return
    note = f"{_MOSFET}, gate to source, while {_TVS} holds a surge"
    yield read.figure("gate_voltage", _gate_v(read, ground, plug_in), 0, plug_in.gate_v, "V", note)
    if plug_in.capacitor_uf:
        yield from _damped(read, plug_in)
        return
    note = "of the TVS diode, at most; of what is behind it"
    yield read.figure("plug_in_voltage", plug_in.breakdown_v[1], 0, plug_in.limit_v, "V", note)


def _entered(read: ReadBoard) -> str | None:
    """The first board that the supply reaches, where that has fuse, MOSFET and TVS diode. The
    published circuit, which protects no pins, has none of them on the breakout."""
    for flange in read.design.flanges:
        return flange.auxiliary
    return next((plug_in.board for plug_in in read.design.electrical.plug_ins), None)


def _poles(read: ReadBoard) -> tuple[int | None, int | None]:
    """Copper of the supply and of ground where they enter the board: at the tool's contacts, or at
    the wire pads."""
    for flange in (f for f in read.design.flanges if f.auxiliary == read.name):
        first = {contact.kind: contact.number for contact in reversed(flange.contacts)}
        supply, ground = (read.group(_CONTACTS, first.get(k, "")) for k in ("supply", "ground"))
        return supply, ground
    name = read.design.emitter.connector.supply
    return at_contact(read, FROM_SUPPLY, name), at_contact(read, FROM_SUPPLY, _GROUND)


def at_contact(read: ReadBoard, ref: str, name: str) -> int | None:
    """Copper of the wire pad, or the contact, with a name."""
    pins: tuple[str, ...] = next((d.pins for d in read.components if d.ref == ref), ())
    return read.group(ref, pins.index(name) + 1) if name in pins else None


def _lead(read: ReadBoard, name: str) -> int | None:
    """Copper at a lead of the MOSFET."""
    return at_contact(read, _MOSFET, name)


def _wrong_way(read: ReadBoard, entry: int | None, ground: int | None) -> Iterator[str]:
    """Pads that are off the way of the supply: from its entry over the fuse to the MOSFET's drain,
    from its source on, with a resistor from the gate to ground."""
    drain, source, gate = (_lead(read, name) for name in "DSG")
    if entry is None or {read.group(_FUSE, 1), read.group(_FUSE, 2)} != {entry, drain}:
        yield _FUSE
    if drain is None or source in (None, drain, entry, ground) or entry == drain:
        yield f"{_MOSFET}: drain and source"
    pulled = [{read.group(d.ref, 1), read.group(d.ref, 2)} for d in read.components if _resists(d)]
    if gate in (None, entry, drain, source, ground) or {gate, ground} not in pulled:
        yield f"{_MOSFET}: gate"
    if read.name == _BREAKOUT:
        fed = at_contact(read, TO_EMITTER, read.design.emitter.connector.supply)
        if fed is None or fed != source:
            yield f"{TO_EMITTER}: not behind {_MOSFET}"


def _gate_v(read: ReadBoard, ground: int | None, plug_in: PlugIn) -> float:
    """Voltage between gate and source with the TVS diode's at its rated pulse on the supply, by the
    resistors from the gate; the whole of it without one to the source."""
    source, gate = (_lead(read, name) for name in "SG")
    siemens = {source: 0.0, ground: 0.0}
    for part in (d.ref for d in read.components if _resists(d)):
        ends = {read.group(part, 1), read.group(part, 2)}
        others = ends - {gate}
        if gate in ends and len(others) == 1 and (other := others.pop()) in siemens:
            siemens[other] += 1.0 / ohm(read.parts[part].value)
    whole = sum(siemens.values())
    return plug_in.clamping_v * (siemens[ground] / whole if whole else 1.0)


def _resists(device: Component) -> bool:
    return device.kind == "resistor"


def _damped(read: ReadBoard, plug_in: PlugIn) -> Iterator[Measurement]:
    """Voltage behind the resistor, peak and I²t of the current.

    The cable's inductance, the resistor and the capacitor are stepped through by their equations
    for both ends of inductance and capacitance. Fuse, MOSFET and TVS diode, which would damp, are
    left out.
    """
    yield read.count("undamped", list(_undamped(read)), "capacitors")
    resistor = ohm(read.parts["R3"].value) if "R3" in read.parts else math.nan
    runs = [
        plugged(plug_in, resistor, cable_uh, 1 + sign * plug_in.capacitor_tolerance)
        for cable_uh, sign in product(plug_in.cable_uh, (-1, 1))
    ]
    volts, amperes, surge = (_worst([run[i] for run in runs]) for i in range(3))
    yield read.figure("plug_in_voltage", volts, 0, plug_in.limit_v, "V", "of the regulator")
    if plug_in.pulse_a is not None:
        note = "through the MOSFET"
        yield read.figure("plug_in_current", amperes, 0, plug_in.pulse_a, "A", note)
    if plug_in.melting_a2s is not None:
        share = 100 * surge / plug_in.melting_a2s
        note = "of the fuse's melting I²t"
        yield read.figure("plug_in_surge", share, 0, MELTING_SHARE, "%", note)


def _worst(figures: list[float]) -> float:
    return math.nan if any(map(math.isnan, figures)) else max(figures)


def plugged(
    plug_in: PlugIn, resistor: float, cable_uh: float, share: float
) -> tuple[float, float, float]:
    """Highest voltage, highest current and I²t of a cable, a resistor and a capacitor in series.

    Explicit steps of 2 ns, by the trapezoid of Heun. The current does not flow back: the capacitor
    keeps its highest voltage until the MOSFET is on.
    """
    if math.isnan(resistor):
        return math.nan, math.nan, math.nan
    henry, farad = cable_uh * 1e-6, plug_in.capacitor_uf * 1e-6 * share
    squared = (1 / plug_in.left - 1) / plug_in.left_at_v**2

    def slopes(ampere: float, volt: float) -> tuple[float, float]:
        rise = (plug_in.supply_v - resistor * ampere - volt) / henry
        return rise, ampere * (1 + squared * volt**2) / farad

    ampere = volt = peak = surge = 0.0
    for _ in range(round(_END_S / _STEP_S)):
        rise, climb = slopes(ampere, volt)
        later = slopes(max(ampere + _STEP_S * rise, 0.0), volt + _STEP_S * climb)
        volt += _STEP_S * (climb + later[1]) / 2
        ampere = max(ampere + _STEP_S * (rise + later[0]) / 2, 0.0)
        peak, surge = max(peak, ampere), surge + _STEP_S * ampere**2
        if ampere == 0.0:
            break
    return volt, peak, surge


def _wrong_tvs(read: ReadBoard, ground: int | None) -> Iterator[str]:
    """Pads of the TVS diode that are not where they belong: its cathode, pad 1, on the MOSFET's
    source, its anode on ground."""
    for pad, wanted in (("1", _lead(read, "S")), ("2", ground)):
        found = read.group(_TVS, pad)
        if found is None or found != wanted:
            yield f"{_TVS}.{pad}"


def _undamped(read: ReadBoard) -> Iterator[str]:
    """Capacitors that are on the supply itself, not behind the resistor."""
    supply = read.group(_TVS, "1")
    for ref in sorted(ref for ref in read.parts if ref.startswith("C")):
        if supply is not None and supply in (read.group(ref, "1"), read.group(ref, "2")):
            yield ref
