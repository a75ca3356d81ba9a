"""Netlist for ngspice: electrostatic discharges into the wires of an analog and a select line.

```
generator ──┬── R ──┬── pin, its diodes at the supply and at ground
            L       C
            Z
```
"""

import math
from collections.abc import Iterator

from lumitip_fab.boards.model import GROUND
from lumitip_fab.boards.spice import netlist
from lumitip_fab.design import AuxiliaryBoard, Design
from lumitip_fab.design.protection import Protection
from lumitip_fab.pipeline.artefact import Artefact

_END_NS, _STEP_PS = 200.0, 20.0
_PULSES = (16.6, 1.1, 2.0), (9.3, 12.0, 37.0)
"""Peak (A), rise and fall (ns) of both pulses of the generator at 4 kV, by IEC 61000-4-2."""
_POWER, _FOR_KV = 1.8, 4.0
_PIN = "d(is=1e-14 n=1 rs=0.5)"
"""Diodes of a pin: with so little resistance nearly all of the current is theirs."""
_JUNCTION_A = 1e-12  # saturation current of the ESD diode, forward


def discharge_simulation(design: Design, board: AuxiliaryBoard) -> tuple[Artefact, ...]:
    """The netlist of the protection on a board."""
    protection = design.electrical.protection
    assert protection is not None
    title = design.title.on_boards()
    signals = design.wiring.adc_pins[0], protection.lines[0]
    words = (
        f"{title.name} {title.revision}, {board.name}: {protection.discharge_kv:g} kV into the "
        f"wires {' and '.join(signals)}"
    )
    lines = (
        f"Vsupply supply 0 {design.electrical.channel.supply_v:g}",
        "Vsign sign 0 1",
        *(line for net in signals for line in _wire(board, protection, net)),
        f".model pin {_PIN}",
        f".model esd d(bv={protection.breakdown_v:g} ibv=1m is={_JUNCTION_A:g} "
        f"rs={protection.dynamic_ohm:g} cjo={protection.diode_pf:g}p)",
        *_measured(signals),
    )
    return (netlist(board.name, "_discharge", words, lines),)


def _wire(board: AuxiliaryBoard, protection: Protection, net: str) -> Iterator[str]:
    """A generator at a wire, and what is between the wire and its pin; the way over the diode is
    as long as it may be."""
    parts = board.components
    diode = next(p for p in parts if p.kind == "esd diode" and p.nets[0][1] == net)
    series = next(p for p in parts if p.kind == "resistor" and p.nets[0][1] == net)
    pin = series.nets[1][1]
    yield f"B{net} 0 {net} i=v(sign)*({_current(protection.discharge_kv)})"
    yield f"L{net} {net} {net}_clamp {protection.nh_per_mm * protection.reach_mm:g}n"
    yield f"D{diode.ref} 0 {net}_clamp esd"
    ohm = protection.series_ohm * (1 - protection.resistor_tolerance)
    yield f"{series.ref} {net} {pin} {ohm:g}"
    for part in parts:
        if part.kind == "capacitor" and {n for _, n in part.nets} == {pin, GROUND}:
            yield f"{part.ref} {pin} 0 {protection.capacitor_pf:g}p"
    yield f"V{net} {pin} {net}_diodes 0"
    yield f"Dup{net} {net}_diodes supply pin"
    yield f"Ddown{net} 0 {net}_diodes pin"


def _current(kilovolt: float) -> str:
    """Current of the generator over time."""
    pulses = []
    for peak_a, rise, fall in _PULSES:
        scale = math.exp(-(rise / fall) * (_POWER * fall / rise) ** (1 / _POWER))
        grown = f"pow(time/{rise:g}n,{_POWER:g})"
        amperes = peak_a * kilovolt / _FOR_KV / scale
        pulses.append(f"{amperes:.6g}*{grown}/(1+{grown})*exp(-time/{fall:g}n)")
    return "+".join(pulses)


def _measured(signals: tuple[str, ...]) -> Iterator[str]:
    """Largest current into each pin and largest voltage at each wire, for both signs."""
    yield ".options reltol=1e-4"
    yield ".control"
    for sign, which in ((1, "max"), (-1, "min")):
        name = "high" if sign > 0 else "low"
        yield f"alter Vsign = {sign}"
        yield f"tran {_STEP_PS:g}p {_END_NS:g}n 0 {_STEP_PS:g}p"
        for net in signals:
            yield f"meas tran pin_a_{name}_{net} {which} i(V{net})"
            yield f"meas tran wire_v_{name}_{net} {which} v({net})"
            yield f"print pin_a_{name}_{net} wire_v_{name}_{net}"
    yield ".endc"
