"""The parts on the flange's board, held against what this design asks of each."""

import math

from lumitip_fab.derive.capacitors import refuse_flange_capacitors
from lumitip_fab.derive.faults import Faults
from lumitip_fab.derive.wiring import MOST_RESISTOR_LOAD, Strings, sold_ohm
from lumitip_fab.load import Input

FUSE_SHARE = 0.75  # of its rating that a fuse carries for years
EFFICIENCY = 0.8  # of the regulator at a small load, assumed
STRAY_PF = 7.0  # at each of the crystal's terminals: 4 of the nRF52840's pin, the rest tracks
MOST_OFF_PF = 1.5  # some 15 ppm of a crystal of 32.768 kHz


def least_supply_v(given: Input) -> float:
    """Below which half the supply does not switch the MOSFET on."""
    p = given.parameters
    return 2 * given.catalogue.transistors[p.flange.transistor].gate_on_v


def refuse_parts(given: Input, strings: Strings, faults: Faults) -> None:
    """Refuse parts that are overloaded, and values with which the circuit does not work."""
    _refuse_gate(given, faults)
    _refuse_fuse(given, strings, faults)
    refuse_flange_capacitors(given, faults)
    if given.catalogue.controllers[given.parameters.controller.board].module:
        _refuse_crystal(given, faults)


def _refuse_gate(given: Input, faults: Faults) -> None:
    p = given.parameters
    ohm, volts = p.flange.gate_ohm, p.supply.voltage_v / 2
    package = given.catalogue.resistors[p.flange.resistor]
    sold, allowed_w = sold_ohm(ohm), MOST_RESISTOR_LOAD * package.power_w
    faults.refuse_unless(
        math.isclose(sold, ohm),
        "flange.gate_ohm",
        f"{ohm:g} given, which is not sold: a value of the E24 or E96 series is needed, such as "
        f"{sold:g}",
    )
    faults.refuse_unless(
        volts**2 / ohm <= allowed_w,
        "flange.gate_ohm",
        f"{ohm:g} given, which at {volts:g} V takes {1000 * volts**2 / ohm:.0f} mW; a "
        f"{p.flange.resistor!r} may take {1000 * allowed_w:.0f} mW: at least "
        f"{volts**2 / allowed_w:.0f} is needed",
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
