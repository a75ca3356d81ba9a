"""Loads at the worst case: LED strings with their resistors, and capacitors at their voltage."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.catalogue.electronics import Led
from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics

THERMAL_V = 0.02585  # kT/q at 300 K
SUPPLY_TOLERANCE = 0.05
RESISTOR_TOLERANCE = 0.01
MOST_RESISTOR_LOAD = 0.8
"""Share of the rated power at the worst case. The rating of thick-film chips holds to 70 °C and
falls linearly to 0 at 155 °C (Yageo RC_L series): 0.8 is what is left at 87 °C."""
LEAST_RESISTOR_SHARE = 0.1
"""Share of the supply across a resistor: below it the current follows every millivolt."""
_E24 = "10 11 12 13 15 16 18 20 22 24 27 30 33 36 39 43 47 51 56 62 68 75 82 91 100"
"""Tenths of the values of a decade, and of the next decade's first."""


@dataclass(frozen=True)
class String:
    """One string: LEDs, its resistor, and what flows."""

    leds: int
    ohm: float
    nominal_ma: float
    low_ma: float
    """With the lowest supply, the highest forward voltages and the highest resistor."""
    high_ma: float

    @property
    def load_w(self) -> float:
        """Load of the resistor, nominal."""
        return self.nominal_ma**2 * self.ohm * 1e-6

    @property
    def high_load_w(self) -> float:
        """Load of the resistor at the worst case."""
        return self.high_ma**2 * self.ohm * (1 - RESISTOR_TOLERANCE) * 1e-6


def string_of(config: Input, leds: int, current_ma: float) -> String:
    """A string of LEDs for a current: its resistor is the nearest E96 value."""
    p = config.parameters
    led, volts = config.parts.emitter.led, p.supply.voltage_v
    drop = volts - leds * led.forward_voltage_v
    ohm = e96(1000 * drop / current_ma)
    low, high = (_extreme_ma(led, volts, leds, ohm, current_ma, sign) for sign in (-1, 1))
    return String(leds, ohm, 1000 * drop / ohm, low, high)


def longest_string(config: Input) -> int:
    """Most LEDs in a string that leave its resistor a tenth of the supply; 0 if not even one."""
    p = config.parameters
    led, volts = config.parts.emitter.led, p.supply.voltage_v
    return int(volts * (1 - LEAST_RESISTOR_SHARE) / led.forward_voltage_v)


def lengths(cells: int, longest: int) -> tuple[int, ...]:
    """LEDs of each string: as few strings as possible, which differ by at most one LED."""
    count = math.ceil(cells / longest)
    return tuple(cells // count + (i < cells % count) for i in range(count))


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


def e96(ohm: float) -> float:
    """The nearest value of the E96 series (IEC 60063: 96 steps a decade, three digits)."""
    steps: NDArray[np.float64] = np.power(10.0, np.arange(97) / 96)
    return _nearest(ohm, np.round(steps, 2))


def sold_ohm(ohm: float) -> float:
    """The nearest value of the E24 and E96 series, in both of which 1 % resistors are sold."""
    e24 = np.array([int(value) / 10 for value in _E24.split()])
    steps = np.array([e96(ohm), _nearest(ohm, e24)])
    return float(steps[np.abs(np.log(steps / ohm)).argmin()])


def sold_from(least_ohm: float) -> float:
    """The smallest of these values that is not below a limit."""
    ohm = sold_ohm(least_ohm)
    while ohm < least_ohm:
        ohm = sold_ohm(ohm * 1.02)  # E96 steps by 2.4 %
    return ohm


def _nearest(ohm: float, mantissas: NDArray[np.float64]) -> float:
    decade = 10.0 ** math.floor(math.log10(ohm))
    nearest = mantissas[np.abs(np.log(mantissas * decade / ohm)).argmin()]
    return round(float(nearest) * decade, 6)


@dataclass(frozen=True)
class _Duty:
    """Requirements on a capacitor of the parameter file."""

    field: str
    volts: float
    beside: str = ""
    """The part that asks for a capacitance, by its name in the catalogue."""
    asked_nf: tuple[float, float] = (0.0, float("inf"))
    """Least capacitance after DC-bias derating, and largest nominal capacitance."""


def refuse_receiver_capacitor(config: Input, faults: Diagnostics) -> None:
    """Refuse a capacitor with which the multiplexers' supply dips as they switch."""
    p = config.parameters
    supply_v = config.parts.controller.board.supply_v
    mux = p.receiver.multiplexer
    duty = _Duty("receiver.capacitor", supply_v, mux, config.parts.receiver.multiplexer.bypass_nf)
    _refuse(config, [duty], faults)


def refuse_flange_capacitors(config: Input, faults: Diagnostics) -> None:
    """Refuse capacitors of the flange's board that break, or with which its parts do not work."""
    p = config.parameters
    switching = config.parts.flange.regulator
    duties = [
        _Duty("flange.input_capacitor", p.supply.voltage_v),
        _Duty("flange.output_capacitor", switching.output_v),
        _Duty("flange.boot_capacitor", switching.output_v, p.flange.regulator, switching.boot_nf),
    ]
    controller = config.parts.controller.board
    if controller.module:
        linear = config.parts.module.regulator
        duties += [
            _Duty(
                "module.supply_capacitor", switching.output_v, p.module.regulator, linear.stable_nf
            ),
            _Duty(
                "module.capacitor",
                controller.supply_v,
                p.controller.board,
                controller.module.bypass_nf,
            ),
        ]
    _refuse(config, duties, faults)


def _refuse(config: Input, duties: Iterable[_Duty], faults: Diagnostics) -> None:
    for duty in duties:
        name = config.value(duty.field)
        part = config.catalogue.capacitors[name]
        needed_v = (1 + SUPPLY_TOLERANCE) * duty.volts
        faults.refuse_unless(
            needed_v <= part.rated_v,
            duty.field,
            f"is {name!r}, rated {part.rated_v:g} V; a rating of {needed_v:g} V is needed",
        )
        there_nf, (least, most) = part.capacitance_nf, duty.asked_nf
        faults.refuse_unless(
            least <= there_nf * part.left and there_nf <= most,
            duty.field,
            f"is {name!r}, {there_nf:g} nF ({there_nf * part.left:g} nF after DC-bias derating); "
            f"{duty.beside!r} needs {least:g} to {most:g} nF",
        )
