"""Capacitors held against the voltage that they stand at and what their neighbour asks for."""

from collections.abc import Iterable
from dataclasses import dataclass

from lumitip_fab.derive.faults import Faults
from lumitip_fab.derive.led_strings import SUPPLY_TOLERANCE
from lumitip_fab.load import Input


@dataclass(frozen=True)
class _Duty:
    """What a capacitor of the parameter file is for."""

    field: str
    volts: float
    beside: str = ""
    """The part that asks for a capacitance, by its name in the catalogue."""
    asked_nf: tuple[float, float] = (0.0, float("inf"))
    """The least that must be left at its voltage, and the most there may be without any."""


def refuse_receiver_capacitor(given: Input, faults: Faults) -> None:
    """Refuse a capacitor with which the multiplexers' supply dips as they switch."""
    p, known = given.parameters, given.catalogue
    supply_v = known.controllers[p.controller.board].supply_v
    mux = p.receiver.multiplexer
    duty = _Duty("receiver.capacitor", supply_v, mux, known.multiplexers[mux].bypass_nf)
    _refuse(given, [duty], faults)


def refuse_flange_capacitors(given: Input, faults: Faults) -> None:
    """Refuse capacitors of the flange's board that break, or with which its parts do not work."""
    p, known = given.parameters, given.catalogue
    switching = known.regulators[p.flange.regulator]
    duties = [
        _Duty("flange.input_capacitor", p.supply.voltage_v),
        _Duty("flange.output_capacitor", switching.output_v),
        _Duty(
            "flange.boot_capacitor", switching.output_v, p.flange.regulator, switching.boot_nf
        ),
    ]  # fmt: skip
    controller = known.controllers[p.controller.board]
    if controller.module:
        linear = known.linear_regulators[p.module.regulator]
        duties += [
            _Duty(
                "module.supply_capacitor", switching.output_v, p.module.regulator, linear.stable_nf
            ),
            _Duty(
                "module.capacitor", controller.supply_v, p.controller.board,
                controller.module.bypass_nf,
            ),
        ]  # fmt: skip
    _refuse(given, duties, faults)


def _refuse(given: Input, duties: Iterable[_Duty], faults: Faults) -> None:
    for duty in duties:
        name = given.value(duty.field)
        part = given.catalogue.capacitors[name]
        needed_v = (1 + SUPPLY_TOLERANCE) * duty.volts
        faults.refuse_unless(
            needed_v <= part.rated_v,
            duty.field,
            f"{name!r} given, made for {part.rated_v:g} V; {needed_v:g} V are needed here",
        )
        there_nf, (least, most) = part.capacitance_nf, duty.asked_nf
        faults.refuse_unless(
            least <= there_nf * part.left and there_nf <= most,
            duty.field,
            f"{name!r} given, {there_nf:g} nF, of which {there_nf * part.left:g} are sure to be "
            f"left; {duty.beside!r} needs {least:g} to {most:g} nF",
        )
