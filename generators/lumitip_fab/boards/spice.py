"""Netlists for ngspice, taken from the nets of a board: one string, or one detector's channel.

`ngspice -b FILE` prints what is measured: run it to see what a change of parts does.
"""

from collections.abc import Iterator

from lumitip_fab.artefact import Artefact
from lumitip_fab.boards.circuit import GROUND, circuit
from lumitip_fab.boards.model import Component
from lumitip_fab.design import Electrical, Finger, Packages, Reading, Rules, Title, Wiring

_TEMPERATURE_C = 26.85  # 300 K, as in the closed forms
_THERMAL_V = 0.0258520  # of ngspice at that temperature
_KNEE_V = 0.001  # over which a detector takes up its current
_BEFORE_US, _CONSTANTS = 200, 25  # time before the change of channel; time constants after it
Parts = tuple[Component, ...]


def simulation(
    title: Title,
    reading: Reading,
    finger: Finger,
    wiring: Wiring,
    packages: Packages,
    rules: Rules,
    electrical: Electrical,
) -> tuple[Artefact, ...]:
    """The netlist of a board: its first string, or its first multiplexer with two detectors.

    Args:
        title: of the design.
        reading: which input reads each cell.
        finger: whose board it is.
        wiring: for the resistors' values.
        packages: for the multiplexer's leads and the LED's terminals.
        rules: of the circuit's copper.
        electrical: what LEDs, detectors and line are.
    """
    parts = circuit(reading, finger, wiring, packages, rules).components
    body = _string if finger.name == "emitter" else _channel
    lines = (
        f"* {title.on_boards().name}, {finger.name}, design {reading.design_hash[:8]}",
        *body(parts, wiring, packages, electrical),
        f".options temp={_TEMPERATURE_C} tnom={_TEMPERATURE_C} reltol=1e-5 vntol=1e-7",
        ".end",
    )
    text = "\n".join(lines) + "\n"
    return (Artefact(f"boards/{finger.name}/{finger.name}.cir", text.encode(), frame=""),)


def _string(
    parts: Parts, wiring: Wiring, packages: Packages, electrical: Electrical
) -> Iterator[str]:
    """The first string at its supply; `i_ma` is its current."""
    told = electrical.strings
    anode, cathode = ("1", "2") if packages.led.marked == "anode" else ("2", "1")
    leds = {dict(p.nets)[anode]: p for p in parts if p.kind == "led"}
    supply, net = (net for part in parts if part.ref == "R1" for _, net in part.nets)
    yield f"Vsupply {supply} 0 {wiring.supply_v:g}"
    yield f"R1 {supply} {net} {wiring.resistor_ohm[0]:g}"
    while net != GROUND:
        led = leds[net]
        left, net = net, dict(led.nets)[cathode]
        yield f"{led.ref} {left} {'0' if net == GROUND else net} led"
    # Saturation current with which the forward voltage at the target current is the given one.
    exponent = told.forward_v / (told.ideality * _THERMAL_V)
    amperes = f"{told.target_ma / 1000:g}/(exp({exponent:.9g})-1)"
    yield f".model led d(n={told.ideality:g} is={{{amperes}}})"
    yield from (".control", "op", "let i_ma = -1000*i(vsupply)", "print i_ma", ".endc")


def _channel(
    parts: Parts, wiring: Wiring, packages: Packages, electrical: Electrical
) -> Iterator[str]:
    """The first multiplexer as it changes from a detector in full light to one in the dark.

    `full_v` and `dark_v` are what the controller reads before and long after the change,
    `settle_us` the time until it is within half a step of the latter.
    """
    told, mux = electrical.channel, packages.multiplexer
    leads = next(dict(part.nets) for part in parts if part.ref == "U1")
    supply, line = leads[str(mux.supply)], leads[str(mux.output)]
    detectors = [n for n in (leads[str(lead)] for lead in mux.inputs) if n != GROUND]
    lit, dark = detectors[0], detectors[-1]
    seconds = wiring.pull_up_ohm * (told.line_pf + told.detector_pf) * 1e-12
    after_us = _CONSTANTS * seconds * 1e6
    end_us = _BEFORE_US + after_us
    yield f"Vsupply {supply} 0 {told.supply_v:g}"
    yield f"R1 {supply} {line} {wiring.pull_up_ohm:g}"
    yield f"Cline {line} 0 {told.line_pf:g}p"
    for net, amperes, knee_at, on in (
        (lit, told.light_current_ua * 1e-6, told.saturation_v, "1 0"),
        (dark, told.dark_current_na * 1e-9, 0.0, "0 1"),
    ):
        yield f"C{net} {net} 0 {told.detector_pf:g}p"
        share = f"min(max((v({net})-{knee_at:g})/{_KNEE_V:g},0),1)"
        yield f"B{net} {net} 0 i={amperes:g}*{share}"
        yield f"S{net} {net} {line} on{net} 0 channel"
        yield f"V{net} on{net} 0 pulse({on} {_BEFORE_US}u 1n 1n 1)"
    yield f".model channel sw(ron={told.on_resistance_ohm:g} roff=1e12 vt=0.5)"
    yield from (
        ".control",
        f"tran {after_us / 1000:g}u {end_us:g}u 0 {after_us / 1000:g}u",
        f"meas tran full_v find v({line}) at={_BEFORE_US - 1}u",
        f"meas tran dark_v find v({line}) at={end_us - 1:g}u",
        f"let target = dark_v - {told.step_v / 2:g}",
        f"meas tran t_end when v({line})=target rise=last",
        f"let settle_us = t_end*1e6 - {_BEFORE_US}",
        "print full_v dark_v settle_us",
        ".endc",
    )
