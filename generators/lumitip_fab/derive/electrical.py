"""Currents, voltages and times of the circuit, in closed form."""

import math

from lumitip_fab.catalogue import Led
from lumitip_fab.derive import wiring
from lumitip_fab.derive.faults import Faults
from lumitip_fab.derive.regulated import derive_regulated
from lumitip_fab.design.electrical import Channel, Electrical, Strings
from lumitip_fab.load import Input

THERMAL_V = 0.02585  # kT/q at 300 K
SUPPLY_TOLERANCE = 0.05
SHORTER = 0.75  # of a string's LEDs, to compare


def derive_electrical(given: Input, strings: wiring.Strings, faults: Faults) -> Electrical:
    """What follows from parts, strings and supply."""
    p = given.parameters
    return Electrical(
        strings=_strings(given, strings),
        channel=_channel(given),
        heat_w=sum(strings.current_ma) * p.supply.voltage_v / 1000,
        supplies=derive_regulated(given, faults),
    )


def string_current_ma(
    supply_v: float, leds: int, ohm: float, forward_v: float, at_ma: float, ideality: float
) -> float:
    """Current of LEDs and a resistor in series, by Shockley's equation, found by bisection.

    Args:
        supply_v: over all of them.
        leds: how many there are.
        ohm: the resistor.
        forward_v: of an LED at `at_ma`.
        at_ma: current at which the forward voltage is given.
        ideality: of the LEDs.
    """
    low, high = 0.0, 1000 * supply_v / ohm
    while high - low > 1e-9:
        middle = (low + high) / 2
        drop = forward_v + ideality * THERMAL_V * math.log(max(middle / at_ma, 1e-12))
        if leds * drop + middle * ohm / 1000 < supply_v:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def _strings(given: Input, strings: wiring.Strings) -> Strings:
    p = given.parameters
    led = given.catalogue.leds[p.emitter.led]
    ends = [
        _ends_ma(given, led, len(cells), ohm)
        for cells, ohm in zip(strings.cells, strings.resistor_ohm, strict=True)
    ]
    fewer = max(1, math.floor(SHORTER * max(len(cells) for cells in strings.cells)))
    drop = p.supply.voltage_v - fewer * led.forward_voltage_v
    shorter = _ends_ma(given, led, fewer, wiring.e96(1000 * drop / p.emitter.current_ma))
    loads = [
        (i * i * r * 1e-6, high * high * r * 1e-6)
        for i, (_, high), r in zip(strings.current_ma, ends, strings.resistor_ohm, strict=True)
    ]
    return Strings(
        forward_v=led.forward_voltage_v,
        forward_tolerance_v=led.forward_tolerance_v,
        ideality=led.ideality,
        target_ma=p.emitter.current_ma,
        supply_tolerance=SUPPLY_TOLERANCE,
        low_ma=tuple(low for low, _ in ends),
        high_ma=tuple(high for _, high in ends),
        fewer_leds=fewer,
        fewer_low_ma=shorter[0],
        fewer_high_ma=shorter[1],
        resistor_w=max(nominal for nominal, _ in loads),
        resistor_high_w=max(high for _, high in loads),
    )


def _ends_ma(given: Input, led: Led, leds: int, ohm: float) -> tuple[float, float]:
    """Lowest and highest current of a string over supply and forward voltage."""
    p = given.parameters
    low, high = (
        string_current_ma(
            p.supply.voltage_v * (1 + sign * SUPPLY_TOLERANCE),
            leds,
            ohm,
            led.forward_voltage_v - sign * led.forward_tolerance_v,
            p.emitter.current_ma,
            led.ideality,
        )
        for sign in (-1, 1)
    )
    return low, high


def _channel(given: Input) -> Channel:
    """The line is pulled up, and a detector under light pulls it down.

    supply ── pull-up ──┬── line (C) ── ADC
                        └── on-resistance ── detector ── ground
    """
    p, parts = given.parameters, given.catalogue
    detector = parts.photodetectors[p.receiver.photodetector]
    mux = parts.multiplexers[p.receiver.multiplexer]
    controller = parts.controllers[p.controller.board]
    supply, pull_up = controller.supply_v, p.receiver.pull_up_ohm
    dark_v = supply - pull_up * detector.dark_current_na * 1e-9
    # Under full light the detector either saturates or takes what the light lets it take.
    saturated = (supply - detector.saturation_v) / (pull_up + mux.on_resistance_ohm)
    full_v = supply - pull_up * min(saturated, detector.light_current_ua * 1e-6)
    line_pf = mux.common_pf + controller.input_pf
    seconds = (pull_up * (line_pf + detector.capacitance_pf)) * 1e-12
    step_v = supply / 2**controller.adc_bits
    return Channel(
        supply_v=supply,
        light_current_ua=detector.light_current_ua,
        dark_current_na=detector.dark_current_na,
        saturation_v=detector.saturation_v,
        on_resistance_ohm=mux.on_resistance_ohm,
        detector_pf=detector.capacitance_pf,
        line_pf=line_pf,
        step_v=step_v,
        full_scale_v=full_v,
        dark_v=dark_v,
        settle_us=1e6 * seconds * math.log(max((dark_v - full_v) / (step_v / 2), 1.0)),
    )
