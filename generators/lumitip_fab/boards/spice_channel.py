"""For ngspice: a channel with multiplexer, pull-ups and two detectors, ideal and as
phototransistors; and a string of LEDs."""

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass

from lumitip_fab.boards.circuit import cathodes_of, supply_of
from lumitip_fab.boards.model import GROUND
from lumitip_fab.design import Component, CurrentSource, Design
from lumitip_fab.design.electrical import Regulation, Strings

_KNEE_V = 0.001  # over which an ideal detector takes up its current
_BEFORE_US, _CONSTANTS = 200, 25  # time before the change of channel; time constants after it


@dataclass(frozen=True)
class MuxNets:
    """Nets of a multiplexer."""

    supply: str
    output: str
    """To the wire of the controller's input, and a shared pull-up."""
    pin: str
    """Of the controller's input: the same without a resistor before it."""
    first: str
    """Of the detector at the first used input."""
    last: str
    """Of the detector at the last used input."""


def first_mux(parts: tuple[Component, ...], design: Design) -> MuxNets:
    """The nets of a receiver's first multiplexer."""
    mux = design.packages.multiplexer
    leads = next(dict(part.nets) for part in parts if part.ref == "U1")
    inputs = [n for n in (leads[str(lead)] for lead in mux.input_leads) if n != GROUND]
    output, apart = leads[str(mux.output)], design.electrical.protection is not None
    pin = f"{output}_PIN" if apart else output
    return MuxNets(leads[str(mux.supply)], output, pin, inputs[0], inputs[-1])


def channel(nets: MuxNets, design: Design) -> Iterator[str]:
    """The multiplexer as it changes from a detector in full light to one in the dark; both are
    current sinks.

    `full_v` and `dark_v` are what the controller reads before and long after the change,
    `settle_us` the time until it is within half a step of the latter.
    """
    wiring, figures = design.wiring, design.electrical.channel
    seconds = wiring.pull_up_ohm * (figures.line_pf + figures.detector_pf) * 1e-12
    after_us = _CONSTANTS * seconds * 1e6
    end_us = _BEFORE_US + after_us
    yield from _pulled_up(nets, design)
    for net, amperes, knee_at in (
        (nets.first, figures.light_current_ua * 1e-6, figures.saturation_v),
        (nets.last, figures.dark_current_na * 1e-9, 0.0),
    ):
        yield f"C{net} {net} 0 {figures.detector_pf:g}p"
        share = f"min(max((v({net})-{knee_at:g})/{_KNEE_V:g},0),1)"
        yield f"B{net} {net} 0 i={amperes:g}*{share}"
    yield from _changed(nets, design, _BEFORE_US)
    yield from (
        ".control",
        f"tran {after_us / 1000:g}u {end_us:g}u 0 {after_us / 1000:g}u",
        f"meas tran full_v find v({nets.pin}) at={_BEFORE_US - 1}u",
        f"meas tran dark_v find v({nets.pin}) at={end_us - 1:g}u",
        f"let target = dark_v - {figures.step_v / 2:g}",
        f"meas tran t_end when v({nets.pin})=target rise=last",
        f"let settle_us = t_end*1e6 - {_BEFORE_US}",
        "print full_v dark_v settle_us",
        ".endc",
    )


@dataclass(frozen=True)
class Step:
    """Light on two detectors, as shares of full light; 0 is dark current alone."""

    before: float
    """On the detector that is selected first."""
    earlier: float
    """On the detector that is selected next, until one scan before it is selected."""
    now: float
    """On the same detector after that."""


STEPS = {
    "to_dark": Step(1, 0, 0),
    "to_lit": Step(0, 1, 1),
    "dimmed": Step(0, 1, 0),
    "lit_up": Step(0, 0, 1),
}
MEASURED_US = (100, 200, 400, 800, 1600, 3200)
"""After the change of channel."""
_REST_US = 40_000  # before a step and after it: 50 times the slowest time constant assumed
_STEP_US = 2.0
COUNTS = 255


@dataclass(frozen=True)
class Corner:
    """A detector within the spread of its kind."""

    gain: float
    base_pf: float


def corners(design: Design) -> tuple[Corner, ...]:
    """All pairs of extremes, the fastest first and the slowest last."""
    figures = design.electrical.channel
    return tuple(Corner(gain, pf) for gain in figures.gain for pf in figures.base_pf)


def detectors(nets: MuxNets, design: Design, corner: Corner, step: Step) -> Iterator[str]:
    """The multiplexer as it changes to a detector whose light changed one scan before.

    Both detectors are phototransistors. Light drives a current from collector to base, and the
    transistor multiplies it by `gain`. `base_pf` is the capacitance from base to collector; base
    to emitter has the same. With a shared pull-up, the collector of a channel that is not selected
    floats.

    `end_v` is the settled reading. `wrong_100` is the error of the reading 100 us after the
    change, in counts of 255; the firmware's wait is among the times, if it follows from the design.
    """
    figures = design.electrical.channel
    changed_us = _REST_US + figures.most_scan_us
    waits = () if figures.wait_us is None else (math.ceil(figures.wait_us),)
    times = sorted({*MEASURED_US, *waits})
    last_us = changed_us + _REST_US
    yield from (
        "* Your detector: current gain hFE, capacitance from collector to base.",
        f".param gain={corner.gain:g} base={corner.base_pf:g}p",
        "* Its collector current in full light and in the dark.",
        f".param full={figures.light_current_ua:g}u dark={figures.dark_current_na:g}n",
        "* Light, 0 to 1: on the detector read first; on the one read next, until and after one",
        "* scan before it is read.",
        f".param before={step.before:g} earlier={step.earlier:g} now={step.now:g}",
        "* end_v is the settled reading; wrong_100 its error after 100 us, in counts of 255.",
    )
    yield from _pulled_up(nets, design)
    before, earlier, now = (
        f"{{(dark+full*{share})/(gain+1)}}" for share in ("before", "earlier", "now")
    )
    for net, light in (
        (nets.first, f"dc {before}"),
        (nets.last, f"pulse({earlier} {now} {_REST_US}u 1u 1u 1)"),
    ):
        yield f"C{net} {net} 0 {figures.detector_pf:g}p"
        yield f"Q{net} {net} b{net} 0 detector"
        yield f"I{net} {net} b{net} {light}"
    yield ".model detector npn(is=1e-14 bf={gain} br=2 cjc={base} mjc=0 cje={base} mje=0)"
    yield from _changed(nets, design, changed_us)
    read = f"find v({nets.pin}) at="
    yield from (
        ".options abstol=1e-15 chgtol=1e-17 gmin=1e-14",
        ".control",
        f"tran {_STEP_US:g}u {last_us:g}u {_REST_US}u {_STEP_US:g}u",
        f"meas tran end_v {read}{last_us - 1:g}u",
        *(f"meas tran v_{us} {read}{changed_us + us:g}u" for us in times),
        *(f"let wrong_{us} = {COUNTS}*(v_{us}-end_v)/{figures.supply_v:g}" for us in times),
        f"print end_v {' '.join(f'wrong_{us}' for us in times)}",
        ".endc",
    )


def _pulled_up(nets: MuxNets, design: Design) -> Iterator[str]:
    figures = design.electrical.channel
    yield f"Vsupply {nets.supply} 0 {figures.supply_v:g}"
    up = (nets.first, nets.last) if design.wiring.own_pull_ups else (nets.output,)
    for number, net in enumerate(up, start=1):
        yield f"R{number} {nets.supply} {net} {design.wiring.pull_up_ohm:g}"
    yield from _line(nets, design)


def _line(nets: MuxNets, design: Design) -> Iterator[str]:
    """The line to the controller's input: with a resistor before that, capacitance on both sides
    of it."""
    figures, protection = design.electrical.channel, design.electrical.protection
    if protection is None:
        yield f"Cline {nets.output} 0 {figures.line_pf:g}p"
        return
    pin_pf = protection.pin_pf + protection.capacitor_pf
    yield f"Cline {nets.output} 0 {figures.line_pf - pin_pf - protection.diode_pf:g}p"
    yield f"Cdiode {nets.output} 0 {protection.diode_pf:g}p"
    yield f"Rseries {nets.output} {nets.pin} {protection.series_ohm:g}"
    yield f"Cpin {nets.pin} 0 {pin_pf:g}p"


def _changed(nets: MuxNets, design: Design, at_us: float) -> Iterator[str]:
    """The multiplexer, which changes from its first to its last input."""
    for net, on in ((nets.first, "1 0"), (nets.last, "0 1")):
        yield f"S{net} {net} {nets.output} on{net} 0 channel"
        yield f"V{net} on{net} 0 pulse({on} {at_us:g}u 1n 1n 1)"
    ohm = design.electrical.channel.on_resistance_ohm
    yield f".model channel sw(ron={ohm:g} roff=1e12 vt=0.5)"


_THERMAL_V = 0.0258520  # of ngspice at 26.85 °C
_BAND_GAP_EV = 1.42  # gallium arsenide: how the forward voltage falls with temperature
_FOLLOWS_S = 100.0  # OUT follows SET within a fraction of a millivolt
_DROPOUT_KNEE_V = 0.05  # of the dropout, which is reached well below the data sheet's voltage
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
        yield from _ends(strings, strings.regulation, wiring.supply_v)
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
    drift = entry.set_drift / (strings.temperatures_c[1] - 25)
    reference = f"{entry.set_ua:g}u*(1+{entry.line_per_v:g}*v(in,out))"
    opened = f"0.5*(1+tanh((v(in,out)-{entry.dropout_v - _BELOW_V:g})/{_DROPOUT_KNEE_V:g}))"
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


def _ends(strings: Strings, held: Regulation, volts: float) -> Iterator[str]:
    """The current at each end of supply and temperature."""
    for (low, sign), (warm, celsius) in itertools.product(
        enumerate((-1, 1)), enumerate(strings.temperatures_c)
    ):
        yield f"alter Vsupply = {volts * (1 + sign * held.supply_range):g}"
        yield f"option temp={celsius:g}"
        yield from ("op", f"let i_{low}_{warm} = -1000*i(vsupply)", f"print i_{low}_{warm}")
