"""The first string of LEDs for ngspice, with its resistor or its current source."""

import itertools
from collections.abc import Iterator

from lumitip_fab.boards.circuit import cathodes_of, supply_of
from lumitip_fab.boards.model import GROUND
from lumitip_fab.design import Component, CurrentSource, Design
from lumitip_fab.design.electrical import Regulation, Strings

_THERMAL_V = 0.0258520  # of ngspice at 26.85 °C
_BAND_GAP_EV = 1.42  # gallium arsenide: how the forward voltage falls with temperature
_FOLLOWS_S = 100.0  # OUT follows SET within a fraction of a millivolt
_KNEE_V = 0.05  # of the dropout, which is reached well below the data sheet's voltage
_BELOW_V = 0.2


def string(parts: tuple[Component, ...], design: Design) -> Iterator[str]:
    """The string at its supply; `i_ma` is its current. With a current source also at the ends of
    supply and temperature: `i_0_0` with the lowest of both, `i_1_0` with the highest supply."""
    wiring, strings = design.wiring, design.electrical.strings
    yield f"Vsupply {supply_of(design.emitter)} 0 {wiring.supply_v:g}"
    yield from _source(parts, design) if wiring.set_ohm else _resistor(parts, design)
    yield from _leds(parts, design)
    yield from _model(strings)
    yield from (".control", "op", "let i_ma = -1000*i(vsupply)", "print i_ma")
    if strings.regulation:
        yield from _ends(strings.regulation, wiring.supply_v)
    yield ".endc"


def _net_of(parts: tuple[Component, ...], ref: str, pin: str) -> str:
    part = next(part for part in parts if part.ref == ref)
    lead = str(part.pins.index(pin) + 1)
    return dict(part.nets)[lead]


def _resistor(parts: tuple[Component, ...], design: Design) -> Iterator[str]:
    ends = next(tuple(net for _, net in part.nets) for part in parts if part.ref == "R1")
    yield f"R1 {' '.join(ends)} {design.wiring.resistor_ohm[0]:g}"


def _source(parts: tuple[Component, ...], design: Design) -> Iterator[str]:
    """U1 with the resistors at its OUT and its SET, whose temperature coefficients are opposite."""
    nets = {pin: _net_of(parts, "U1", pin) for pin in ("IN", "OUT", "SET")}
    held = design.electrical.strings.regulation
    per_k = held.resistor_per_k if held else 0.0
    yield f"X1 {nets['IN']} {nets['OUT']} {nets['SET']} source"
    for pin, ohm, sign in (
        ("OUT", design.wiring.resistor_ohm[0], -1),
        ("SET", design.wiring.set_ohm[0], 1),
    ):
        joined = (part for part in parts if part.kind == "resistor")
        part = next(p for p in joined if nets[pin] in (net for _, net in p.nets))
        ends = " ".join(net for _, net in part.nets)
        yield f"{part.ref} {ends} {ohm:g} tc1={sign * per_k:g}"
    yield from _subcircuit(design.packages.source, design.electrical.strings)


def _subcircuit(entry: CurrentSource, strings: Strings) -> Iterator[str]:
    """The source by the figures of its data sheet: reference current, line regulation, drift with
    temperature, and dropout."""
    held = strings.regulation
    hottest = held.temperatures_c[1] if held else 60.0
    drift = entry.set_drift / (hottest - 25)
    reference = f"{entry.set_ua:g}u*(1+{entry.line_per_v:g}*v(in,out))"
    opened = f"0.5*(1+tanh((v(in,out)-{entry.dropout_v - _BELOW_V:g})/{_KNEE_V:g}))"
    yield ".subckt source in out set"
    yield f"Bset in set i={reference}*(1+{drift:.6g}*(temper-25))"
    yield f"Bout in out i=max({_FOLLOWS_S:g}*v(set,out),0)*{opened}"
    yield ".ends"


def _leds(parts: tuple[Component, ...], design: Design) -> Iterator[str]:
    """The LEDs in the order in which the current passes them."""
    anode, cathode = ("1", "2") if design.packages.led.marked == "anode" else ("2", "1")
    leds = {dict(part.nets)[anode]: part for part in parts if part.kind == "led"}
    net, end = "S1_0", cathodes_of(design)
    while net != end:
        led = leds[net]
        left, net = net, dict(led.nets)[cathode]
        yield f"{led.ref} {left} {'0' if net == GROUND else net} led"
    if design.packages.switch is not None:
        yield f"RQ1 {end} 0 {design.packages.switch.on_ohm:g}"  # Q1 while the LEDs are on


def _model(strings: Strings) -> Iterator[str]:
    """Saturation current with which the forward voltage at the target current is as stated."""
    exponent = strings.forward_v / (strings.ideality * _THERMAL_V)
    amperes = f"{strings.target_ma / 1000:g}/(exp({exponent:.9g})-1)"
    yield f".model led d(n={strings.ideality:g} is={{{amperes}}} eg={_BAND_GAP_EV:g})"


def _ends(held: Regulation, volts: float) -> Iterator[str]:
    """The current at each end of supply and temperature."""
    for (low, sign), (warm, celsius) in itertools.product(
        enumerate((-1, 1)), enumerate(held.temperatures_c)
    ):
        yield f"alter Vsupply = {volts * (1 + sign * held.supply_range):g}"
        yield f"option temp={celsius:g}"
        yield from ("op", f"let i_{low}_{warm} = -1000*i(vsupply)", f"print i_{low}_{warm}")
