"""The flange as it is plugged into a live supply, computed again from the parts on its board."""

import math
from collections.abc import Iterator
from itertools import product

from lumitip_fab.checks.board_read import ReadBoard, ohm
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design.electrical import PlugIn

MELTING_SHARE = 20.0
"""Of its melting I²t that a fuse takes as often as a robot is switched on, in percent."""
_STEP_S = 2e-9
_END_S = 100e-6


def measure_plug_in(read: ReadBoard) -> Iterator[Measurement]:
    """Voltage behind the resistor, peak and I²t of the current; and the way of the TVS diode.

    The cable's inductance, the resistor and the capacitor are stepped through by their equations
    for both ends of inductance and capacitance. Fuse, MOSFET and TVS diode, which would damp, are
    left out.
    """
    flange = next((f for f in read.design.flanges if f.auxiliary == read.name), None)
    if flange is None:
        return
    ground = next(contact.number for contact in flange.contacts if contact.kind == "ground")
    for plug_in in read.design.electrical.plug_ins:
        yield read.count("tvs", list(_wrong_tvs(read, ground)), "pads")
        if not plug_in.capacitor_uf:
            continue
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


def _wrong_tvs(read: ReadBoard, ground: str) -> Iterator[str]:
    """Pads of the TVS diode that are not where they belong: its cathode, pad 1, on the MOSFET's
    source, its anode on ground."""
    names = next((d.pins for d in read.components if d.ref == "Q1"), ())
    source = str(names.index("S") + 1) if "S" in names else ""
    for pad, wanted in (("1", read.group("Q1", source)), ("2", read.group("J1", ground))):
        found = read.group("D1", pad)
        if found is None or found != wanted:
            yield f"D1.{pad}"


def _undamped(read: ReadBoard) -> Iterator[str]:
    """Capacitors that are on the supply itself, not behind the resistor."""
    supply = read.group("D1", "1")
    for ref in sorted(ref for ref in read.parts if ref.startswith("C")):
        if supply is not None and supply in (read.group(ref, "1"), read.group(ref, "2")):
            yield ref
