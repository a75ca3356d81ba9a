"""A string of LEDs with its resistor: the current that flows, over all tolerances."""

import math
from dataclasses import dataclass

from lumitip_fab.catalogue.electronics import Led
from lumitip_fab.config.load import Input
from lumitip_fab.derive.wiring.ratings import RESISTOR_TOLERANCE, SUPPLY_TOLERANCE, e96

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
        return self.high_ma**2 * self.ohm * (1 - RESISTOR_TOLERANCE) * 1e-6


def resistor_string(config: Input, leds: int, current_ma: float) -> String:
    """A string of LEDs for a current, whose resistor is the nearest E96 value."""
    p = config.parameters
    led, volts = config.parts.emitter.led, p.supply.voltage_v
    drop = volts - leds * led.forward_voltage_v
    ohm = e96(1000 * drop / current_ma)
    low, high = (_extreme_ma(led, volts, leds, ohm, current_ma, sign) for sign in (-1, 1))
    return String(leds, ohm, 1000 * drop / ohm, low, high)


def longest_with_resistor(config: Input) -> int:
    """Most LEDs in a string that leave its resistor a tenth of the supply; 0 if not even one."""
    p = config.parameters
    led, volts = config.parts.emitter.led, p.supply.voltage_v
    return int(volts * (1 - LEAST_RESISTOR_SHARE) / led.forward_voltage_v)


def _extreme_ma(led: Led, volts: float, leds: int, ohm: float, at_ma: float, sign: int) -> float:
    """Current at one end of all tolerances: the highest with `sign` 1, the lowest with -1."""
    return string_current_ma(
        volts * (1 + sign * SUPPLY_TOLERANCE),
        leds,
        ohm * (1 - sign * RESISTOR_TOLERANCE),
        led.forward_voltage_v - sign * led.forward_tolerance_v,
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
