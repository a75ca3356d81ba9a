"""The netlist for ngspice of a carrier's switching regulator: start-up, then ripple.

A behavioural model: the regulator is a voltage at SW that is the supply while its duty cycle is
above a sawtooth, with the resistance of its switches; the duty cycle follows a reference that rises
over the soft start, by the error, its integral and the current into the capacitors. The part's own
loop is not published. Below half the ripple current the real part skips pulses; this one does not.
"""

from collections.abc import Iterator

from lumitip_fab.artefact import Artefact
from lumitip_fab.boards.circuit import GROUND
from lumitip_fab.design import Carrier, Electrical, Title
from lumitip_fab.design.electrical import Regulated

_SETTLE_MS = 0.5  # from the end of the soft start to the ripple that is measured
_WINDOW_US = 20.0  # over which it is measured
_STEP_SHARE = 0.013  # of a period of switching
_EDGE_SHARE = 0.016  # of a period: the sawtooth's fall
_SHARPNESS = 60  # of the comparator; its edges take about 1/60 of a period
_DAMPING_OHM, _INTEGRAL_S = 0.6, 1e-4


def supply_simulation(
    title: Title, regulated: Carrier, electrical: Electrical
) -> tuple[Artefact, ...]:
    """The netlist of a carrier's regulator.

    Args:
        title: of the design.
        regulated: the carrier, whose nets join coil, capacitors and regulator.
        electrical: what they are.
    """
    (told,) = electrical.supplies
    lines = (
        f"* {title.on_boards().name} {title.revision}, {regulated.name}: its regulator",
        *_circuit(regulated, told),
        *_measured(regulated, told),
        ".end",
    )
    path = f"boards/{regulated.name}/{regulated.name}.cir"
    return (Artefact(path, ("\n".join(lines) + "\n").encode(), frame=""),)


def _circuit(carrier: Carrier, told: Regulated) -> Iterator[str]:
    supply, coil_in, output = _nets(carrier)
    period_ns = 1e6 / told.switching_khz
    edge_ns = _EDGE_SHARE * period_ns
    load_ohm = told.output_v / told.load_a
    yield f"Vsupply {supply} 0 {told.input_v:g}"
    above = f"0.5+0.5*tanh({_SHARPNESS}*(v(duty)-v(ramp)))"
    yield f"Bswitch drive 0 v=v({supply})*({above})"
    yield f"Rswitch drive {coil_in} {told.switch_ohm:.4g}"
    yield f"L1 {coil_in} {output} {told.inductance_uh:g}u"
    for device in carrier.devices:
        if device.ref in told.capacitors:
            high, low = (net if net != GROUND else "0" for _, net in device.nets)
            yield f"{device.ref} {high} {low} {told.capacitor_uf:g}u"
    yield f"Rload {output} 0 {load_ohm:g}"
    high_ns = period_ns - 2 * edge_ns
    yield f"Vramp ramp 0 pulse(0 1 0 {high_ns:.3f}n {edge_ns:.3f}n {edge_ns:.3f}n {period_ns:.3f}n)"
    yield f"Vsoft soft 0 pwl(0 0 {told.soft_start_ms:g}m {told.output_v:g})"
    yield f"Bwrong wrong 0 v=v(soft)-v({output})"
    yield f"Gsum 0 sum wrong 0 {1e-6 / _INTEGRAL_S:g}"
    yield "Csum sum 0 1u"
    yield "Rsum sum 0 1g"
    into = f"{_DAMPING_OHM:g}*(i(L1)-v({output})/{load_ohm:g})"
    yield f"Bduty duty 0 v=min(max((v(soft)+v(sum)+v(wrong)-{into})/v({supply}),0),0.95)"


def _measured(carrier: Carrier, told: Regulated) -> Iterator[str]:
    """`mean_v`, `ripple_mv` and `ripple_a` once it stands; `start_ms` to 95 %, `top_v` and `peak_a`
    of all the time."""
    _, _, output = _nets(carrier)
    end_us = 1e3 * (told.soft_start_ms + _SETTLE_MS)
    step_ns = _STEP_SHARE * 1e6 / told.switching_khz
    window = f"from={end_us - _WINDOW_US - 1:g}u to={end_us - 1:g}u"
    yield ".options reltol=1e-4 trtol=1"
    yield from (
        ".control",
        f"save v({output}) i(L1)",
        f"tran {step_ns:.3f}n {end_us:g}u 0 {step_ns:.3f}n uic",
        f"meas tran mean_v avg v({output}) {window}",
        f"meas tran high_v max v({output}) {window}",
        f"meas tran low_v min v({output}) {window}",
        f"meas tran high_a max i(L1) {window}",
        f"meas tran low_a min i(L1) {window}",
        f"meas tran top_v max v({output})",
        "meas tran peak_a max i(L1)",
        f"meas tran rise_s when v({output})={0.95 * told.output_v:g} rise=1",
        "let ripple_mv = 1000*(high_v - low_v)",
        "let ripple_a = high_a - low_a",
        "let start_ms = 1000*rise_s",
        "print mean_v ripple_mv ripple_a top_v peak_a start_ms",
        ".endc",
    )


def _nets(carrier: Carrier) -> tuple[str, str, str]:
    """Nets of the regulator's input, and of its coil's two ends."""
    (input_net,) = (net for device in carrier.devices for number, net in device.nets
                    if (device.ref, number) == carrier.hot_loop[0])  # fmt: skip
    (coil,) = (device for device in carrier.devices if device.kind == "inductor")
    (_, near), (_, far) = coil.nets
    return input_net, near, far
