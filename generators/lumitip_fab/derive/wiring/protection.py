"""Protection of the controller's pins against discharges at the wires that leave its board.

```
wire ──┬── R ──┬── analog pin        wire ──┬── R ── pin of a select line or of the LEDs' switch
       Z       C                            Z
      GND     GND                          GND
```

A discharge by IEC 61000-4-2 goes through the diode Z. The voltage that is left at Z drives a
current through R into the diodes of the pin. Data sheets limit the voltage of a pin to that of its
supply, and name no current; they name a discharge of the human-body model that it bears.
"""

import math

from lumitip_fab.catalogue.clamps import EsdDiode, TvsDiode
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.connectors import CONTROLLER, REGULATED, SWITCH
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring.ratings import (
    RESISTOR_TOLERANCE,
    SUPPLY_TOLERANCE,
    sold_from,
    sold_ohm,
)
from lumitip_fab.derive.wiring.sources import COLDEST_C
from lumitip_fab.derive.wiring.wiring import Muxing
from lumitip_fab.design.protection import Protection

DISCHARGE_KV = 8.0
"""Contact discharge of level 4, the highest of IEC 61000-4-2."""
PEAK_A_PER_KV, RISE_NS = 3.75, 0.8
"""First peak and its rise from 10 to 90 %, by IEC 61000-4-2."""
NH_PER_MM = 1.0
"""Inductance of the way over the diode, by its distance from the wire's pad."""
REACH_MM = 4.0
"""From a wire's pad to its diode, at most."""
PIN_MM = 5.0
"""From resistor and capacitor to the pin, at most."""
HBM_OHM = 1500.0
"""Resistor of the human-body model (JEDEC JS-001)."""
MODULE_SIGNALS = ("D-", "D+", "DIO", "CLK", "RST")
"""Wires of a module's USB and debugger, which go to its pins without a resistor. The supply of USB
has a capacitor beside the module."""
MOST_SHARE = 0.5
"""Of the current of that model that a pin takes here."""


def protecting_board(config: Input) -> str | None:
    """Name of the board that has the parts: the breakout, or the flange's with a module; none where
    the pins are joined to the wires."""
    p, controller = config.parameters, config.parts.controller.board
    if config.parts.protection.diode is None:
        return None
    if controller.module is not None:
        return "flange" if p.flange.enabled else None
    return "breakout" if p.breakout.enabled and controller.plug else None


def lines(config: Input, muxing: Muxing) -> tuple[str, ...]:
    """Signals between a wire and a pin."""
    parts = config.parts
    switched = (SWITCH,) if parts.emitter.switch and parts.controller.board.emitter_pin else ()
    return (*(f"S{i}" for i in range(len(muxing.select_pins))), *muxing.adc_pins, *switched)


def pin_net(config: Input, muxing: Muxing, net: str) -> str:
    """Net at the controller's pin whose wire has this net."""
    apart = protecting_board(config) and net in lines(config, muxing)
    return f"{net}_PIN" if apart else net


def clamped(config: Input, muxing: Muxing) -> tuple[str, ...]:
    """Nets whose wires have a diode: signals, and supplies up to its stand-off voltage."""
    diode = config.parts.protection.diode
    if diode is None:
        return ()
    controller = config.parts.controller.board
    on_wires = {CONTROLLER: controller.supply_v}
    if controller.module is None:
        on_wires[REGULATED] = config.parts.flange.regulator.output_v
    fitting = (net for net, volts in on_wires.items() if holds(diode, volts))
    direct = MODULE_SIGNALS if controller.module is not None else ()
    return (*lines(config, muxing), *fitting, *direct)


def holds(diode: TvsDiode, volts: float) -> bool:
    """Whether a diode does not conduct at a supply, at the coldest either: its breakdown voltage
    falls with its temperature."""
    most_v = volts * (1 + SUPPLY_TOLERANCE)
    return diode.standoff_v >= volts and diode.conducts_v(COLDEST_C) >= most_v


def derive_protection(config: Input, muxing: Muxing, faults: Diagnostics) -> Protection | None:
    """Figures of the parts; none without them.

    Raises nothing: parts that protect no pin are reported to `faults`.
    """
    p, parts, board = config.parameters, config.parts.protection, protecting_board(config)
    diode, controller = parts.diode, config.parts.controller.board
    if board is None or diode is None:
        return None
    peak_a = PEAK_A_PER_KV * DISCHARGE_KV
    spike_v = NH_PER_MM * REACH_MM * peak_a / RISE_NS
    left_v = diode.breakdown_v[1] + diode.dynamic_ohm * peak_a + spike_v
    most_a = None if controller.hbm_v is None else MOST_SHARE * controller.hbm_v / HBM_OHM
    _refuse(config, diode, left_v, most_a, faults)
    return Protection(
        board=board,
        diode=p.protection.diode,
        breakdown_v=diode.breakdown_v[1],
        dynamic_ohm=diode.dynamic_ohm,
        diode_pf=diode.capacitance_pf,
        series_ohm=p.protection.series_ohm,
        resistor_tolerance=RESISTOR_TOLERANCE,
        capacitor_pf=1000 * parts.capacitor.capacitance_nf if parts.capacitor else 0.0,
        pin_pf=controller.input_pf,
        lines=lines(config, muxing),
        clamped=clamped(config, muxing),
        discharge_kv=DISCHARGE_KV,
        nh_per_mm=NH_PER_MM,
        reach_mm=REACH_MM,
        pin_mm=PIN_MM,
        hbm_v=controller.hbm_v,
        most_pin_a=most_a,
        pin_a=left_v / (p.protection.series_ohm * (1 - RESISTOR_TOLERANCE)),
    )


def _refuse(
    config: Input, diode: EsdDiode, left_v: float, most_a: float | None, faults: Diagnostics
) -> None:
    """Refuse a diode that conducts at a signal, a resistor that is not sold or lets too much
    through, and a capacitor that breaks."""
    p, parts, controller = (
        config.parameters.protection,
        config.parts.protection,
        config.parts.controller.board,
    )
    faults.unless(
        holds(diode, controller.supply_v),
        "diode_conducts",
        diode=diode,
        least=diode.conducts_v(COLDEST_C),
        coldest=COLDEST_C,
        supply_v=controller.supply_v,
        high_v=controller.supply_v * (1 + SUPPLY_TOLERANCE),
    )
    sold = sold_ohm(p.series_ohm)
    faults.unless(math.isclose(sold, p.series_ohm), "series_not_sold", sold=sold)
    least_ohm = left_v / most_a / (1 - RESISTOR_TOLERANCE) if most_a else 0.0
    faults.unless(
        p.series_ohm >= least_ohm,
        "series_small",
        kilovolt=DISCHARGE_KV,
        left_v=left_v,
        least=sold_from(max(least_ohm, 1.0)),
    )
    rated_v = (1 + SUPPLY_TOLERANCE) * controller.supply_v
    faults.unless(
        parts.capacitor is None or parts.capacitor.rated_v >= rated_v,
        "pin_capacitor_breaks",
        rated_v=rated_v,
    )
