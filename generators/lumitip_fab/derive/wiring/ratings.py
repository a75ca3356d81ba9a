"""Ratings of resistors and capacitors, and the values that resistors are sold in."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics

SUPPLY_TOLERANCE = 0.05
RESISTOR_TOLERANCE = 0.01
MOST_RESISTOR_LOAD = 0.8
"""Share of the rated power at the worst case. The rating of thick-film chips holds to 70 °C and
falls linearly to 0 at 155 °C (Yageo RC_L series): 0.8 is what is left at 87 °C."""
_TENTHS = "10 11 12 13 15 16 18 20 22 24 27 30 33 36 39 43 47 51 56 62 68 75 82 91"
E24 = tuple(int(value) / 10 for value in _TENTHS.split())
"""Values of a decade."""
_E96 = tuple(round(10.0 ** (step / 96), 2) for step in range(96))


def e96(ohm: float) -> float:
    """The nearest value of the E96 series (IEC 60063: 96 steps a decade, three digits)."""
    return _nearest(ohm, np.array([*_E96, 10.0]))


def e24(ohm: float) -> float:
    """The nearest value of the E24 series, which each distributor has in each package."""
    return _nearest(ohm, np.array([*E24, 10.0]))


def sold_ohm(ohm: float) -> float:
    """The nearest value of the E24 and E96 series, in both of which 1 % resistors are sold."""
    steps = np.array([e96(ohm), e24(ohm)])
    return float(steps[np.abs(np.log(steps / ohm)).argmin()])


def sold_from(least_ohm: float) -> float:
    """The smallest of these values that is not below a limit."""
    ohm = sold_ohm(least_ohm)
    while ohm < least_ohm:
        ohm = sold_ohm(ohm * 1.02)  # E96 steps by 2.4 %
    return ohm


def sold_to(most_ohm: float) -> float:
    """The greatest value of the E24 series that is not above a limit."""
    ohm = e24(most_ohm)
    while ohm > most_ohm:
        ohm = e24(ohm / 1.1)  # E24 steps by 10 %
    return ohm


def values_between(least_ohm: float, most_ohm: float, fine: bool) -> list[float]:
    """Values of the E24 series between two resistances, or of E24 and E96 both."""
    series = {*E24, *(_E96 if fine else ())}
    decades = range(math.floor(math.log10(least_ohm)), math.floor(math.log10(most_ohm)) + 1)
    values = {round(value * 10.0**decade, 6) for decade in decades for value in series}
    return sorted(value for value in values if least_ohm <= value <= most_ohm)


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
        faults.unless(
            needed_v <= part.rated_v,
            "capacitor_volts",
            field=duty.field,
            name=name,
            part=part,
            needed_v=needed_v,
        )
        there_nf, (least, most) = part.capacitance_nf, duty.asked_nf
        faults.unless(
            least <= there_nf * part.left and there_nf <= most,
            "capacitor_value",
            field=duty.field,
            name=name,
            there_nf=there_nf,
            duty=duty,
            least=least,
            most=most,
            left_nf=there_nf * part.left,
        )
