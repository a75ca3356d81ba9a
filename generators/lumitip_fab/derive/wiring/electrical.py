"""Currents, voltages and times of the circuit, in closed form."""

import math

from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.bulk import derive_bulk
from lumitip_fab.derive.boards.flange_circuit import derive_regulated
from lumitip_fab.derive.boards.indicator import derive_indicators
from lumitip_fab.derive.boards.plug_in import derive_plug_in
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring.ambient import derive_ambient, scan_us
from lumitip_fab.derive.wiring.protection import derive_protection
from lumitip_fab.derive.wiring.ratings import RESISTOR_TOLERANCE, SUPPLY_TOLERANCE
from lumitip_fab.derive.wiring.section import REACH_MM
from lumitip_fab.derive.wiring.sources import COLDEST_C, FORWARD_V_PER_K, HOTTEST_C, regulation
from lumitip_fab.derive.wiring.strings import Strings as DerivedStrings
from lumitip_fab.derive.wiring.strings import string_of
from lumitip_fab.derive.wiring.wiring import Muxing
from lumitip_fab.design.electrical import Channel, Electrical, Strings
from lumitip_fab.design.protection import Protection

SHORTER = 0.75  # of a string's LEDs, to compare


def derive_electrical(
    config: Input, strings: DerivedStrings, muxing: Muxing, pull_ups: int, faults: Diagnostics
) -> Electrical:
    """Electrical figures from parts, strings and supply."""
    p, protection = config.parameters, derive_protection(config, muxing, faults)
    channel = _channel(config, protection)
    _refuse_slow(config, channel, protection, faults)
    return Electrical(
        strings=_strings(config, strings),
        channel=channel,
        heat_w=sum(strings.current_ma) * p.supply.voltage_v / 1000,
        supplies=derive_regulated(config, faults),
        plug_ins=derive_plug_in(config, faults),
        indicators=derive_indicators(config, muxing, faults),
        bulk=derive_bulk(config, pull_ups),
        protection=protection,
        ambient=derive_ambient(config, channel, faults),
    )


def _strings(config: Input, strings: DerivedStrings) -> Strings:
    p = config.parameters
    led = config.parts.emitter.led
    fewer = max(1, math.floor(SHORTER * max(len(cells) for cells in strings.cells)))
    shorter = string_of(config, fewer, p.emitter.current_ma)
    return Strings(
        forward_v=led.forward_voltage_v,
        forward_tolerance_v=led.forward_tolerance_v,
        ideality=led.ideality,
        target_ma=p.emitter.current_ma,
        supply_tolerance=SUPPLY_TOLERANCE,
        resistor_tolerance=RESISTOR_TOLERANCE,
        temperatures_c=(COLDEST_C, HOTTEST_C),
        forward_v_per_k=FORWARD_V_PER_K,
        low_ma=tuple(string.low_ma for string in strings.strings),
        high_ma=tuple(string.high_ma for string in strings.strings),
        fewer_leds=fewer,
        fewer_low_ma=shorter.low_ma,
        fewer_high_ma=shorter.high_ma,
        resistor_w=max(string.load_w for string in strings.strings),
        resistor_high_w=max(string.high_load_w for string in strings.strings),
        resistor_rated_w=config.parts.emitter.resistor.power_w,
        regulation=regulation(config, strings.strings) if strings.set_ohm else None,
    )


SCANS_PER_S = 200
COUNTS, SETTLED_COUNTS = 255, 0.5
WAIT_SHARE = 0.88
"""Of the bound in `_wait_us`: the slowest reading, of a phototransistor just before it saturates,
needs 0.85 of it over the spread of gain and capacitance."""


def _channel(config: Input, protection: Protection | None) -> Channel:
    """A detector under light pulls down what its pull-up pulls up.

    supply ── pull-up ──┬── line (C) ── ADC          shared
                        └── on-resistance ── detector ── ground

    supply ── pull-up ──┬── detector ── ground       its own
                        └── on-resistance ── line (C) ── ADC

    A resistor before the ADC is small beside the pull-up: its time constant adds to the wait.
    """
    p, parts = config.parameters, config.catalogue
    detector = parts.photodetectors[p.receiver.photodetector]
    mux = parts.multiplexers[p.receiver.multiplexer]
    controller = parts.controllers[p.controller.board]
    supply, pull_up = controller.supply_v, p.receiver.pull_up_ohm
    dark_v = supply - pull_up * detector.dark_current_na * 1e-9
    # Under full light the detector either saturates or takes what the light lets it take.
    own = p.receiver.load == "each"
    saturated = (supply - detector.saturation_v) / (
        pull_up + (0.0 if own else mux.on_resistance_ohm)
    )
    full_v = supply - pull_up * min(saturated, detector.light_current_ua * 1e-6)
    wire_pf, series_us = WIRE_PF_PER_M * _wire_mm(config) / 1000, 0.0
    line_pf = mux.common_pf + wire_pf + controller.input_pf
    if protection:
        line_pf += protection.diode_pf + protection.capacitor_pf
        pin_pf = protection.pin_pf + protection.capacitor_pf
        series_us = protection.series_ohm * pin_pf * 1e-6 * math.log(COUNTS / SETTLED_COUNTS)
    seconds = (pull_up * (line_pf + detector.capacitance_pf)) * 1e-12
    if own:
        seconds += mux.on_resistance_ohm * line_pf * 1e-12
    if protection:  # the pin's share of all capacitance is charged late
        seconds += protection.series_ohm * pin_pf**2 / (line_pf + detector.capacitance_pf) * 1e-12
    step_v = supply / 2**controller.adc_bits
    change_v = dark_v - full_v
    if own:  # the line shares its charge with the dark collector before both are pulled up
        change_v *= line_pf / (line_pf + detector.capacitance_pf)
    return Channel(
        supply_v=supply,
        light_current_ua=detector.light_current_ua,
        dark_current_na=detector.dark_current_na,
        saturation_v=detector.saturation_v,
        on_resistance_ohm=mux.on_resistance_ohm,
        detector_pf=detector.capacitance_pf,
        line_pf=line_pf,
        wire_pf=wire_pf,
        step_v=step_v,
        full_scale_v=full_v,
        dark_v=dark_v,
        settle_us=1e6 * seconds * math.log(max(change_v / (step_v / 2), 1.0)),
        wait_us=_wait_us(pull_up, line_pf) + series_us if own else None,
        most_scan_us=1e6 / SCANS_PER_S,
        gain=detector.gain,
        base_pf=detector.base_pf,
    )


WIRE_PF_PER_M = 100.0
"""Of a wire between grounded ones: 96 pF/m in 3M's cable 3560 (TS-0672-B, PVC, AWG 26)."""
LEAST_WIRE_MM = 300.0  # that a channel is made for: users cut their wires longer


def _wire_mm(config: Input) -> float:
    """Length of a signal's wire, or more: the boards that it ends on are not known yet."""
    p = config.parameters.wiring
    travel_mm = config.parts.coupling.gripper.stroke_mm / 2
    return max(LEAST_WIRE_MM, p.controller_mm + p.slack_mm + travel_mm + REACH_MM)


def _refuse_slow(
    config: Input, channel: Channel, protection: Protection | None, faults: Diagnostics
) -> None:
    """Refuse a capacitor at the analog pins with which a scan takes too long."""
    if protection is None or channel.wait_us is None or not protection.capacitor_pf:
        return
    takes_us = scan_us(config, channel.wait_us)
    faults.unless(
        takes_us <= channel.most_scan_us,
        "scan_slow",
        takes_ms=takes_us / 1000,
        most_ms=channel.most_scan_us / 1000,
        rate=SCANS_PER_S,
    )


def _wait_us(pull_up_ohm: float, line_pf: float) -> float:
    """Wait for a phototransistor whose collector is always pulled up.

    The line brings the charge of the channel before it, which is at most C * supply. The base of a
    detector of gain B and capacitance C_b takes it up as a capacitor of B C_b would, and gives it
    back through the pull-up: the error is at most C / (C + B C_b) * exp(-t / (R (C + B C_b))) of
    the supply. The worst B C_b has the time constant t, and with it the error is R C / (e t).
    """
    bound_us = COUNTS / SETTLED_COUNTS * pull_up_ohm * line_pf * 1e-6 / math.e
    return WAIT_SHARE * bound_us
