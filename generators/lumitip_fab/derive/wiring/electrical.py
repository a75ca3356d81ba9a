"""Currents, voltages and times of the circuit, in closed form."""

import math

from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.bulk import derive_bulk
from lumitip_fab.derive.boards.flange_circuit import derive_regulated
from lumitip_fab.derive.boards.indicator import derive_indicators
from lumitip_fab.derive.boards.plug_in import derive_plug_in
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring.ambient import derive_ambient
from lumitip_fab.derive.wiring.protection import derive_protection
from lumitip_fab.derive.wiring.ratings import RESISTOR_TOLERANCE, SUPPLY_TOLERANCE, sold_to
from lumitip_fab.derive.wiring.settling import (
    MOST_SCAN_US,
    light_share,
    line_of,
    most_pull_up_ohm,
    refuse_slow,
    wait_us,
)
from lumitip_fab.derive.wiring.sources import COLDEST_C, FORWARD_V_PER_K, HOTTEST_C, regulation
from lumitip_fab.derive.wiring.strings import Strings as DerivedStrings
from lumitip_fab.derive.wiring.strings import string_of
from lumitip_fab.derive.wiring.wiring import Muxing
from lumitip_fab.design.electrical import Channel, Electrical, Strings

SHORTER = 0.75  # of a string's LEDs, to compare


def derive_electrical(
    config: Input, strings: DerivedStrings, muxing: Muxing, pull_ups: int, faults: Diagnostics
) -> Electrical:
    """Electrical figures from parts, strings and supply."""
    p, protection = config.parameters, derive_protection(config, muxing, faults)
    channel = _channel(config)
    refuse_slow(config, channel.wait_us, faults)
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


def _channel(config: Input) -> Channel:
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
    line = line_of(config)
    line_pf = line.total_pf
    seconds = (pull_up * (line_pf + detector.capacitance_pf)) * 1e-12
    if own:
        seconds += mux.on_resistance_ohm * line_pf * 1e-12
    seconds += 1e-6 * line.late_us
    step_v = supply / 2**controller.adc_bits
    change_v = dark_v - full_v
    if own:  # the line shares its charge with the dark collector before both are pulled up
        change_v *= line_pf / (line_pf + detector.capacitance_pf)
    share = light_share(config, p.emitter.current_ma, pull_up)
    return Channel(
        supply_v=supply,
        light_current_ua=detector.light_current_ua,
        light_share=share,
        whole_range_ohm=sold_to(pull_up / share),
        fast_ohm=sold_to(most_pull_up_ohm(config)),
        dark_current_na=detector.dark_current_na,
        saturation_v=detector.saturation_v,
        on_resistance_ohm=mux.on_resistance_ohm,
        detector_pf=detector.capacitance_pf,
        line_pf=line_pf,
        wire_pf=line.wire_pf,
        step_v=step_v,
        full_scale_v=full_v,
        dark_v=dark_v,
        settle_us=1e6 * seconds * math.log(max(change_v / (step_v / 2), 1.0)),
        wait_us=wait_us(config, line),
        most_scan_us=MOST_SCAN_US,
        gain=detector.gain,
        base_pf=detector.base_pf,
    )
