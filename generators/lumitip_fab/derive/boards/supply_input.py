"""The input of the first board that the robot's supply reaches: fuse, MOSFET against a reversed
supply, and TVS diode.

```
24V_IN ── F1 ── FUSED ── Q1 ──┬──────┬── 24V
                         │    R1     D1
                         ├────┘      GND
                         R2
                         GND
```

It is on the flange's board, or without a flange on the breakout.
"""

import math
from dataclasses import dataclass

from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring import protection, ratings
from lumitip_fab.derive.wiring.strings import Strings
from lumitip_fab.design import Component, Point
from lumitip_fab.design.components import chip, leaded, resistor

FUSE_SHARE = 0.75  # of its rating that a fuse carries for years
GATE_SHARE = 0.8  # of what the MOSFET's gate bears, at the highest supply
EFFICIENCY = 0.8  # of the regulator at a small load, assumed
TVS, FUSED, GATE, GROUND = "tvs diode", "FUSED", "GATE", "GND"

Place = tuple[Point, float]
"""Middle of a part, and its angle in degrees."""


@dataclass(frozen=True)
class Places:
    """Places of the parts."""

    fuse: Place
    transistor: Place
    upper: Place
    """Of the resistor from the supply to the gate."""
    lower: Place
    tvs: Place


def input_board(config: Input) -> str | None:
    """Name of the board that has these parts: the flange's, or the breakout where that protects
    its pins as well and the parts are made for the supply; else none."""
    if config.parameters.flange.enabled:
        return "flange"
    protects = protection.protecting_board(config) == "breakout"
    return "breakout" if protects and _fit_the_supply(config) else None


def _fit_the_supply(config: Input) -> bool:
    """Whether fuse, MOSFET and TVS diode are made for the supply."""
    volts = config.parameters.supply.voltage_v
    least, most = input_range_v(config)
    return least <= volts <= most and protection.holds(config.parts.flange.tvs, volts)


def input_nets(config: Input) -> tuple[str, str]:
    """Nets of the supply before the fuse and behind the MOSFET."""
    volts = f"{config.parameters.supply.voltage_v:g}V"
    return f"{volts}_IN", volts


def is_regulated(config: Input) -> bool:
    """Whether the controller needs a lower voltage than the supply; else they are one net."""
    p = config.parameters
    return p.supply.voltage_v != config.parts.flange.regulator.output_v


def halved(config: Input) -> bool:
    """Whether a divider halves the supply for the MOSFET's gate: a high one, or one whose TVS diode
    holds surges only above what the gate bears."""
    parts = config.parts.flange
    high_v = config.parameters.supply.voltage_v * (1 + ratings.SUPPLY_TOLERANCE)
    gate_v = parts.transistor.gate_v
    return high_v > GATE_SHARE * gate_v or parts.tvs.clamping_v > gate_v


def input_range_v(config: Input) -> tuple[float, float]:
    """Least and greatest supply that fuse and transistor take."""
    parts = config.parts.flange
    fuse, transistor = parts.fuse, parts.transistor
    gates = 2 if halved(config) else 1
    least = gates * transistor.gate_on_v / (1 - ratings.SUPPLY_TOLERANCE)
    return least, min(fuse.rated_v, transistor.rated_v, gates * transistor.gate_v)


def input_parts(config: Input, places: Places, first_resistor: int = 1) -> tuple[Component, ...]:
    """The parts in their places; the resistors' numbers begin at `first_resistor`."""
    p, parts = config.parameters.flange, config.parts.flange
    raw, supply = input_nets(config)
    leads = {"G": GATE, "S": supply, "D": FUSED}
    upper, lower = (
        resistor(f"R{number}", p.gate_ohm, parts.resistor, nets, *place)
        for number, nets, place in (
            (first_resistor, (supply, GATE), places.upper),
            (first_resistor + 1, (GATE, GROUND), places.lower),
        )
    )
    return (
        chip("F1", "fuse", p.fuse, parts.fuse, (raw, FUSED), *places.fuse),
        leaded("Q1", "transistor", p.transistor, parts.transistor, leads, *places.transistor),
        *((upper,) if halved(config) else ()),
        lower,
        chip("D1", TVS, p.tvs, parts.tvs, (supply, GROUND), *places.tvs),
    )


def refuse_input(config: Input, strings: Strings, faults: Diagnostics) -> None:
    """Refuse parts that are overloaded, and values with which the circuit does not work."""
    faults.unless(config.parts.flange.transistor.channel == "P", "n_channel_in_supply")
    _refuse_gate(config, faults)
    _refuse_fuse(config, strings, faults)


def _refuse_gate(config: Input, faults: Diagnostics) -> None:
    p = config.parameters
    ohm, volts = p.flange.gate_ohm, p.supply.voltage_v / (2 if halved(config) else 1)
    package = config.parts.flange.resistor
    sold, allowed_w = ratings.sold_ohm(ohm), ratings.MOST_RESISTOR_LOAD * package.power_w
    faults.unless(math.isclose(sold, ohm), "gate_not_sold", ohm=ohm, sold=sold)
    part, tvs = config.parts.flange.transistor, config.parts.flange.tvs
    surge_v = tvs.clamping_v / (2 if halved(config) else 1)
    faults.unless(surge_v <= part.gate_v, "gate_surge", surge_v=surge_v, gate_v=part.gate_v)
    load_w = (volts * (1 + ratings.SUPPLY_TOLERANCE)) ** 2 / (
        ohm * (1 - ratings.RESISTOR_TOLERANCE)
    )
    faults.unless(
        load_w <= allowed_w,
        "gate_load",
        ohm=ohm,
        load_mw=1000 * load_w,
        volts=volts,
        allowed_mw=1000 * allowed_w,
        least=ohm * load_w / allowed_w,
    )


def drawn_by_controller_ma(config: Input) -> float:
    """Current of the controller, with the regulator's loss."""
    return config.parts.controller.board.draws_ma / EFFICIENCY


def fed_ma(config: Input) -> float:
    """Current of the controller through the fuse; a breakout's fuse carries it only where both have
    one supply."""
    if input_board(config) == "breakout" and is_regulated(config):
        return 0.0
    output_v = config.parts.flange.regulator.output_v
    return drawn_by_controller_ma(config) * output_v / config.parameters.supply.voltage_v


def _refuse_fuse(config: Input, strings: Strings, faults: Diagnostics) -> None:
    """Refuse a fuse too small for controller and LEDs, their strings at the worst case."""
    drawn_ma = sum(string.high_ma for string in strings.strings) + fed_ma(config)
    allowed_ma = 1000 * FUSE_SHARE * config.parts.flange.fuse.rated_a
    faults.unless(
        drawn_ma <= allowed_ma,
        "fuse_small",
        allowed_ma=allowed_ma,
        fuse_share_percent=100 * FUSE_SHARE,
        drawn_ma=drawn_ma,
    )
