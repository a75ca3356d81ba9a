"""Netlists for ngspice: of the fingers' boards, and of the flange's switching regulator, and of
the input that is plugged into a live supply."""

import math
from collections.abc import Iterable, Iterator

from lumitip_fab.boards.circuit import circuit
from lumitip_fab.boards.model import GROUND
from lumitip_fab.boards.spice_channel import STEPS, channel, corners, detectors, first_mux, string
from lumitip_fab.design import AuxiliaryBoard, Component, Design, Finger
from lumitip_fab.design.electrical import PlugIn, Regulated
from lumitip_fab.pipeline.artefact import Artefact
from lumitip_fab.text import coded_ohm, passage

_TEMPERATURE_C = 26.85  # 300 K, as in the closed forms


def simulation(design: Design, finger: Finger) -> tuple[Artefact, ...]:
    """The netlists of a finger's board: its first string; or its first multiplexer with two
    detectors, once as current sinks and once as phototransistors."""
    parts = circuit(design, finger)
    if not any(part.kind == "multiplexer" for part in parts):
        return (_netlist(design, finger, "", string(parts, design)),)
    nets = first_mux(parts, design)
    slowest = detectors(nets, design, corners(design)[-1], STEPS["dimmed"])
    return (
        _netlist(design, finger, "", channel(nets, design)),
        _netlist(design, finger, "_detectors", slowest),
    )


def _netlist(design: Design, finger: Finger, ending: str, lines: Iterable[str]) -> Artefact:
    name = design.title.on_boards().name
    title = f"{name}, {finger.name}, design {design.reading.design_hash[:8]}"
    options = f".options temp={_TEMPERATURE_C} tnom={_TEMPERATURE_C} reltol=1e-5 vntol=1e-7"
    return netlist(finger.name, ending, title, (*lines, options))


def netlist(board: str, ending: str, title: str, lines: Iterable[str]) -> Artefact:
    """The netlist of a board, `boards/NAME/NAME_ENDING.cir`, from its title to its end."""
    text = "\n".join((f"* {title}", *lines, ".end")) + "\n"
    return Artefact(f"boards/{board}/{board}{ending}.cir", text.encode(), frame="")


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
    words = f"{title.name} {title.revision}, {regulated.name}: its regulator"
    lines = (*_circuit(regulated, supply), *_measured(regulated, supply))
    return (netlist(regulated.name, "", words, lines),)


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
    yield passage("boards/spice.txt", "regulated").format(
        output=output,
        step_ns=step_ns,
        end_us=end_us,
        window=window,
        high_v=0.95 * regulated.output_v,
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


_END_US, _STEP_NS = 200.0, 10.0
_TVS_PF = 1500.0  # of a 600 W TVS diode of 24 V without voltage, from makers' curves
_FUSE_OHM = 0.001  # its cold resistance would damp: it is left out
_CABLE_OHM = 0.02
_PMOS = "pchan vto=-2 kp=0.4 rd=0.1 rs=0.1 cgs=0.19n cgdmax=0.15n cgdmin=0.02n cjo=0.1n is=1n n=1.2"
"""A MOSFET of 60 V and 0.35 ohm in SOT-23; capacitances by its data sheet at 30 V (C_iss 210 pF,
C_rss 20 pF), without voltage assumed."""


def plug_in_simulation(design: Design, board: AuxiliaryBoard) -> tuple[Artefact, ...]:
    """The netlist of the input of the board that the supply enters."""
    (plug_in,) = design.electrical.plug_ins
    title = design.title.on_boards()
    words = f"{title.name} {title.revision}, {board.name}: plugged into a live supply"
    lines = (*_plugged(board, plug_in), *_surge(board, plug_in))
    return (netlist(board.name, "_plug_in", words, lines),)


def _plugged(board: AuxiliaryBoard, plug_in: PlugIn) -> Iterator[str]:
    parts = {part.ref: part for part in board.components}
    contact, fused = _nets_of(parts["F1"])
    mosfet = dict(zip(parts["Q1"].pins, _nets_of(parts["Q1"]), strict=True))
    supply = mosfet["S"]
    yield f"Vlive live 0 dc 0 pwl(0 0 1n {plug_in.supply_v:g})"
    yield f"Lcable live cable {plug_in.cable_uh[0]:g}u"
    yield f"Rcable cable {contact} {_CABLE_OHM:g}"
    yield f"Rfuse {contact} {fused} {_FUSE_OHM:g}"
    yield f"MQ1 {mosfet['D']} {mosfet['G']} {supply} pmos"
    yield f".model pmos vdmos({_PMOS})"
    for part in board.components:
        if part.kind == "resistor" and mosfet["G"] in _nets_of(part):
            yield f"{part.ref} {' '.join(_nets_of(part))} {coded_ohm(part.value):g}"
    cathode, anode = _nets_of(parts["D1"])
    low, high = plug_in.breakdown_v
    yield f"D1 {anode} {cathode} tvs"
    yield (
        f".model tvs d(bv={(low + high) / 2:g} ibv=1m rs={plug_in.tvs_ohm:.3g} cjo={_TVS_PF:g}p)"
    )
    if plug_in.capacitor_uf:
        yield f"R3 {' '.join(_nets_of(parts['R3']))} {plug_in.inrush_ohm:g}"
        yield _ceramic(parts["C1"], plug_in)


def _ceramic(part: Component, plug_in: PlugIn) -> str:
    """A capacitor whose capacitance falls as 1 / (1 + (V / V0)²), by its charge.

    With the derating at the supply, V0 is the supply over the root of 1 / derating - 1.
    """
    positive, negative = _nets_of(part)
    if plug_in.left == 1:
        return f"C1 {positive} {negative} {plug_in.capacitor_uf:g}u"
    v0 = plug_in.left_at_v / math.sqrt(1 / plug_in.left - 1)
    charge = f"{plug_in.capacitor_uf * v0:.6g}u*atan(v({positive})/{v0:.6g})"
    return f"C1 {positive} {negative} q='{charge}'"


def _surge(board: AuxiliaryBoard, plug_in: PlugIn) -> Iterator[str]:
    """Highest voltages, peak and I²t of the current with the shortest and the longest cable; then
    voltage and current of the board at a reversed supply."""
    parts = {part.ref: part for part in board.components}
    supply = dict(zip(parts["Q1"].pins, _nets_of(parts["Q1"]), strict=True))["S"]
    behind = _nets_of(parts["C1"])[0] if plug_in.capacitor_uf else supply
    run = f"tran {_STEP_NS:g}n {_END_US:g}u 0 {_STEP_NS:g}n uic"
    yield ".options reltol=1e-4"
    yield ".control"
    for name, cable_uh in zip(("short", "long"), plug_in.cable_uh, strict=True):
        yield passage("boards/spice.txt", "cable").format(
            name=name, cable_uh=cable_uh, run=run, behind=behind, supply=supply, end_us=_END_US
        )
    yield passage("boards/spice.txt", "reversed").format(
        supply_v=-plug_in.supply_v, run=run, supply=supply, half_us=_END_US / 2, end_us=_END_US
    )


def _nets_of(part: Component) -> tuple[str, ...]:
    """Net of each pad; ngspice calls ground 0."""
    return tuple("0" if net == "GND" else net for _, net in part.nets)
