"""What the flange's switching regulator gives, in closed form."""

from lumitip_fab.derive.faults import Faults
from lumitip_fab.derive.flange_parts import is_regulated
from lumitip_fab.design.electrical import Regulated
from lumitip_fab.load import Input

LOAD_SHARE = 0.25
"""Of the regulator's largest current: with less than half its ripple it would skip pulses."""
MOST_RIPPLE = 0.01  # of the output, and of the supply at the input
OUTPUT_CAPACITORS = ("C2", "C3")


def derive_regulated(given: Input, faults: Faults) -> tuple[Regulated, ...]:
    """The flange's 5 V; none without the flange, or where they are its supply.

    Ripple of a step-down regulator in continuous conduction: the current swings by
    V (1 - V / V_in) / (L f), and the capacitors take the half of it above the mean,
    which moves them by the swing / (8 f C). Their series resistance, some milliohms, is left out.
    """
    p, known = given.parameters, given.catalogue
    if not p.flange.enabled or not is_regulated(given):
        return ()
    part = known.regulators[p.flange.regulator]
    inductor = known.inductors[p.flange.inductor]
    capacitor = known.capacitors[p.flange.output_capacitor]
    hertz, volts = 1e3 * part.switching_khz, part.output_v
    duty = volts / p.supply.voltage_v
    each_uf = capacitor.capacitance_nf * capacitor.left / 1e3
    farad = len(OUTPUT_CAPACITORS) * each_uf * 1e-6
    ripple_a = volts * (1 - duty) / (inductor.inductance_uh * 1e-6 * hertz)
    ripple_mv = 1e3 * ripple_a / (8 * hertz * farad)
    faults.refuse_unless(
        ripple_mv <= 1e3 * MOST_RIPPLE * volts,
        "flange.output_capacitor",
        f"{p.flange.output_capacitor!r} given, with which {volts:g} V ripple by {ripple_mv:.0f} "
        f"mV; at most {1e3 * MOST_RIPPLE * volts:g} mV are allowed: more capacitance",
    )
    _refuse_input(given, LOAD_SHARE * part.output_a * duty * (1 - duty) / hertz, faults)
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


def _refuse_input(given: Input, coulomb: float, faults: Faults) -> None:
    """Refuse an input capacitor that does not hold the supply while the switch takes a charge."""
    p = given.parameters
    capacitor = given.catalogue.capacitors[p.flange.input_capacitor]
    moved_v = coulomb / (1e-9 * capacitor.capacitance_nf * capacitor.left)
    most_v = MOST_RIPPLE * p.supply.voltage_v
    faults.refuse_unless(
        moved_v <= most_v,
        "flange.input_capacitor",
        f"{p.flange.input_capacitor!r} given, with which {p.supply.voltage_v:g} V ripple by "
        f"{1000 * moved_v:.0f} mV; at most {1000 * most_v:g} mV are allowed: more capacitance",
    )
