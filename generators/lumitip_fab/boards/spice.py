"""Netlists for ngspice: a string, a detector, and the flange's switching regulator."""

from collections.abc import Iterator

from lumitip_fab.boards.circuit import GROUND, circuit
from lumitip_fab.design import (
    AuxiliaryBoard,
    Component,
    Design,
    Electrical,
    Finger,
    Packages,
    Wiring,
)
from lumitip_fab.design.electrical import Regulated
from lumitip_fab.pipeline.artefact import Artefact

_TEMPERATURE_C = 26.85  # 300 K, as in the closed forms
_THERMAL_V = 0.0258520  # of ngspice at that temperature
_KNEE_V = 0.001  # over which a detector takes up its current
_BEFORE_US, _CONSTANTS = 200, 25  # time before the change of channel; time constants after it
Parts = tuple[Component, ...]


def simulation(design: Design, finger: Finger) -> tuple[Artefact, ...]:
    """The netlist of a finger's board: its first string, or its first multiplexer with two
    detectors."""
    wiring, packages = design.wiring, design.packages
    parts = circuit(design, finger).components
    body = _string if finger.cells_hold.kind == "led" else _channel
    title = design.title.on_boards().name
    lines = (
        f"* {title}, {finger.name}, design {design.reading.design_hash[:8]}",
        *body(parts, wiring, packages, design.electrical),
        f".options temp={_TEMPERATURE_C} tnom={_TEMPERATURE_C} reltol=1e-5 vntol=1e-7",
        ".end",
    )
    text = "\n".join(lines) + "\n"
    return (Artefact(f"boards/{finger.name}/{finger.name}.cir", text.encode(), frame=""),)


def _string(
    parts: Parts, wiring: Wiring, packages: Packages, electrical: Electrical
) -> Iterator[str]:
    """The first string at its supply; `i_ma` is its current."""
    strings = electrical.strings
    anode, cathode = ("1", "2") if packages.led.marked == "anode" else ("2", "1")
    leds = {dict(p.nets)[anode]: p for p in parts if p.kind == "led"}
    supply, net = (net for part in parts if part.ref == "R1" for _, net in part.nets)
    yield f"Vsupply {supply} 0 {wiring.supply_v:g}"
    yield f"R1 {supply} {net} {wiring.resistor_ohm[0]:g}"
    while net != GROUND:
        led = leds[net]
        left, net = net, dict(led.nets)[cathode]
        yield f"{led.ref} {left} {'0' if net == GROUND else net} led"
    # Saturation current with which the forward voltage at the target current is as stated.
    exponent = strings.forward_v / (strings.ideality * _THERMAL_V)
    amperes = f"{strings.target_ma / 1000:g}/(exp({exponent:.9g})-1)"
    yield f".model led d(n={strings.ideality:g} is={{{amperes}}})"
    yield from (".control", "op", "let i_ma = -1000*i(vsupply)", "print i_ma", ".endc")


def _channel(
    parts: Parts, wiring: Wiring, packages: Packages, electrical: Electrical
) -> Iterator[str]:
    """The first multiplexer as it changes from a detector in full light to one in the dark.

    `full_v` and `dark_v` are what the controller reads before and long after the change,
    `settle_us` the time until it is within half a step of the latter.
    """
    channel, mux = electrical.channel, packages.multiplexer
    leads = next(dict(part.nets) for part in parts if part.ref == "U1")
    supply, line = leads[str(mux.supply)], leads[str(mux.output)]
    detectors = [n for n in (leads[str(lead)] for lead in mux.input_leads) if n != GROUND]
    lit, dark = detectors[0], detectors[-1]
    seconds = wiring.pull_up_ohm * (channel.line_pf + channel.detector_pf) * 1e-12
    after_us = _CONSTANTS * seconds * 1e6
    end_us = _BEFORE_US + after_us
    yield f"Vsupply {supply} 0 {channel.supply_v:g}"
    yield f"R1 {supply} {line} {wiring.pull_up_ohm:g}"
    yield f"Cline {line} 0 {channel.line_pf:g}p"
    for net, amperes, knee_at, on in (
        (lit, channel.light_current_ua * 1e-6, channel.saturation_v, "1 0"),
        (dark, channel.dark_current_na * 1e-9, 0.0, "0 1"),
    ):
        yield f"C{net} {net} 0 {channel.detector_pf:g}p"
        share = f"min(max((v({net})-{knee_at:g})/{_KNEE_V:g},0),1)"
        yield f"B{net} {net} 0 i={amperes:g}*{share}"
        yield f"S{net} {net} {line} on{net} 0 channel"
        yield f"V{net} on{net} 0 pulse({on} {_BEFORE_US}u 1n 1n 1)"
    yield f".model channel sw(ron={channel.on_resistance_ohm:g} roff=1e12 vt=0.5)"
    yield from (
        ".control",
        f"tran {after_us / 1000:g}u {end_us:g}u 0 {after_us / 1000:g}u",
        f"meas tran full_v find v({line}) at={_BEFORE_US - 1}u",
        f"meas tran dark_v find v({line}) at={end_us - 1:g}u",
        f"let target = dark_v - {channel.step_v / 2:g}",
        f"meas tran t_end when v({line})=target rise=last",
        f"let settle_us = t_end*1e6 - {_BEFORE_US}",
        "print full_v dark_v settle_us",
        ".endc",
    )


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
