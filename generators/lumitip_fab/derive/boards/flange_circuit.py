"""The circuit of the flange's board: contact map, ratings of its parts, and its regulator."""

import json
import math

from lumitip_fab.catalogue.controllers import OPEN, Strip
from lumitip_fab.catalogue.grippers import Contact, ToolCoupling
from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring.ratings import (
    MOST_RESISTOR_LOAD,
    RESISTOR_TOLERANCE,
    SUPPLY_TOLERANCE,
    refuse_flange_capacitors,
    sold_ohm,
)
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
        faults.refuse(
            "flange.contacts",
            f"is {p.contacts!r}, {strip.rows} x {strip.ways} contacts with a pitch of "
            f"{strip.pitch_mm:g} mm, which do not match the {len(coupling.contacts)} contacts of "
            f"{p.coupling!r}. Choose another strip or flange.coupling.",
        )
        return
    if len(p.signals) != len(coupling.contacts):
        faults.refuse(
            "flange.signals",
            f"has {len(p.signals)} signals; {p.coupling!r} has {len(coupling.contacts)} contacts: "
            f"one signal for each is needed. Use {_own(coupling)}.",
        )
        return
    for signal in dict.fromkeys(p.signals):
        on = [
            (number, contact)
            for number, contact in enumerate(coupling.contacts, start=1)
            if p.signals[number - 1] == signal
        ]
        if signal != OPEN and (wrong := _wrong(signal, on)):
            faults.refuse(
                "flange.signals",
                f"has {wrong}, by the contact map of {p.coupling!r} in parts/couplings.toml. Use "
                f"{_own(coupling)}, or an entry with the contact map that you measured.",
            )


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
    if not belongs and signal in (*_FOR.values(), "REGULATED"):
        return f"{signal} on {where}, of kind {contact.kind}; a separate signal is needed there"
    return ""


def _own(coupling: ToolCoupling) -> str:
    """The signals that the coupling's map asks for, as TOML."""
    return json.dumps([_FOR.get(contact.kind, contact.carries) for contact in coupling.contacts])


FUSE_SHARE = 0.75  # of its rating that a fuse carries for years
GATE_SHARE = 0.8  # of what the MOSFET's gate bears, at the highest supply
HEADROOM_V = 1.0  # a step-down regulator's input above its output
EFFICIENCY = 0.8  # of the regulator at a small load, assumed
STRAY_PF = 7.0  # at each of the crystal's terminals: 4 of the nRF52840's pin, the rest tracks
MOST_OFF_PF = 1.5  # some 15 ppm of a crystal of 32.768 kHz


def is_regulated(config: Input) -> bool:
    """Whether the flange regulates its output from a higher supply; else they are one net."""
    p = config.parameters
    return p.supply.voltage_v != config.parts.flange.regulator.output_v


def halved(config: Input) -> bool:
    """Whether a divider halves a high supply for the MOSFET's gate."""
    p = config.parameters
    high_v = p.supply.voltage_v * (1 + SUPPLY_TOLERANCE)
    return high_v > GATE_SHARE * config.parts.flange.transistor.gate_v


def supply_range_v(config: Input) -> tuple[float, float]:
    """Least and greatest supply that regulator, fuse and transistor take."""
    parts = config.parts.flange
    part, transistor = parts.regulator, parts.transistor
    gates = 2 if halved(config) else 1
    least = max(
        part.input_v[0],
        part.output_v + HEADROOM_V,
        gates * transistor.gate_on_v / (1 - SUPPLY_TOLERANCE),
    )
    least = math.ceil(10 * least - 1e-6) / 10
    rated = (part.input_v[1], parts.fuse.rated_v, transistor.rated_v)
    return least, min(*rated, gates * transistor.gate_v)


def refuse_parts(config: Input, strings: Strings, faults: Diagnostics) -> None:
    """Refuse parts that are overloaded, and values with which the circuit does not work."""
    faults.refuse_unless(
        config.parts.flange.transistor.channel == "P",
        "flange.transistor",
        f"is {config.parameters.flange.transistor!r}, an N-channel MOSFET; a P-channel one is "
        "needed in the supply",
    )
    _refuse_gate(config, faults)
    _refuse_fuse(config, strings, faults)
    refuse_flange_capacitors(config, faults)
    if config.parts.controller.board.module:
        _refuse_crystal(config, faults)


def _refuse_gate(config: Input, faults: Diagnostics) -> None:
    p = config.parameters
    ohm, volts = p.flange.gate_ohm, p.supply.voltage_v / (2 if halved(config) else 1)
    package = config.parts.flange.resistor
    sold, allowed_w = sold_ohm(ohm), MOST_RESISTOR_LOAD * package.power_w
    faults.refuse_unless(
        math.isclose(sold, ohm),
        "flange.gate_ohm",
        f"is {ohm:g}, which is in neither the E24 nor the E96 series. Use {sold:g}.",
    )
    load_w = (volts * (1 + SUPPLY_TOLERANCE)) ** 2 / (ohm * (1 - RESISTOR_TOLERANCE))
    faults.refuse_unless(
        load_w <= allowed_w,
        "flange.gate_ohm",
        f"is {ohm:g}, with a power of up to {1000 * load_w:.0f} mW at {volts:g} V; the limit of a "
        f"{p.flange.resistor!r} is {1000 * allowed_w:.0f} mW: at least "
        f"{ohm * load_w / allowed_w:.0f} is needed",
    )


def drawn_by_controller_ma(config: Input) -> float:
    """Current of the controller, with the regulator's loss."""
    return config.parts.controller.board.draws_ma / EFFICIENCY


def _refuse_fuse(config: Input, strings: Strings, faults: Diagnostics) -> None:
    p = config.parameters
    output_v = config.parts.flange.regulator.output_v
    fed_ma = drawn_by_controller_ma(config) * output_v / p.supply.voltage_v
    drawn_ma = sum(strings.current_ma) + fed_ma
    allowed_ma = 1000 * FUSE_SHARE * config.parts.flange.fuse.rated_a
    faults.refuse_unless(
        drawn_ma <= allowed_ma,
        "flange.fuse",
        f"is {p.flange.fuse!r}, with a limit of {allowed_ma:.0f} mA ({100 * FUSE_SHARE:g} % of its "
        f"rating); LEDs and controller draw {drawn_ma:.0f} mA. Choose a larger fuse or reduce "
        "emitter.current_ma.",
    )


def _refuse_crystal(config: Input, faults: Diagnostics) -> None:
    """Refuse capacitors with which the crystal is off."""
    p = config.parameters.module
    crystal, each = config.parts.module.crystal, config.parts.module.crystal_capacitor
    load_pf = (1000 * each.capacitance_nf * each.left + STRAY_PF) / 2
    faults.refuse_unless(
        abs(load_pf - crystal.load_pf) <= MOST_OFF_PF,
        "module.crystal_capacitor",
        f"is {p.crystal_capacitor!r}; two of them make a load capacitance of {load_pf:g} pF; "
        f"{p.crystal!r} needs C_L = {crystal.load_pf:g} pF. Use capacitors of "
        f"{2 * crystal.load_pf - STRAY_PF:g} pF.",
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
    faults.refuse_unless(
        ripple_mv <= 1e3 * MOST_RIPPLE * volts,
        "flange.output_capacitor",
        f"is {p.flange.output_capacitor!r}, with a ripple of {ripple_mv:.0f} mV on {volts:g} V; at "
        f"most {1e3 * MOST_RIPPLE * volts:g} mV is allowed. Choose a larger capacitance.",
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
    faults.refuse_unless(
        moved_v <= most_v,
        "flange.input_capacitor",
        f"is {p.flange.input_capacitor!r}, with a ripple of {1000 * moved_v:.0f} mV on "
        f"{p.supply.voltage_v:g} V; at most {1000 * most_v:g} mV is allowed. Choose a larger "
        "capacitance.",
    )
