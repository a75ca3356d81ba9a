"""A channel for ngspice: multiplexer, pull-ups and two detectors, ideal and as phototransistors."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from lumitip_fab.boards.model import GROUND
from lumitip_fab.design import Component, Design

_KNEE_V = 0.001  # over which an ideal detector takes up its current
_BEFORE_US, _CONSTANTS = 200, 25  # time before the change of channel; time constants after it


@dataclass(frozen=True)
class MuxNets:
    """Nets of a multiplexer."""

    supply: str
    output: str
    """To the controller's input, and a shared pull-up."""
    first: str
    """Of the detector at the first used input."""
    last: str
    """Of the detector at the last used input."""


def first_mux(parts: tuple[Component, ...], design: Design) -> MuxNets:
    """The nets of a receiver's first multiplexer."""
    mux = design.packages.multiplexer
    leads = next(dict(part.nets) for part in parts if part.ref == "U1")
    inputs = [n for n in (leads[str(lead)] for lead in mux.input_leads) if n != GROUND]
    return MuxNets(leads[str(mux.supply)], leads[str(mux.output)], inputs[0], inputs[-1])


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
        f"meas tran full_v find v({nets.output}) at={_BEFORE_US - 1}u",
        f"meas tran dark_v find v({nets.output}) at={end_us - 1:g}u",
        f"let target = dark_v - {figures.step_v / 2:g}",
        f"meas tran t_end when v({nets.output})=target rise=last",
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
SCAN_US = 5000  # 200 scans a second
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
    changed_us = _REST_US + SCAN_US
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
    read = f"find v({nets.output}) at="
    yield from (
        ".options abstol=1e-15 chgtol=1e-17 gmin=1e-14",
        ".control",
        f"tran {_STEP_US:g}u {last_us}u {changed_us - SCAN_US}u {_STEP_US:g}u",
        f"meas tran end_v {read}{last_us - 1}u",
        *(f"meas tran v_{us} {read}{changed_us + us}u" for us in times),
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
    yield f"Cline {nets.output} 0 {figures.line_pf:g}p"


def _changed(nets: MuxNets, design: Design, at_us: float) -> Iterator[str]:
    """The multiplexer, which changes from its first to its last input."""
    for net, on in ((nets.first, "1 0"), (nets.last, "0 1")):
        yield f"S{net} {net} {nets.output} on{net} 0 channel"
        yield f"V{net} on{net} 0 pulse({on} {at_us:g}u 1n 1n 1)"
    ohm = design.electrical.channel.on_resistance_ohm
    yield f".model channel sw(ron={ohm:g} roff=1e12 vt=0.5)"
