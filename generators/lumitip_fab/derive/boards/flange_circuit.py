"""The circuit of the flange's board: contact map, ratings of its parts, and its regulator."""

import json
import math

from lumitip_fab.catalogue.controllers import OPEN, Strip
from lumitip_fab.catalogue.grippers import Contact, ToolCoupling
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.supply_input import input_range_v, is_regulated, refuse_input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring import ratings
from lumitip_fab.derive.wiring.strings import Strings
from lumitip_fab.design.electrical import Regulated

PLACE_MM = 0.05
_FOR = {"supply": "SUPPLY", "ground": "GND"}
"""Signal that belongs on a contact of a kind, and on no other."""


def refuse_map(config: Input, faults: Diagnostics) -> None:
    """Refuse contacts where the coupling has none, and nets that join what must stay apart."""
    p = config.parameters.flange
    coupling = config.parts.flange.coupling
    strip = config.parts.flange.contacts
    if not _meets(strip, coupling):
        faults.add("contacts_differ", strip=strip, contacts_count=len(coupling.contacts))
        return
    if len(p.signals) != len(coupling.contacts):
        faults.add(
            "signal_count",
            signals_count=len(p.signals),
            contacts_count=len(coupling.contacts),
            signals=_own(coupling),
        )
        return
    for signal in dict.fromkeys(p.signals):
        on = [
            (number, contact)
            for number, contact in enumerate(coupling.contacts, start=1)
            if p.signals[number - 1] == signal
        ]
        if signal != OPEN and (wrong := _wrong(signal, on)):
            faults.add("contact_signal", wrong=wrong, signals=_own(coupling))


def _meets(strip: Strip, coupling: ToolCoupling) -> bool:
    """Whether the contacts of strip and coupling match one to one."""
    x, y = coupling.contacts_at_mm
    needed = [(contact.at_mm[0] - x, contact.at_mm[1] - y) for contact in coupling.contacts]
    offsets = [place - (strip.ways - 1) / 2 for place in range(strip.ways)]
    rows = [place - (strip.rows - 1) / 2 for place in range(strip.rows)]
    there = [(place * strip.pitch_mm, row * strip.pitch_mm) for row in rows for place in offsets]
    near = [min(math.dist(one, other) for other in there) <= PLACE_MM for one in needed]
    return all(near) and len(needed) == len(there)


def _wrong(signal: str, on: list[tuple[int, Contact]]) -> str:
    """Fault of a net on these contacts; empty without one."""
    where = " and ".join(f"{number} ({contact.carries})" for number, contact in on)
    if len({contact.carries for _, contact in on}) > 1:
        return f"{signal} on contacts {where}, which carry different signals"
    where = f"contact{'s' if len(on) > 1 else ''} {where}"
    _, contact = on[0]
    belongs = _FOR.get(contact.kind)
    if contact.kind == "open":
        return f"{signal} on {where}; {OPEN} is needed there"
    if belongs and signal != belongs:
        return f"{signal} on {where}, of kind {contact.kind}; {belongs} is needed there"
    if not belongs and signal in (*_FOR.values(), "SUPPLY_IN", "REGULATED"):
        return f"{signal} on {where}, of kind {contact.kind}; a separate signal is needed there"
    return ""


def _own(coupling: ToolCoupling) -> str:
    """The signals that the coupling's map asks for, as TOML."""
    return json.dumps([_FOR.get(contact.kind, contact.carries) for contact in coupling.contacts])


HEADROOM_V = 1.0  # a step-down regulator's input above its output
STRAY_PF = 7.0  # at each of the crystal's terminals: 4 of the nRF52840's pin, the rest tracks
MOST_OFF_PF = 1.5  # some 15 ppm of a crystal of 32.768 kHz


def supply_range_v(config: Input) -> tuple[float, float]:
    """Least and greatest supply that regulator, fuse and transistor take."""
    part = config.parts.flange.regulator
    least, most = input_range_v(config)
    least = max(part.input_v[0], part.output_v + HEADROOM_V, least)
    return math.ceil(10 * least - 1e-6) / 10, min(part.input_v[1], most)


def refuse_parts(config: Input, strings: Strings, faults: Diagnostics) -> None:
    """Refuse parts that are overloaded, and values with which the circuit does not work."""
    refuse_input(config, strings, faults)
    ratings.refuse_flange_capacitors(config, faults)
    if config.parts.controller.board.module:
        _refuse_crystal(config, faults)


def _refuse_crystal(config: Input, faults: Diagnostics) -> None:
    """Refuse capacitors with which the crystal is off."""
    crystal, each = config.parts.module.crystal, config.parts.module.crystal_capacitor
    load_pf = (1000 * each.capacitance_nf * each.left + STRAY_PF) / 2
    faults.unless(
        abs(load_pf - crystal.load_pf) <= MOST_OFF_PF,
        "crystal_load",
        load_pf=load_pf,
        crystal=crystal,
        needed_pf=2 * crystal.load_pf - STRAY_PF,
    )


LOAD_SHARE = 0.25
"""Least share of the regulator's largest current: below half its ripple it skips pulses."""
MOST_RIPPLE = 0.01  # of the output, and of the supply at the input
OUTPUT_CAPACITORS = ("C2", "C3")


def derive_regulated(config: Input, faults: Diagnostics) -> tuple[Regulated, ...]:
    """The flange's 5 V; none without the flange, or where they are its supply.

    Ripple of a step-down regulator in continuous conduction: the current swings by
    V (1 - V / V_in) / (L f), and the capacitors take the half of it above the mean,
    which moves them by the swing / (8 f C). Their series resistance, some milliohms, is left out.
    """
    p = config.parameters
    if not p.flange.enabled or not is_regulated(config):
        return ()
    part = config.parts.flange.regulator
    inductor = config.parts.flange.inductor
    capacitor = config.parts.flange.output_capacitor
    hertz, volts = 1e3 * part.switching_khz, part.output_v
    duty = volts / p.supply.voltage_v
    each_uf = capacitor.capacitance_nf * capacitor.left / 1e3
    farad = len(OUTPUT_CAPACITORS) * each_uf * 1e-6
    ripple_a = volts * (1 - duty) / (inductor.inductance_uh * 1e-6 * hertz)
    ripple_mv = 1e3 * ripple_a / (8 * hertz * farad)
    faults.unless(
        ripple_mv <= 1e3 * MOST_RIPPLE * volts,
        "output_ripple",
        ripple_mv=ripple_mv,
        volts=volts,
        most=1000.0 * MOST_RIPPLE * volts,
    )
    _refuse_input(config, LOAD_SHARE * part.output_a * duty * (1 - duty) / hertz, faults)
    high_ohm, low_ohm = part.switch_ohm
    return (
        Regulated(
            input_v=p.supply.voltage_v,
            output_v=volts,
            switching_khz=part.switching_khz,
            soft_start_ms=part.soft_start_ms,
            switch_ohm=duty * high_ohm + (1 - duty) * low_ohm,
            inductance_uh=inductor.inductance_uh,
            capacitors=OUTPUT_CAPACITORS,
            capacitor_uf=each_uf,
            load_a=LOAD_SHARE * part.output_a,
            ripple_a=ripple_a,
            ripple_mv=ripple_mv,
            charging_a=farad * volts / (part.soft_start_ms * 1e-3),
        ),
    )


def _refuse_input(config: Input, coulomb: float, faults: Diagnostics) -> None:
    """Refuse an input capacitor that does not hold the supply while the switch takes a charge."""
    p = config.parameters
    capacitor = config.parts.flange.input_capacitor
    moved_v = coulomb / (1e-9 * capacitor.capacitance_nf * capacitor.left)
    most_v = MOST_RIPPLE * p.supply.voltage_v
    faults.unless(moved_v <= most_v, "input_ripple", moved_mv=1000 * moved_v, most_mv=1000 * most_v)
