"""Netlists for ngspice: a string, a channel, and the flange's switching regulator."""

from collections.abc import Iterable, Iterator

from lumitip_fab.boards.circuit import cathodes_of, circuit
from lumitip_fab.boards.model import GROUND
from lumitip_fab.boards.spice_channel import STEPS, channel, corners, detectors, first_mux
from lumitip_fab.design import AuxiliaryBoard, Component, Design, Finger
from lumitip_fab.design.electrical import Regulated
from lumitip_fab.pipeline.artefact import Artefact

_TEMPERATURE_C = 26.85  # 300 K, as in the closed forms
_THERMAL_V = 0.0258520  # of ngspice at that temperature


def simulation(design: Design, finger: Finger) -> tuple[Artefact, ...]:
    """The netlists of a finger's board: its first string; or its first multiplexer with two
    detectors, once as current sinks and once as phototransistors."""
    parts = circuit(design, finger)
    if not any(part.kind == "multiplexer" for part in parts):
        return (_netlist(design, finger, "", _string(parts, design)),)
    nets = first_mux(parts, design)
    slowest = detectors(nets, design, corners(design)[-1], STEPS["dimmed"])
    return (
        _netlist(design, finger, "", channel(nets, design)),
        _netlist(design, finger, "_detectors", slowest),
    )


def _netlist(design: Design, finger: Finger, ending: str, lines: Iterable[str]) -> Artefact:
    title = design.title.on_boards().name
    whole = (
        f"* {title}, {finger.name}, design {design.reading.design_hash[:8]}",
        *lines,
        f".options temp={_TEMPERATURE_C} tnom={_TEMPERATURE_C} reltol=1e-5 vntol=1e-7",
        ".end",
    )
    path = f"boards/{finger.name}/{finger.name}{ending}.cir"
    return Artefact(path, ("\n".join(whole) + "\n").encode(), frame="")


def _string(parts: tuple[Component, ...], design: Design) -> Iterator[str]:
    """The first string at its supply; `i_ma` is its current."""
    wiring, packages, strings = design.wiring, design.packages, design.electrical.strings
    anode, cathode = ("1", "2") if packages.led.marked == "anode" else ("2", "1")
    leds = {dict(p.nets)[anode]: p for p in parts if p.kind == "led"}
    supply, net = (net for part in parts if part.ref == "R1" for _, net in part.nets)
    yield f"Vsupply {supply} 0 {wiring.supply_v:g}"
    yield f"R1 {supply} {net} {wiring.resistor_ohm[0]:g}"
    end = cathodes_of(design)
    while net != end:
        led = leds[net]
        left, net = net, dict(led.nets)[cathode]
        yield f"{led.ref} {left} {'0' if net == GROUND else net} led"
    if packages.switch is not None:
        yield f"RQ1 {end} 0 {packages.switch.on_ohm:g}"  # Q1 while the LEDs are on
    # Saturation current with which the forward voltage at the target current is as stated.
    exponent = strings.forward_v / (strings.ideality * _THERMAL_V)
    amperes = f"{strings.target_ma / 1000:g}/(exp({exponent:.9g})-1)"
    yield f".model led d(n={strings.ideality:g} is={{{amperes}}})"
    yield from (".control", "op", "let i_ma = -1000*i(vsupply)", "print i_ma", ".endc")


_SETTLE_MS = 0.5  # from the end of the soft start to the ripple that is measured
_WINDOW_US = 20.0  # over which it is measured
_STEP_SHARE = 0.013  # of a period of switching
_EDGE_SHARE = 0.016  # of a period: the sawtooth's fall
_SHARPNESS = 60  # of the comparator; its edges take about 1/60 of a period
_DAMPING_OHM, _INTEGRAL_S = 0.6, 1e-4


def supply_simulation(design: Design, regulated: AuxiliaryBoard) -> tuple[Artefact, ...]:
    """The netlist of a board's switching regulator."""
    (supply,) = design.electrical.supplies
    title = design.title.on_boards()
    lines = (
        f"* {title.name} {title.revision}, {regulated.name}: its regulator",
        *_circuit(regulated, supply),
        *_measured(regulated, supply),
        ".end",
    )
    path = f"boards/{regulated.name}/{regulated.name}.cir"
    return (Artefact(path, ("\n".join(lines) + "\n").encode(), frame=""),)


def _circuit(auxiliary: AuxiliaryBoard, regulated: Regulated) -> Iterator[str]:
    supply, coil_in, output = _nets(auxiliary)
    period_ns = 1e6 / regulated.switching_khz
    edge_ns = _EDGE_SHARE * period_ns
    load_ohm = regulated.output_v / regulated.load_a
    yield f"Vsupply {supply} 0 {regulated.input_v:g}"
    above = f"0.5+0.5*tanh({_SHARPNESS}*(v(duty)-v(ramp)))"
    yield f"Bswitch drive 0 v=v({supply})*({above})"
    yield f"Rswitch drive {coil_in} {regulated.switch_ohm:.4g}"
    yield f"L1 {coil_in} {output} {regulated.inductance_uh:g}u"
    for device in auxiliary.components:
        if device.ref in regulated.capacitors:
            high, low = (net if net != GROUND else "0" for _, net in device.nets)
            yield f"{device.ref} {high} {low} {regulated.capacitor_uf:g}u"
    yield f"Rload {output} 0 {load_ohm:g}"
    high_ns = period_ns - 2 * edge_ns
    yield f"Vramp ramp 0 pulse(0 1 0 {high_ns:.3f}n {edge_ns:.3f}n {edge_ns:.3f}n {period_ns:.3f}n)"
    yield f"Vsoft soft 0 pwl(0 0 {regulated.soft_start_ms:g}m {regulated.output_v:g})"
    yield f"Bwrong wrong 0 v=v(soft)-v({output})"
    yield f"Gsum 0 sum wrong 0 {1e-6 / _INTEGRAL_S:g}"
    yield "Csum sum 0 1u"
    yield "Rsum sum 0 1g"
    into = f"{_DAMPING_OHM:g}*(i(L1)-v({output})/{load_ohm:g})"
    yield f"Bduty duty 0 v=min(max((v(soft)+v(sum)+v(wrong)-{into})/v({supply}),0),0.95)"


def _measured(auxiliary: AuxiliaryBoard, regulated: Regulated) -> Iterator[str]:
    """`mean_v`, `ripple_mv` and `ripple_a` once it stands; `start_ms` to 95 %, `top_v` and `peak_a`
    of all the time."""
    _, _, output = _nets(auxiliary)
    end_us = 1e3 * (regulated.soft_start_ms + _SETTLE_MS)
    step_ns = _STEP_SHARE * 1e6 / regulated.switching_khz
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
        f"meas tran rise_s when v({output})={0.95 * regulated.output_v:g} rise=1",
        "let ripple_mv = 1000*(high_v - low_v)",
        "let ripple_a = high_a - low_a",
        "let start_ms = 1000*rise_s",
        "print mean_v ripple_mv ripple_a top_v peak_a start_ms",
        ".endc",
    )


def _nets(auxiliary: AuxiliaryBoard) -> tuple[str, str, str]:
    """Nets of the regulator's input, and of its coil's two ends."""
    (input_net,) = (
        net
        for device in auxiliary.components
        for number, net in device.nets
        if (device.ref, number) == auxiliary.hot_loop[0]
    )
    (coil,) = (device for device in auxiliary.components if device.kind == "inductor")
    (_, near), (_, far) = coil.nets
    return input_net, near, far
