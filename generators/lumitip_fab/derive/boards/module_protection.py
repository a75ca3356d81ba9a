"""Parts that protect a module's pins, in their places on the flange's board.

```
┌──────────────┐
│      U2      │ R    of the LEDs' switch
└──────────────┘
 R R R R R R R C C C C   select lines, then analog lines and their capacitors as the pins are
       □   □   □         J5, to the emitter
 Z Z Z Z   Z Z Z Z   Z   diodes, each with its cathode at its wire's pad
 S0S1S23V3 A2A3A4A5      names
 □ □ □ □ □ □ □ □ □       J4, to the receiver
```
"""

from collections.abc import Iterator

from lumitip_fab.catalogue.controllers import Module
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards import connectors
from lumitip_fab.derive.boards.connectors import CONTROLLER, SWITCH
from lumitip_fab.derive.boards.protection import esd_diode, pin_capacitor, series_resistor
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring import protection
from lumitip_fab.derive.wiring.wiring import Muxing
from lumitip_fab.design import Component, Point

DIODE_MM, SUPPLY_DIODE_MM = 3.85, 4.55
"""From J4's row to a diode, beyond the name of its wire; that of the supply is longer."""
SWITCH_DIODE: tuple[Point, float] = (-13.75, -16.6), 270.0
"""Beside J5."""
DEBUGGER_Y_MM, DEBUGGER_X_MM = 11.2, {CONTROLLER: -25.6, "DIO": -23.06, "CLK": -20.7, "RST": -19.62}
"""Below J7, which has the controller's supply as well; the last one beside the regulator."""
USB_Y_MM, USB_X_MM = 17.62, {"D-": -21.3, "D+": -19.6}
"""Below J6, beside the holes for ties."""
FIRST_AT: Point = (-24.95, -6.6)
"""The first part of the row, below the antenna's keep-out."""
LAST_X_MM, ROW_Y_MM, PITCH_MM = -12.95, -6.3, 1.2
"""The last one, before the crystal; height, and part to part."""
MOST_IN_ROW = 11
"""More have no room; with fewer the place before the crystal stays free."""
PART_GAP_MM = 0.2
SWITCH_AT: Point = (-11.7, -0.6)
FIRST_RESISTOR, FIRST_CAPACITOR = 5, 11
"""Numbers after those of the flange's and the module's own parts."""

Place = tuple[Point, float]


def module_protection(
    config: Input, module: Module, muxing: Muxing, row: tuple[tuple[str, ...], Point]
) -> tuple[Component, ...]:
    """Diodes beside the wires, resistors and capacitors below the module's pins; nothing where
    the pins are joined to the wires.

    Args:
        config: the input.
        module: the controller.
        muxing: analog and select pins.
        row: signals of J4, and its middle.
    """
    if protection.protecting_board(config) is None:
        return ()
    held = protection.clamped(config, muxing)
    diodes = [end for end in _ends(*row) if end[0] in held]
    return (
        *(esd_diode(config, n, net, *place) for n, (net, place) in enumerate(diodes, start=1)),
        *_at_pins(config, module, muxing),
    )


def refuse_row(config: Input, muxing: Muxing, faults: Diagnostics) -> None:
    """Refuse more or wider resistors and capacitors than have room below the module."""
    if protection.protecting_board(config) is None:
        return
    parts = config.parts.protection
    capacitor = parts.capacitor
    wide_mm = parts.resistor.over_pads_mm[1]
    wide_mm = max(wide_mm, capacitor.over_pads_mm[1] if capacitor else 0.0)
    needed = len(muxing.select_pins) + (2 if capacitor else 1) * len(muxing.adc_pins)
    faults.unless(
        needed <= MOST_IN_ROW and wide_mm + PART_GAP_MM <= PITCH_MM,
        "module_row",
        most=MOST_IN_ROW,
        needed=needed,
        most_mm=PITCH_MM - PART_GAP_MM,
        wide_mm=wide_mm,
    )


def _ends(signals: tuple[str, ...], middle: Point) -> Iterator[tuple[str, Place]]:
    """Net and place of the diode of each wire."""
    pitch_mm = connectors.NARROW[0]
    first_mm = middle[0] - (len(signals) - 1) / 2 * pitch_mm
    for i, net in enumerate(signals):
        above_mm = SUPPLY_DIODE_MM if net == CONTROLLER else DIODE_MM
        yield net, ((first_mm + i * pitch_mm, middle[1] + above_mm), 90.0)
    yield SWITCH, SWITCH_DIODE
    for y_mm, row in ((DEBUGGER_Y_MM, DEBUGGER_X_MM), (USB_Y_MM, USB_X_MM)):
        for net, x_mm in row.items():
            yield net, ((x_mm, y_mm), 270.0)


def _at_pins(config: Input, module: Module, muxing: Muxing) -> Iterator[Component]:
    """Resistors of all lines, and capacitors of the analog ones."""
    heights = {name: y for name, (_, y, *_) in zip(module.names, module.pads_mm, strict=True)}
    # Turned by a quarter, the module has its upper pads to the left.
    read = sorted(muxing.adc_pins, key=lambda pin: -heights[module.ports[pin]])
    places: dict[str, Place] = {SWITCH: (SWITCH_AT, 270.0)}
    for i in range(len(muxing.select_pins)):
        y_mm = ROW_Y_MM if i else FIRST_AT[1]
        places[f"S{i}"] = (FIRST_AT[0] + i * PITCH_MM, y_mm), 90.0
    spare = len(muxing.select_pins) + 2 * len(read) < MOST_IN_ROW
    last_mm = LAST_X_MM - spare * PITCH_MM
    for i, net in enumerate(read):
        places[net] = (last_mm - (2 * len(read) - 1 - i) * PITCH_MM, ROW_Y_MM), 90.0
    for number, net in enumerate(protection.lines(config, muxing), start=FIRST_RESISTOR):
        nets = net, protection.pin_net(config, muxing, net)
        yield series_resistor(config, number, nets, *places[net])
    for i, net in enumerate(read):
        at = last_mm - (len(read) - 1 - i) * PITCH_MM, ROW_Y_MM
        pin = protection.pin_net(config, muxing, net)
        made = pin_capacitor(config, FIRST_CAPACITOR + i, pin, at, 270.0)
        if made:
            yield made
