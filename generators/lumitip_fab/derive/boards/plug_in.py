"""Plugging the board that the supply enters into a live one: cable, resistor, input capacitor and
TVS diode. A breakout without a flange has no R3, U1 and C1.

```
live supply ── cable (L) ── F1 ── Q1's body diode ──┬── to the LEDs
                                                    ├── R3 ──┬── U1
                                                    D1       C1
                                                    GND      GND
```

A ceramic capacitor on its own rings with the cable to more than twice the supply, because its
capacitance falls as its voltage rises, and its charge flows as a pulse of tens of amperes through
fuse and MOSFET. R3 damps the one and limits the other.
"""

import math

from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.flange_circuit import supply_range_v
from lumitip_fab.derive.boards.supply_input import (
    drawn_by_controller_ma,
    input_board,
    is_regulated,
)
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring.protection import holds
from lumitip_fab.derive.wiring.ratings import (
    MOST_RESISTOR_LOAD,
    RESISTOR_TOLERANCE,
    SUPPLY_TOLERANCE,
    sold_from,
    sold_ohm,
)
from lumitip_fab.derive.wiring.sources import COLDEST_C
from lumitip_fab.design.electrical import PlugIn

CABLE_UH = (0.5, 2.0)
"""Least and greatest inductance of the robot's cable."""
CAPACITANCE_TOLERANCE = 0.2
"""Of a ceramic capacitor, either way."""
MELTING_SHARE = 0.2
"""Part of its melting I²t that a fuse takes 100,000 times (22 % by makers' application notes)."""
PULSE_SHARE = 0.8
"""Part of its rated pulse that the MOSFET takes."""


def derive_plug_in(config: Input, faults: Diagnostics) -> tuple[PlugIn, ...]:
    """Figures of the board that the supply enters as it is plugged in; none where that does not
    protect its input.

    Raises nothing: parts that do not bear it are reported to `faults`.
    """
    p, parts, board = config.parameters, config.parts.flange, input_board(config)
    if board is None:
        return ()
    high_v, regulates = p.supply.voltage_v * (1 + SUPPLY_TOLERANCE), _regulates(config)
    if not regulates:
        _refuse_tvs(config, faults)
    elif p.supply.voltage_v <= supply_range_v(config)[1]:  # else the supply itself is refused
        _refuse_tvs(config, faults)
        _refuse_inrush(config, faults)
    capacitor = parts.input_capacitor
    full_uf = capacitor.capacitance_nf / 1000 if regulates else 0.0
    low_ohm = p.flange.inrush_ohm * (1 - RESISTOR_TOLERANCE)
    surge_j = _surge_j(config) if regulates else 0.0
    return (
        PlugIn(
            board=board,
            supply_v=high_v,
            cable_uh=CABLE_UH,
            inrush_ohm=p.flange.inrush_ohm,
            capacitor_uf=full_uf,
            left=capacitor.left,
            left_at_v=p.supply.voltage_v,
            capacitor_tolerance=CAPACITANCE_TOLERANCE,
            breakdown_v=parts.tvs.breakdown_v,
            conducts_v=parts.tvs.conducts_v(COLDEST_C),
            coldest_c=COLDEST_C,
            tvs_ohm=parts.tvs.dynamic_ohm,
            clamping_v=parts.tvs.clamping_v,
            gate_v=parts.transistor.gate_v,
            limit_v=_limit_v(config),
            peak_a=high_v / low_ohm if full_uf else 0.0,
            pulse_a=parts.transistor.pulse_a,
            surge_a2s=surge_j / low_ohm,
            melting_a2s=parts.fuse.melting_a2s,
            pulse_j=surge_j,
        ),
    )


def _regulates(config: Input) -> bool:
    """Whether a regulator with an input capacitor is behind the input: on a flange alone."""
    return input_board(config) == "flange" and is_regulated(config)


def _limit_v(config: Input) -> float:
    """Largest voltage of what is behind the input, by its ratings: of a regulator; of the LEDs'
    current sources on the way from a breakout; else of the TVS diode's pulse."""
    parts = config.parts
    if _regulates(config):
        return parts.flange.regulator.input_v[1]
    if input_board(config) == "breakout" and config.parameters.emitter.drive == "source":
        return parts.emitter.source.rated_v
    return parts.flange.tvs.clamping_v


def least_inrush_ohm(config: Input) -> float:
    """The smallest resistor that damps the ringing, and keeps the pulse within fuse and MOSFET."""
    parts = config.parts.flange
    high_v = config.parameters.supply.voltage_v * (1 + SUPPLY_TOLERANCE)
    needed = [_damping_ohm(config)]
    if parts.transistor.pulse_a is not None:
        needed.append(high_v / (PULSE_SHARE * parts.transistor.pulse_a))
    if parts.fuse.melting_a2s is not None:
        needed.append(_surge_j(config) / (MELTING_SHARE * parts.fuse.melting_a2s))
    return max(needed) / (1 - RESISTOR_TOLERANCE)


def _damping_ohm(config: Input) -> float:
    """Critical damping of the longest cable with the least capacitance: 2 sqrt(L / C)."""
    capacitor = config.parts.flange.input_capacitor
    least_nf = capacitor.capacitance_nf * capacitor.left * (1 - CAPACITANCE_TOLERANCE)
    return 2 * math.sqrt(CABLE_UH[1] * 1e-6 / (least_nf * 1e-9))


def _surge_j(config: Input) -> float:
    """Energy that charging the input capacitor leaves in the resistor, as if its capacitance did
    not fall with its voltage: C V² / 2, more than it is."""
    if not is_regulated(config):
        return 0.0
    high_v = config.parameters.supply.voltage_v * (1 + SUPPLY_TOLERANCE)
    most_nf = config.parts.flange.input_capacitor.capacitance_nf * (1 + CAPACITANCE_TOLERANCE)
    return most_nf * 1e-9 * high_v**2 / 2


def _refuse_tvs(config: Input, faults: Diagnostics) -> None:
    """Refuse a TVS diode that conducts at the supply, or only above what the parts bear."""
    p, parts = config.parameters, config.parts.flange
    tvs, volts = parts.tvs, p.supply.voltage_v
    faults.unless(
        holds(tvs, volts),
        "tvs_conducts",
        tvs=tvs,
        least=tvs.conducts_v(COLDEST_C),
        coldest=COLDEST_C,
        volts=volts,
        high_v=volts * (1 + SUPPLY_TOLERANCE),
    )
    bears_v = min(parts.transistor.rated_v, _limit_v(config))
    faults.unless(
        tvs.breakdown_v[1] <= bears_v, "tvs_late", bears_v=bears_v, breakdown_v=tvs.breakdown_v[1]
    )


def _refuse_inrush(config: Input, faults: Diagnostics) -> None:
    """Refuse a resistor that rings, lets too much current through, overheats or drops too much."""
    p, parts = config.parameters, config.parts.flange
    ohm, sold, least = p.flange.inrush_ohm, sold_ohm(p.flange.inrush_ohm), least_inrush_ohm(config)
    faults.unless(math.isclose(sold, ohm), "inrush_not_sold", ohm=ohm, sold=sold)
    faults.unless(
        ohm >= least, "inrush_small", ohm=ohm, least=sold_from(least), cable_uh=CABLE_UH[1]
    )
    low_v = p.supply.voltage_v * (1 - SUPPLY_TOLERANCE)
    drawn_a = drawn_by_controller_ma(config) * parts.regulator.output_v / low_v / 1000
    load_w = drawn_a**2 * ohm * (1 + RESISTOR_TOLERANCE)
    allowed_w = MOST_RESISTOR_LOAD * parts.inrush_resistor.power_w
    faults.unless(
        load_w <= allowed_w,
        "inrush_load",
        allowed_mw=1000 * allowed_w,
        ohm=ohm,
        drawn_ma=1000 * drawn_a,
        load_mw=1000 * load_w,
    )
    left_v, least_v = low_v - drawn_a * ohm, parts.regulator.input_v[0]
    faults.unless(left_v >= least_v, "inrush_drop", ohm=ohm, left_v=left_v, least_v=least_v)
