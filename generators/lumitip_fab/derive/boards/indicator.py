"""The power LEDs of the boards beside the fingers: each lights while its board has a voltage.

```
5V ── R4 ── PWR_LED ──►|── GND      on the flange's board: its regulator's output
                       D2

3V3 ── R9 ── PWR_LED ──►|── GND     on the breakout: the controller's supply
                       LED1
```
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from lumitip_fab.catalogue.controllers import OPEN
from lumitip_fab.catalogue.electronics import Indicator as Part
from lumitip_fab.catalogue.electronics import Resistor
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.connectors import CONTROLLER, GROUND
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring import protection
from lumitip_fab.derive.wiring.ratings import (
    RESISTOR_TOLERANCE,
    SUPPLY_TOLERANCE,
    values_between,
)
from lumitip_fab.derive.wiring.wiring import Muxing
from lumitip_fab.design import Component, Note, Point
from lumitip_fab.design.components import chip, probe, resistor
from lumitip_fab.design.electrical import Indicator

MOST_LOAD = 0.6
"""Share of the resistor's rated power at the worst case."""
NET = "PWR_LED"
RESISTOR_AT: Point = (-6.4, 10.5)
LED_AT: Point = (-6.4, 12.3)
NOTE = Note("PWR", (-6.4, 14.0), 1.0, 0.0)
"""Beside the flange's LED, on the silkscreen."""
LEAST_BREAKOUT_MM = (45.72, 38.1)
"""Size of a breakout that has room for the LED, its legend and marks for cameras."""
LEGEND, BESIDE_X_MM = "PWR", (-4.6, 2.7, 6.1)
"""On the breakout, in the row of the wires between both cables: resistor, LED and legend."""


@dataclass(frozen=True)
class _Lit:
    """A power LED on its board, and what feeds it."""

    board: str
    field: str
    led: str
    part: Part
    refs: tuple[str, str]
    """Of LED and resistor."""
    package: Resistor
    package_field: str
    volts: float


def derive_indicators(config: Input, muxing: Muxing, faults: Diagnostics) -> tuple[Indicator, ...]:
    """Figures of the power LEDs, at most one for each board; none without them.

    Raises nothing: an LED that is dark, or that the circuit overloads, is reported to `faults`.
    """
    found = []
    for lit in (_on_flange(config), _on_breakout(config, muxing)):
        if lit is not None:
            figures = _figures(lit)
            for message in _problems(config, lit, figures):
                faults.refuse(lit.field, f"is {lit.led!r}{message}")
            found.append(figures)
    return tuple(found)


def flange_indicator(config: Input, supply: str) -> tuple[Component, ...]:
    """The LED and the resistor between the flange's output and ground; nothing without an LED."""
    lit = _on_flange(config)
    return _parts(lit, supply, (LED_AT, 180.0), (RESISTOR_AT, 180.0)) if lit else ()


def breakout_indicator(
    config: Input, muxing: Muxing, y_mm: float
) -> tuple[tuple[Component, ...], tuple[Note, ...]]:
    """The LED and the resistor between the controller's supply and ground, and their legend;
    nothing without an LED.

    Args:
        config: the input.
        muxing: number of the lines, whose resistors are numbered first.
        y_mm: height of the row of wires.
    """
    lit = _on_breakout(config, muxing)
    if lit is None:
        return (), ()
    resistor_at, led_at, legend_at = ((x, y_mm) for x in BESIDE_X_MM)
    parts = _parts(lit, CONTROLLER, (led_at, 180.0), (resistor_at, 0.0))
    return parts, (Note(LEGEND, legend_at, 1.0, 0.0),)


def _on_flange(config: Input) -> _Lit | None:
    p, parts = config.parameters.flange, config.parts.flange
    if not p.enabled or parts.indicator is None:
        return None
    return _Lit(
        board="flange",
        field="flange.indicator",
        led=p.indicator,
        part=parts.indicator,
        refs=("D2", "R4"),
        package=parts.resistor,
        package_field="flange.resistor",
        volts=parts.regulator.output_v,
    )


def _on_breakout(config: Input, muxing: Muxing) -> _Lit | None:
    p, part = config.parameters.breakout, config.parts.breakout.indicator
    controller = config.parts.controller.board
    if not p.enabled or controller.plug is None or part is None:
        return None
    before = len(protection.lines(config, muxing)) if protection.protecting_board(config) else 0
    return _Lit(
        board="breakout",
        field="breakout.indicator",
        led=p.indicator,
        part=part,
        refs=("LED1", f"R{before + 1}"),  # pins of an Arduino are called D1, D2 …
        package=config.parts.protection.resistor,
        package_field="protection.resistor",
        volts=controller.supply_v,
    )


def _parts(
    lit: _Lit, supply: str, led_at: tuple[Point, float], resistor_at: tuple[Point, float]
) -> tuple[Component, ...]:
    """LED and resistor, each with its place and its angle."""
    led, series = lit.refs
    made = chip(led, "indicator", lit.led, lit.part, (GROUND, NET), *led_at)
    return (
        replace(made, mark_confidence=lit.part.mark_confidence),
        resistor(series, _ohm(lit), lit.package, (supply, NET), *resistor_at),
    )


def _ohm(lit: _Lit) -> float:
    """The E24 value nearest to the LED's working current at its usual voltage."""
    left_v = max(lit.volts - sum(lit.part.forward_v) / 2, 0.1)
    wanted = 1000 * left_v / lit.part.current_ma
    return min(values_between(wanted / 2, wanted * 2, fine=False), key=lambda v: abs(v - wanted))


def _figures(lit: _Lit) -> Indicator:
    """Currents and power at the ends of supply, forward voltage and resistor."""
    ohm, part = _ohm(lit), lit.part
    low_v, high_v = lit.volts * (1 - SUPPLY_TOLERANCE), lit.volts * (1 + SUPPLY_TOLERANCE)
    least_v, most_v = part.forward_v
    least_ohm, most_ohm = ohm * (1 - RESISTOR_TOLERANCE), ohm * (1 + RESISTOR_TOLERANCE)
    across_v = max(high_v - least_v, 0.0)
    return Indicator(
        board=lit.board,
        led_ref=lit.refs[0],
        resistor_ref=lit.refs[1],
        led=lit.led,
        colour=part.colour,
        output_v=lit.volts,
        supply_tolerance=SUPPLY_TOLERANCE,
        resistor_tolerance=RESISTOR_TOLERANCE,
        forward_v=part.forward_v,
        ohm=ohm,
        low_ma=1000 * max(low_v - most_v, 0.0) / most_ohm,
        high_ma=1000 * across_v / least_ohm,
        visible_ma=part.visible_ma,
        max_ma=part.max_current_ma,
        resistor_w=across_v**2 / least_ohm,
        rated_w=lit.package.power_w,
        load=MOST_LOAD,
    )


def _problems(config: Input, lit: _Lit, figures: Indicator) -> Iterator[str]:
    part, board_mm = lit.part, config.parameters.breakout.board_mm
    if lit.board == "breakout" and any(
        have < least for have, least in zip(board_mm, LEAST_BREAKOUT_MM, strict=True)
    ):
        yield (
            f"; it has room between the wires on a breakout of {LEAST_BREAKOUT_MM[0]:g} x "
            f"{LEAST_BREAKOUT_MM[1]:g} mm or more. Increase breakout.board_mm, or choose "
            '"none".'
        )
    if figures.low_ma < part.visible_ma:
        yield (
            f", which needs {part.visible_ma:g} mA to be seen and up to {part.forward_v[1]:g} V; "
            f"at {figures.output_v:g} V it gets as little as {figures.low_ma:.2f} mA. Choose one "
            'with a lower voltage, or "none".'
        )
    if figures.high_ma > part.max_current_ma:
        yield (
            f", rated {part.max_current_ma:g} mA; {figures.ohm:g} ohm let up to "
            f"{figures.high_ma:.1f} mA through. Choose one with a smaller current_ma, or "
            '"none".'
        )
    allowed_w = figures.load * figures.rated_w
    if figures.resistor_w > allowed_w:
        yield (
            f", whose resistor takes up to {1000 * figures.resistor_w:.0f} mW; the limit of a "
            f"{config.value(lit.package_field)!r} is {1000 * allowed_w:.0f} mW. Choose one with "
            f'a smaller current_ma, a larger {lit.package_field}, or "none".'
        )


PAD_MM = 1.5
"""Wide enough for the tip of a probe that is held by hand."""
OUTPUT_AT: Point = (6.9, 17.3)
SUPPLY_AT: Point = (9.6, 17.3)
GROUND_AT: Point = (12.5, 17.3)
INPUT_AT: Point = (3.9, 7.4)
DATA_AT: tuple[Point, ...] = ((7.0, -15.65), (7.0, -17.4), (7.0, -13.9))


def flange_probes(
    config: Input, supplies: tuple[str, str, str], faults: Diagnostics
) -> tuple[Component, ...]:
    """A test point for each supply, for ground and for each data line of the coupling.

    Args:
        config: the input.
        supplies: nets of the contacts' supply, of the same after the MOSFET, and of the output.
        faults: where more data lines than there is room for are refused.
    """
    raw, supply, output = supplies
    lines = _data_lines(config)
    faults.unless(
        len(lines) <= len(DATA_AT),
        "too_many_data_lines",
        data_at_count=len(DATA_AT),
        open=OPEN,
        lines=", ".join(lines),
    )
    places = dict(zip(lines, DATA_AT, strict=False))
    places |= {raw: INPUT_AT, supply: SUPPLY_AT, "GND": GROUND_AT, output: OUTPUT_AT}
    return tuple(
        probe(f"TP{number}", net, at, "front", PAD_MM)
        for number, (net, at) in enumerate(places.items(), start=1)
    )


def _data_lines(config: Input) -> tuple[str, ...]:
    """Signals on the coupling's data contacts, which go on to a header; each once."""
    contacts = config.parts.flange.coupling.contacts
    signals = zip(config.parameters.flange.signals, contacts, strict=False)
    lines = (signal for signal, contact in signals if contact.kind == "data" and signal != OPEN)
    return tuple(dict.fromkeys(lines))
