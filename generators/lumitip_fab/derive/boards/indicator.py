"""The power LED of the flange's board: it lights while the board's output has its voltage.

```
5V ── R4 ── PWR_LED ──►|── GND
                       D2
```
"""

from collections.abc import Iterator

from lumitip_fab.catalogue.controllers import OPEN
from lumitip_fab.catalogue.electronics import Indicator as Part
from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring.ratings import (
    RESISTOR_TOLERANCE,
    SUPPLY_TOLERANCE,
    values_between,
)
from lumitip_fab.design import Component, Note, Point
from lumitip_fab.design.components import chip, probe, resistor
from lumitip_fab.design.electrical import Indicator

MOST_LOAD = 0.6
"""Share of the resistor's rated power at the worst case."""
RESISTOR, LED = "R4", "D2"
NET = "PWR_LED"
RESISTOR_AT: Point = (-6.4, 10.5)
LED_AT: Point = (-6.4, 12.3)
NOTE = Note("PWR", (-6.4, 14.0), 1.0, 0.0)
"""Beside the LED, on the silkscreen."""


def derive_indicator(config: Input, faults: Diagnostics) -> tuple[Indicator, ...]:
    """Figures of the power LED; none without it.

    Raises nothing: an LED that is dark, or that the circuit overloads, is reported to `faults`.
    """
    part = config.parts.flange.indicator
    if not config.parameters.flange.enabled or part is None:
        return ()
    figures = _figures(config, part)
    for message in _problems(config, part, figures):
        faults.refuse("flange.indicator", f"is {config.parameters.flange.indicator!r}{message}")
    return (figures,)


def indicator_parts(config: Input, supply: str) -> tuple[Component, ...]:
    """The resistor and the LED between a supply and ground; nothing without an LED."""
    part, parts = config.parts.flange.indicator, config.parts.flange
    if part is None:
        return ()
    name, ohm = config.parameters.flange.indicator, _ohm(config, part)
    return (
        chip(LED, "indicator", name, part, ("GND", NET), LED_AT, 180.0),
        resistor(RESISTOR, ohm, parts.resistor, (supply, NET), RESISTOR_AT, 180.0),
    )


def _output_v(config: Input) -> float:
    return config.parts.flange.regulator.output_v


def _ohm(config: Input, part: Part) -> float:
    """The E24 value nearest to the LED's working current at its usual voltage."""
    left_v = max(_output_v(config) - sum(part.forward_v) / 2, 0.1)
    wanted = 1000 * left_v / part.current_ma
    return min(values_between(wanted / 2, wanted * 2, fine=False), key=lambda v: abs(v - wanted))


def _figures(config: Input, part: Part) -> Indicator:
    """Currents and power at the ends of supply, forward voltage and resistor."""
    volts, ohm = _output_v(config), _ohm(config, part)
    low_v, high_v = volts * (1 - SUPPLY_TOLERANCE), volts * (1 + SUPPLY_TOLERANCE)
    least_v, most_v = part.forward_v
    least_ohm, most_ohm = ohm * (1 - RESISTOR_TOLERANCE), ohm * (1 + RESISTOR_TOLERANCE)
    across_v = max(high_v - least_v, 0.0)
    return Indicator(
        led=config.parameters.flange.indicator,
        colour=part.colour,
        output_v=volts,
        supply_tolerance=SUPPLY_TOLERANCE,
        resistor_tolerance=RESISTOR_TOLERANCE,
        forward_v=part.forward_v,
        ohm=ohm,
        low_ma=1000 * max(low_v - most_v, 0.0) / most_ohm,
        high_ma=1000 * across_v / least_ohm,
        visible_ma=part.visible_ma,
        max_ma=part.max_current_ma,
        resistor_w=across_v**2 / least_ohm,
        rated_w=config.parts.flange.resistor.power_w,
        load=MOST_LOAD,
    )


def _problems(config: Input, part: Part, figures: Indicator) -> Iterator[str]:
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
            f"{config.parameters.flange.resistor!r} is {1000 * allowed_w:.0f} mW. Choose one with "
            'a smaller current_ma, a larger flange.resistor, or "none".'
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
