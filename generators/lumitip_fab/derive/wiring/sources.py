"""Strings of LEDs with resistors and with sources: parts, and how far the current may be off.

supply ── IN ┌────────┐ OUT ── R_out ──┬──►|── … ──►|── GND
             │ source │ SET ── R_set ──┘
             └────────┘

A reference current I flows out of SET, and OUT follows SET: I R_set is across R_out too, and the
LEDs get I (1 + R_set / R_out).
"""

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from lumitip_fab.catalogue.current_sources import CurrentSource
from lumitip_fab.catalogue.electronics import Led
from lumitip_fab.config.load import Input
from lumitip_fab.derive.wiring import ratings
from lumitip_fab.design.electrical import Regulation

THERMAL_V = 0.02585  # kT/q at 300 K
LEAST_RESISTOR_SHARE = 0.1
"""Share of the supply across a resistor: below it the current follows every millivolt."""


@dataclass(frozen=True)
class String:
    """One string: LEDs, its resistor or the two of its current source, and what flows."""

    leds: int
    ohm: float
    """Resistor that carries the current."""
    nominal_ma: float
    low_ma: float
    """At the worst case of all tolerances; likewise the highest."""
    high_ma: float
    set_ohm: float | None = None
    """Resistor at the SET of the current source; none without one."""

    @property
    def load_w(self) -> float:
        """Load of the resistor, nominal."""
        return self.nominal_ma**2 * self.ohm * 1e-6

    @property
    def high_load_w(self) -> float:
        """Load of the resistor at the worst case."""
        return self.high_ma**2 * self.ohm * (1 - ratings.RESISTOR_TOLERANCE) * 1e-6


def resistor_string(config: Input, leds: int, current_ma: float) -> String:
    """A string of LEDs for a current, whose resistor is the nearest E96 value."""
    p = config.parameters
    led, volts = config.parts.emitter.led, p.supply.voltage_v
    drop = volts - leds * led.forward_voltage_v
    ohm = ratings.e96(1000 * drop / current_ma)
    low, high = (_extreme_ma(led, volts, leds, ohm, current_ma, sign) for sign in (-1, 1))
    return String(leds, ohm, 1000 * drop / ohm, low, high)


def longest_with_resistor(config: Input, share: float = LEAST_RESISTOR_SHARE) -> int:
    """Most LEDs in a string that leave its resistor a share of the supply; 0 if not even one."""
    p = config.parameters
    led, volts = config.parts.emitter.led, p.supply.voltage_v
    return int(volts * (1 - share) / led.forward_voltage_v)


def _extreme_ma(led: Led, volts: float, leds: int, ohm: float, at_ma: float, sign: int) -> float:
    """Current at one end of all tolerances and temperatures: the highest with `sign` 1, the lowest
    with -1."""
    kelvin = HOTTEST_C - ROOM_C if sign > 0 else ROOM_C - COLDEST_C
    off_v = led.forward_tolerance_v + FORWARD_V_PER_K * kelvin
    return string_current_ma(
        volts * (1 + sign * ratings.SUPPLY_TOLERANCE),
        leds,
        ohm * (1 - sign * ratings.RESISTOR_TOLERANCE),
        led.forward_voltage_v - sign * off_v,
        at_ma,
        led.ideality,
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
        at_ma: current at which the forward voltage is measured.
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


SET_V = (0.4, 0.8)
"""Voltage at SET: above its offset by far, and not much of the supply."""
SUPPLY_RANGE = 0.1
"""Fraction by which the supply changes, either way, while the current is held."""
COLDEST_C, ROOM_C, HOTTEST_C = 0.0, 25.0, 60.0
FORWARD_V_PER_K = 0.002
"""Greatest fall of the forward voltage of an infrared LED with temperature, at these currents."""
RESISTOR_PER_K = 1e-4  # thick film of 1 % (Yageo RC_L series)
_NEAR = 0.005
MOST_OFF = 0.02
"""Of the current that sold resistors set, from the one that is asked for."""
MOST_CHANGE = 0.03
"""Of the current of one part, either way, over supply and temperature."""
MOST_SOURCE_LOAD = 0.6
"""Share of the power with which the chip reaches its highest temperature."""


def source_string(config: Input, leds: int, current_ma: float) -> String:
    """A string of LEDs for a current, with a source and its two resistors."""
    source = config.parts.emitter.source
    set_ohm, out_ohm = _resistors(source.set_ua, current_ma)
    nominal = source.set_ua / 1000 * (1 + set_ohm / out_ohm)
    off = _spread(source, set_ohm) + _change(source, config.parameters.supply.voltage_v)
    return String(leds, out_ohm, nominal, nominal * (1 - off), nominal * (1 + off), set_ohm)


def longest_with_source(config: Input) -> int:
    """Most LEDs that the lowest supply feeds beside a source; 0 if not even one."""
    least_v = config.parameters.supply.voltage_v * (1 - SUPPLY_RANGE)
    return max(0, int((least_v - _source_v(config)) / _coldest_v(config)))


def least_supply_v(config: Input) -> float:
    """Supply that feeds a single LED beside a source."""
    return (_source_v(config) + _coldest_v(config)) / (1 - SUPPLY_RANGE)


def source_problems(config: Input, strings: tuple[String, ...]) -> Iterator[tuple[str, str]]:
    """Field and message of every rule that current sources break."""
    p, source = config.parameters, config.parts.emitter.source
    name, held = p.emitter.source, regulation(config, strings)
    least, most = source.range_ma
    current, low, high = p.emitter.current_ma, strings[0].low_ma, strings[0].high_ma
    if low < least or high > most:
        yield (
            "emitter.current_ma",
            f"is {current:g}, {low:.2f} to {high:.2f} mA with all tolerances; {name!r} sets "
            f"{least:g} to {most:g} mA",
        )
    made = strings[0].nominal_ma
    if abs(made / current - 1) > MOST_OFF:
        yield (
            "emitter.current_ma",
            f"is {current:g}; the nearest that {name!r} sets with sold resistors is {made:.3g} mA",
        )
    highest_v = p.supply.voltage_v * (1 + SUPPLY_RANGE)
    if highest_v > source.rated_v:
        yield (
            "emitter.source",
            f"is {name!r}, rated {source.rated_v:g} V; a rating of {highest_v:g} V is needed",
        )
    allowed = MOST_SOURCE_LOAD * held.rated_w
    if held.power_w > allowed:
        yield (
            "emitter.source",
            f"is {name!r}, with a power of up to {1000 * held.power_w:.0f} mW at {current:g} mA; "
            f"the limit is {1000 * allowed:.0f} mW ({100 * MOST_SOURCE_LOAD:g} % of what it bears "
            f"at {HOTTEST_C:g} °C)",
        )
    if held.change > MOST_CHANGE:
        yield (
            "emitter.source",
            f"is {name!r}, whose current changes by {100 * held.change:.1f} % over supply and "
            f"temperature; at most {100 * MOST_CHANGE:g} % is allowed",
        )
    if p.emitter.resistor_side == "back":
        yield (
            "emitter.resistor_side",
            'is "back"; current sources and their resistors stand on the front. Use "front", or '
            'emitter.drive = "resistor".',
        )


def regulation(config: Input, strings: tuple[String, ...]) -> Regulation:
    """How well sources hold the current, and what they bear."""
    p, source = config.parameters, config.parts.emitter.source
    volts = p.supply.voltage_v
    first = strings[0]
    set_v = source.set_ua * 1e-6 * (first.set_ohm or 0.0)
    longest, shortest = max(s.leds for s in strings), min(s.leds for s in strings)
    led = config.parts.emitter.led
    hottest_v = led.forward_voltage_v - led.forward_tolerance_v
    hottest_v -= FORWARD_V_PER_K * (HOTTEST_C - ROOM_C)
    across_v = volts * (1 + SUPPLY_RANGE) - shortest * hottest_v - set_v
    least_v = volts * (1 - SUPPLY_RANGE) - longest * _coldest_v(config) - set_v
    return Regulation(
        source=p.emitter.source,
        set_v=set_v,
        change=_change(source, volts),
        spread=_spread(source, first.set_ohm or 0.0),
        left_v=least_v - source.dropout_v,
        power_w=max(s.high_ma for s in strings) / 1000 * across_v,
        rated_w=source.rated_w(HOTTEST_C),
        supply_range=SUPPLY_RANGE,
        resistor_per_k=RESISTOR_PER_K,
        most_load=MOST_SOURCE_LOAD,
    )


@cache
def _resistors(set_ua: float, current_ma: float) -> tuple[float, float]:
    """Sold values with which the current is as asked within half a percent, or the nearest: at
    SET, and at OUT."""
    at_set = _between(1e6 / set_ua, fine=True)
    at_out = _between(1e3 / current_ma, fine=False)

    def off(pair: tuple[float, float]) -> tuple[int, bool, float]:
        made_ma = set_ua / 1000 * (1 + pair[0] / pair[1])
        steps = int(abs(math.log(made_ma / current_ma)) / _NEAR)
        return steps, pair[0] not in common, pair[0]

    common = set(ratings.values_between(at_set[0], at_set[-1], fine=False))
    return min(itertools.product(at_set, at_out), key=off)


def _between(ohm_per_v: float, fine: bool) -> list[float]:
    """Values at which a current makes one of the voltages that SET may have."""
    least_v, most_v = SET_V
    return ratings.values_between(least_v * ohm_per_v, most_v * ohm_per_v, fine)


def _change(source: CurrentSource, volts: float) -> float:
    """Of one part, either way: reference, voltage across it, and its resistors with temperature."""
    kelvin = max(HOTTEST_C - ROOM_C, ROOM_C - COLDEST_C)
    across = source.line_per_v * SUPPLY_RANGE * volts
    return source.set_drift + across + 2 * RESISTOR_PER_K * kelvin


def _spread(source: CurrentSource, set_ohm: float) -> float:
    """From part to part, either way: reference, offset, and both resistors."""
    offset = source.offset_mv * 1000 / (source.set_ua * set_ohm)
    return source.set_tolerance + offset + 2 * ratings.RESISTOR_TOLERANCE


def _source_v(config: Input) -> float:
    """Voltage that a source and its resistor need."""
    return config.parts.emitter.source.dropout_v + SET_V[1] * (1 + ratings.RESISTOR_TOLERANCE)


def _coldest_v(config: Input) -> float:
    """Highest forward voltage of an LED."""
    led = config.parts.emitter.led
    return led.forward_voltage_v + led.forward_tolerance_v + FORWARD_V_PER_K * (ROOM_C - COLDEST_C)
