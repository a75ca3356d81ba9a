"""The parts on the flange's board, held against what this design asks of each."""

import math

from lumitip_fab.derive.capacitors import refuse_flange_capacitors
from lumitip_fab.derive.faults import Faults
from lumitip_fab.derive.led_strings import (
    MOST_RESISTOR_LOAD,
    RESISTOR_TOLERANCE,
    SUPPLY_TOLERANCE,
    sold_ohm,
)
from lumitip_fab.derive.wiring import Strings
from lumitip_fab.load import Input

FUSE_SHARE = 0.75  # of its rating that a fuse carries for years
GATE_SHARE = 0.8  # of what the MOSFET's gate bears, at the highest supply
HEADROOM_V = 1.0  # a step-down regulator's input above its output
EFFICIENCY = 0.8  # of the regulator at a small load, assumed
STRAY_PF = 7.0  # at each of the crystal's terminals: 4 of the nRF52840's pin, the rest tracks
MOST_OFF_PF = 1.5  # some 15 ppm of a crystal of 32.768 kHz


def is_regulated(given: Input) -> bool:
    """Whether the flange makes its output from a higher supply; else they are one net."""
    p = given.parameters
    return p.supply.voltage_v != given.catalogue.regulators[p.flange.regulator].output_v


def halved(given: Input) -> bool:
    """Whether a divider halves the supply for the MOSFET's gate, which bears no high supply."""
    p = given.parameters
    high_v = p.supply.voltage_v * (1 + SUPPLY_TOLERANCE)
    return high_v > GATE_SHARE * given.catalogue.transistors[p.flange.transistor].gate_v


def supply_range_v(given: Input) -> tuple[float, float]:
    """Least and greatest supply that regulator, fuse and transistor take."""
    p, known = given.parameters.flange, given.catalogue
    part, transistor = known.regulators[p.regulator], known.transistors[p.transistor]
    gates = 2 if halved(given) else 1
    least = max(
        part.input_v[0],
        part.output_v + HEADROOM_V,
        gates * transistor.gate_on_v / (1 - SUPPLY_TOLERANCE),
    )
    rated = (part.input_v[1], known.fuses[p.fuse].rated_v, transistor.rated_v)
    return least, min(*rated, gates * transistor.gate_v)


def refuse_parts(given: Input, strings: Strings, faults: Faults) -> None:
    """Refuse parts that are overloaded, and values with which the circuit does not work."""
    _refuse_gate(given, faults)
    _refuse_fuse(given, strings, faults)
    refuse_flange_capacitors(given, faults)
    if given.catalogue.controllers[given.parameters.controller.board].module:
        _refuse_crystal(given, faults)


def _refuse_gate(given: Input, faults: Faults) -> None:
    p = given.parameters
    ohm, volts = p.flange.gate_ohm, p.supply.voltage_v / (2 if halved(given) else 1)
    package = given.catalogue.resistors[p.flange.resistor]
    sold, allowed_w = sold_ohm(ohm), MOST_RESISTOR_LOAD * package.power_w
    faults.refuse_unless(
        math.isclose(sold, ohm),
        "flange.gate_ohm",
        f"{ohm:g} given, which is not sold: a value of the E24 or E96 series is needed, such as "
        f"{sold:g}",
    )
    load_w = (volts * (1 + SUPPLY_TOLERANCE)) ** 2 / (ohm * (1 - RESISTOR_TOLERANCE))
    faults.refuse_unless(
        load_w <= allowed_w,
        "flange.gate_ohm",
        f"{ohm:g} takes up to {1000 * load_w:.0f} mW at {volts:g} V; a {p.flange.resistor!r} takes "
        f"at most {1000 * allowed_w:.0f} mW: at least {ohm * load_w / allowed_w:.0f} is needed",
    )


def _refuse_fuse(given: Input, strings: Strings, faults: Faults) -> None:
    p, known = given.parameters, given.catalogue
    fed_ma = known.controllers[p.controller.board].draws_ma / EFFICIENCY
    output_v = known.regulators[p.flange.regulator].output_v
    drawn_ma = sum(strings.current_ma) + fed_ma * output_v / p.supply.voltage_v
    allowed_ma = 1000 * FUSE_SHARE * known.fuses[p.flange.fuse].rated_a
    faults.refuse_unless(
        drawn_ma <= allowed_ma,
        "flange.fuse",
        f"{p.flange.fuse!r} given, which carries {allowed_ma:.0f} mA for years; LEDs and "
        f"controller draw {drawn_ma:.0f} mA: a larger one, or less emitter.current_ma",
    )


def _refuse_crystal(given: Input, faults: Faults) -> None:
    """Refuse capacitors with which the crystal is off."""
    p, known = given.parameters.module, given.catalogue
    crystal, each = known.crystals[p.crystal], known.capacitors[p.crystal_capacitor]
    load_pf = (1000 * each.capacitance_nf * each.left + STRAY_PF) / 2
    faults.refuse_unless(
        abs(load_pf - crystal.load_pf) <= MOST_OFF_PF,
        "module.crystal_capacitor",
        f"{p.crystal_capacitor!r} given, two of which load the crystal with {load_pf:g} pF; "
        f"{p.crystal!r} is made for {crystal.load_pf:g} pF: capacitors of "
        f"{2 * crystal.load_pf - STRAY_PF:g} pF are needed",
    )
