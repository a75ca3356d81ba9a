"""Netlist for ngspice: the flange as it is plugged into a live supply, and into a reversed one."""

import math
from collections.abc import Iterator

from lumitip_fab.design import AuxiliaryBoard, Component, Design, Flange
from lumitip_fab.design.electrical import PlugIn
from lumitip_fab.pipeline.artefact import Artefact
from lumitip_fab.text import coded_ohm

_END_US, _STEP_NS = 200.0, 10.0
_TVS_PF = 1500.0  # of a 600 W TVS diode of 24 V without voltage, from makers' curves
_FUSE_OHM = 0.001  # its cold resistance would damp: it is left out
_CABLE_OHM = 0.02
_PMOS = "pchan vto=-2 kp=0.4 rd=0.1 rs=0.1 cgs=0.19n cgdmax=0.15n cgdmin=0.02n cjo=0.1n is=1n n=1.2"
"""A MOSFET of 60 V and 0.35 ohm in SOT-23; capacitances by its data sheet at 30 V (C_iss 210 pF,
C_rss 20 pF), without voltage assumed."""


def plug_in_simulation(design: Design, flange: Flange) -> tuple[Artefact, ...]:
    """The netlist of a flange's input."""
    (plug_in,) = design.electrical.plug_ins
    board = next(b for b in design.auxiliary_boards if b.name == flange.auxiliary)
    title = design.title.on_boards()
    lines = (
        f"* {title.name} {title.revision}, {board.name}: plugged into a live supply",
        *_circuit(board, plug_in),
        *_measured(board, plug_in),
        ".end",
    )
    path = f"boards/{board.name}/{board.name}_plug_in.cir"
    return (Artefact(path, ("\n".join(lines) + "\n").encode(), frame=""),)


def _circuit(board: AuxiliaryBoard, plug_in: PlugIn) -> Iterator[str]:
    parts = {part.ref: part for part in board.components}
    contact, fused = _nets(parts["F1"])
    mosfet = dict(zip(parts["Q1"].pins, _nets(parts["Q1"]), strict=True))
    supply = mosfet["S"]
    yield f"Vlive live 0 dc 0 pwl(0 0 1n {plug_in.supply_v:g})"
    yield f"Lcable live cable {plug_in.cable_uh[0]:g}u"
    yield f"Rcable cable {contact} {_CABLE_OHM:g}"
    yield f"Rfuse {contact} {fused} {_FUSE_OHM:g}"
    yield f"MQ1 {mosfet['D']} {mosfet['G']} {supply} pmos"
    yield f".model pmos vdmos({_PMOS})"
    for ref in ("R1", "R2"):
        if ref in parts:
            yield f"{ref} {' '.join(_nets(parts[ref]))} {coded_ohm(parts[ref].value):g}"
    cathode, anode = _nets(parts["D1"])
    low, high = plug_in.breakdown_v
    yield f"D1 {anode} {cathode} tvs"
    yield (
        f".model tvs d(bv={(low + high) / 2:g} ibv=1m rs={plug_in.tvs_ohm:.3g} cjo={_TVS_PF:g}p)"
    )
    if plug_in.capacitor_uf:
        yield f"R3 {' '.join(_nets(parts['R3']))} {plug_in.inrush_ohm:g}"
        yield _ceramic(parts["C1"], plug_in)


def _ceramic(part: Component, plug_in: PlugIn) -> str:
    """A capacitor whose capacitance falls as 1 / (1 + (V / V0)²), by its charge.

    With the derating at the supply, V0 is the supply over the root of 1 / derating - 1.
    """
    positive, negative = _nets(part)
    if plug_in.left == 1:
        return f"C1 {positive} {negative} {plug_in.capacitor_uf:g}u"
    v0 = plug_in.left_at_v / math.sqrt(1 / plug_in.left - 1)
    charge = f"{plug_in.capacitor_uf * v0:.6g}u*atan(v({positive})/{v0:.6g})"
    return f"C1 {positive} {negative} q='{charge}'"


def _measured(board: AuxiliaryBoard, plug_in: PlugIn) -> Iterator[str]:
    """Highest voltages, peak and I²t of the current with the shortest and the longest cable; then
    voltage and current of the board at a reversed supply."""
    parts = {part.ref: part for part in board.components}
    supply = dict(zip(parts["Q1"].pins, _nets(parts["Q1"]), strict=True))["S"]
    behind = _nets(parts["C1"])[0] if plug_in.capacitor_uf else supply
    run = f"tran {_STEP_NS:g}n {_END_US:g}u 0 {_STEP_NS:g}n uic"
    yield ".options reltol=1e-4"
    yield ".control"
    for name, cable_uh in zip(("short", "long"), plug_in.cable_uh, strict=True):
        yield from (
            f"alter Lcable = {cable_uh:g}u",
            run,
            f"meas tran input_v_{name} max v({behind})",
            f"meas tran supply_v_{name} max v({supply})",
            f"meas tran peak_a_{name} max i(Lcable)",
            "let square = i(Lcable)*i(Lcable)",
            f"meas tran surge_{name} integ square from=0 to={_END_US:g}u",
            f"let surge_ua2s_{name} = 1e6*surge_{name}",
            f"print input_v_{name} supply_v_{name} peak_a_{name} surge_ua2s_{name}",
        )
    yield from (
        f"alter @Vlive[pwl] = [ 0 0 1n {-plug_in.supply_v:g} ]",
        run,
        f"meas tran reversed_v min v({supply})",
        f"meas tran left_a avg i(Lcable) from={_END_US / 2:g}u to={_END_US:g}u",
        "let reversed_ma = 1000*left_a",
        "print reversed_v reversed_ma",
        ".endc",
    )


def _nets(part: Component) -> tuple[str, ...]:
    """Net of each pad; ngspice calls ground 0."""
    return tuple("0" if net == "GND" else net for _, net in part.nets)
