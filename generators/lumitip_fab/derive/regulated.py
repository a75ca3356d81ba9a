"""What the flange's switching regulator gives, in closed form."""

from lumitip_fab.design.electrical import Regulated
from lumitip_fab.load import Input

LOAD_SHARE = 0.25
"""Of the regulator's largest current: with less than half its ripple it would skip pulses."""
OUTPUT_CAPACITORS = ("C2", "C3")


def derive_regulated(given: Input) -> tuple[Regulated, ...]:
    """The flange's 5 V; none without the flange.

    Ripple of a step-down regulator in continuous conduction: the current swings by
    V (1 - V / V_in) / (L f), and the capacitors take the half of it above the mean,
    which moves them by the swing / (8 f C). Their series resistance, some milliohms, is left out.
    """
    p, known = given.parameters, given.catalogue
    if not p.flange.enabled:
        return ()
    part = known.regulators[p.flange.regulator]
    inductor = known.inductors[p.flange.inductor]
    capacitor = known.capacitors[p.flange.output_capacitor]
    hertz, volts = 1e3 * part.switching_khz, part.output_v
    duty = volts / p.supply.voltage_v
    each_uf = capacitor.capacitance_nf * capacitor.left / 1e3
    farad = len(OUTPUT_CAPACITORS) * each_uf * 1e-6
    ripple_a = volts * (1 - duty) / (inductor.inductance_uh * 1e-6 * hertz)
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
            ripple_mv=1e3 * ripple_a / (8 * hertz * farad),
            charging_a=farad * volts / (part.soft_start_ms * 1e-3),
        ),
    )
