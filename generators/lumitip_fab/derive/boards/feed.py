"""The diode between the wire that feeds the controller and the controller's pin, on the breakout.

```
from the flange   5V ──┬──►|── VIN   controller's board ──|◄── USB
                       Z   VD1
                      GND
```

The controller's board joins USB to the same pin. Without the diode USB goes on over the flange's
coil and the regulator's switch to its supply, and to the robot's where the MOSFET conducts.
"""

from collections.abc import Iterator, Sequence

from lumitip_fab.catalogue.controllers import Plug
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards import connectors
from lumitip_fab.derive.boards.breakout_input import collide
from lumitip_fab.derive.boards.protection import HOLE_GAP_MM, apart_mm
from lumitip_fab.derive.boards.supply_input import is_regulated
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring.ratings import SUPPLY_TOLERANCE
from lumitip_fab.derive.wiring.section import COPPER_OHM_MM2_PER_M
from lumitip_fab.design import Component, Point
from lumitip_fab.design.components import chip
from lumitip_fab.design.feed import Feed

DIODE = "schottky diode"
REF = "VD1"
"""Pins of an Arduino are called D1, D2 …"""
REGULATED_TOLERANCE = 0.02
"""Of the flange's 5 V, assumed."""
USB_V = 5.5
"""Greatest voltage of USB: 5.25 V, and 5.5 V with the type C."""
EDGE_MM = 1.86
"""From the board's edge to the diode's middle: room for its body and for a track."""
UP_MM = 2.0
"""Its height above the middle: clear of the mark for cameras."""
HOLE_MM = 5.0
"""From a screw hole to the diode's middle, where it lies under the controller."""


def derive_feed(config: Input, faults: Diagnostics) -> Feed | None:
    """Voltages at the controller; none where no wire of a board feeds it.

    Raises nothing: a diode that leaves the controller too little, or that a current or a voltage
    overloads, is reported to `faults`.
    """
    p, board = config.parameters, config.parts.controller.board
    plug, diode = board.plug, config.parts.breakout.feed_diode
    if plug is None or not p.breakout.enabled:
        return None
    drawn_ma = _drawn_ma(config)
    wire_v, drop_v = _at_wire_v(config), diode.drop_v(drawn_ma) if diode else 0.0
    if diode:
        left_v = wire_v - drop_v
        faults.unless(left_v >= plug.least_v, "feed_low", left_v=left_v, least_v=plug.least_v)
        faults.unless(drawn_ma <= diode.rated_ma, "feed_overload", diode=diode, drawn_ma=drawn_ma)
        faults.unless(diode.rated_v >= USB_V, "feed_breaks", diode=diode, usb_v=USB_V)
    return Feed(
        board="breakout",
        diode=p.breakout.feed_diode if diode else None,
        wire=connectors.REGULATED,
        pin=plug.supply,
        wire_v=wire_v,
        drawn_ma=drawn_ma,
        drop_v=drop_v,
        least_v=plug.least_v,
    )


def leaves_enough(config: Input, name: str) -> bool:
    """Whether the controller still works behind a diode of the catalogue. Never where its supply
    is that of the LEDs, 5 V: their current, and fuse and MOSFET, leave less at the wire."""
    plug, diode = config.parts.controller.board.plug, config.catalogue.schottky_diodes[name]
    if plug is None:
        return True
    left_v = _at_wire_v(config) - diode.drop_v(_drawn_ma(config))
    return is_regulated(config) and left_v >= plug.least_v


def _drawn_ma(config: Input) -> float:
    """Largest current of the controller, with that of all detectors in full light."""
    p, board = config.parameters, config.parts.controller.board
    pull_ups = sum(p.grid.columns)
    return board.draws_ma + 1000 * pull_ups * board.supply_v / p.receiver.pull_up_ohm


def _at_wire_v(config: Input) -> float:
    """Least voltage at the end of the wire that feeds the controller: from the flange's regulator,
    or from a supply of the user's own."""
    p = config.parameters
    way_mm = 2 * (p.wiring.supply_mm + p.wiring.slack_mm)
    ohm = COPPER_OHM_MM2_PER_M * way_mm / 1000 / p.wiring.section_mm2
    volts = config.parts.flange.regulator.output_v
    made = p.flange.enabled and is_regulated(config)
    low_v = volts * (1 - (REGULATED_TOLERANCE if made else SUPPLY_TOLERANCE))
    return low_v - ohm * _drawn_ma(config) / 1000


def behind_net(config: Input, plug: Plug) -> str:
    """Net of the controller's supply pin: the wire's, or behind a diode one of its own."""
    if config.parts.breakout.feed_diode is None:
        return connectors.REGULATED
    return f"{plug.supply}_PIN" if plug.supply == connectors.REGULATED else plug.supply


def breakout_feed(
    config: Input, parts: Sequence[Component], holes: Sequence[Point], faults: Diagnostics
) -> tuple[Component, ...]:
    """The diode: beside the right screw hole, and where that has no room beside it under the
    controller; nothing where the pin is joined to the wire.

    Args:
        config: the input.
        parts: all others of the board.
        holes: for screws.
        faults: where a diode without room is refused.
    """
    plug, diode = config.parts.controller.board.plug, config.parts.breakout.feed_diode
    if diode is None or plug is None:
        return ()
    nets = behind_net(config, plug), connectors.REGULATED
    for at, angle_deg in _places(config, holes):
        made = chip(REF, DIODE, config.parameters.breakout.feed_diode, diode, nets, at, angle_deg)
        if _has_room(config, made, parts, holes):
            return (made,)
    faults.add("feed_room")
    return ()


def _places(config: Input, holes: Sequence[Point]) -> Iterator[tuple[Point, float]]:
    """Places of the diode with its angle, its cathode towards the lower row of pins."""
    right = max(x for x, _ in holes)
    yield (config.parameters.breakout.board_mm[0] / 2 - EDGE_MM, UP_MM), 90.0
    yield (right - HOLE_MM, 0.0), 180.0
    yield (HOLE_MM - right, 0.0), 180.0


def _has_room(
    config: Input, part: Component, others: Sequence[Component], holes: Sequence[Point]
) -> bool:
    away_mm = config.parameters.breakout.hole_mm / 2 + HOLE_GAP_MM
    return all(apart_mm(part, hole) >= away_mm for hole in holes) and not collide([part], others)
