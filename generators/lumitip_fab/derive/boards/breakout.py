"""The board that the controller plugs into.

```
┌────────────────────────────────┐
│ [24V GND LED] R►| [24V GND 5V] │  wires to the emitter and from the flange, power LED
│  ○ ○ ○ ○ ○ ○ ○ ○ ○ ○ ○ ○ ○ ○ ○ │  a pad for each pin of the controller
│  □ ■ ■ ■ ■ ■ ■ ■ ■ ■ ■ ■ ■ ■ ■ │  socket
│   ·                        ·   │  screw holes; between the sockets parts at the pins
│  □ ■ ■ ■ ■ ■ ■ ■ ■ ■ ■ ■ ■ ■ ■ │
│  ○ ○ ○ ○ ○ ○ ○ ○ ○ ○ ○ ○ ○ ○ ○ │
│   [S0 S1 S2 3V3 GND A0 A1 …]   │  wires to the receiver, in its own order
└────────────────────────────────┘
```
"""

from dataclasses import dataclass, replace

from lumitip_fab.catalogue.controllers import Plug, Strip
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards import connectors, ties
from lumitip_fab.derive.boards.breakout_input import board_mm, breakout_input
from lumitip_fab.derive.boards.feed import behind_net, breakout_feed
from lumitip_fab.derive.boards.indicator import breakout_indicator
from lumitip_fab.derive.boards.protection import breakout_protection, refuse_breakout
from lumitip_fab.derive.boards.supply_input import FUSED, input_board, input_nets
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring.protection import pin_net
from lumitip_fab.derive.wiring.strings import Strings
from lumitip_fab.derive.wiring.wiring import Muxing
from lumitip_fab.design import AuxiliaryBoard, Box, Component, Note, Point, footprints
from lumitip_fab.design.components import fiducials, mounted, numbered, wires

CORNER_MM = 1.0
PAD_MM, DRILL_MM = 1.7, 1.0  # of the pads beside the sockets
EDGE_MM = 1.0  # wire pads to the board's edge
BETWEEN_MM = (
    0.4  # least gap between rows of copper, for their labels' sake more where there is room
)
MARK_MM = 2.0, 5.0
"""Marks for the placing machine's camera: to the board's end, and from its middle."""
MARKS = (-1, -1), (1, -1), (-1, 1)
HOLE_WEB_MM = 1.0  # board and tracks between a screw hole and a socket's row


@dataclass(frozen=True)
class Rows:
    """Heights of the rows of pads, above and below the middle."""

    socket_mm: float
    beside_mm: float
    wires_mm: float


def derive_breakout(
    config: Input, strings: Strings, muxing: Muxing, faults: Diagnostics
) -> tuple[AuxiliaryBoard, ...]:
    """The breakout board; none if it is not wanted, or if the controller has no pins to plug."""
    p = config.parameters
    plug = config.parts.controller.board.plug
    if not p.breakout.enabled or plug is None:
        return ()
    strip = config.parts.breakout.socket
    length, width = board_mm(config)
    rows = _rows(plug, strip, width)
    _refuse(config, plug, strip, muxing, rows, faults)
    half = p.breakout.hole_spacing_mm / 2
    holes = ((-half, 0.0), (half, 0.0))
    box = Box(-length / 2, length / 2, -width / 2, width / 2)
    joints = _components(config, plug, strip, muxing, rows)
    cables = tuple(part for part in joints if part.kind == "wires" and part.pins)
    pins = _places(plug, strip, _net_of(config, plug, muxing) | switching(config), rows)
    beside_mm = rows.beside_mm + PAD_MM / 2
    protecting = breakout_protection(config, muxing, cables, pins, beside_mm)
    band_mm = rows.wires_mm - connectors.WIDE[1] / 2 - beside_mm
    refuse_breakout(config, cables, protecting, band_mm, holes, faults)
    light, legend = breakout_indicator(config, muxing, rows.wires_mm)
    marks = [(sign * (length / 2 - MARK_MM[0]), up * MARK_MM[1]) for sign, up in MARKS]
    standing = (*joints, *protecting, *light)
    entry = breakout_input(config, strings, standing, (beside_mm, rows.wires_mm), faults)
    at_cameras = fiducials(marks)
    feed = breakout_feed(config, (*standing, *entry, *at_cameras), holes, faults)
    soldered = (*protecting, *light, *entry, *feed)
    parts = (*joints, *soldered, *(at_cameras if soldered else ()))
    screws = [(at, p.breakout.hole_mm) for at in holes]
    lit = connectors.lit_supply(config)
    before = (input_nets(config)[0], FUSED) if entry else ()
    behind = (behind_net(config, plug),) if feed else ()
    return (
        AuxiliaryBoard(
            name="breakout",
            title="controller breakout",
            title_at=(0.0, 0.0),
            box=box,
            corner_mm=CORNER_MM,
            holes=holes,
            hole_mm=p.breakout.hole_mm,
            ties=ties.derive_ties(parts, box, CORNER_MM, screws, "breakout.board_mm", faults),
            components=parts,
            notes=(Note("USB", (1.5 - length / 2, 0.0), 1.2, 90.0), *legend),
            supplies=tuple(
                dict.fromkeys(("GND", connectors.REGULATED, "3V3", lit, *before, *behind))
            ),
            keep_outs=(),
            hot_loop=(),
        ),
    )


def supply_signals(config: Input) -> tuple[str, ...]:
    """Signals of the cable from the flange, which feeds emitter and controller: ground lies between
    both supplies."""
    lit = connectors.lit_supply(config)
    return tuple(dict.fromkeys((lit, connectors.GROUND, connectors.REGULATED)))


def _rows(plug: Plug, strip: Strip, width_mm: float) -> Rows:
    socket = plug.spacing_mm / 2
    return Rows(
        socket_mm=socket,
        beside_mm=socket + strip.pitch_mm,
        wires_mm=width_mm / 2 - EDGE_MM - connectors.WIDE[1] / 2,
    )


def _components(
    config: Input, plug: Plug, strip: Strip, muxing: Muxing, rows: Rows
) -> tuple[Component, ...]:
    nets = {
        pin: pin_net(config, muxing, net)
        for pin, net in (_net_of(config, plug, muxing) | switching(config)).items()
    }
    receiver = connectors.receiver_signals(config, muxing)
    emitter, supply = connectors.emitter_signals(config), supply_signals(config)
    wired = {*receiver, *emitter, *supply, *nets.values(), *input_nets(config), FUSED}
    sockets, beside = [], []
    value, shape = config.parameters.breakout.socket, footprints.socket(strip)
    for number, (names, side) in enumerate(zip(plug.rows, (-1, 1), strict=True), start=1):
        on = tuple(nets.get(name) or _spare(name, wired) for name in names)
        at = 0.0, side * rows.socket_mm
        sockets.append(
            mounted(f"J{number}", "socket", value, strip, shape, numbered(on), at, pins=names)
        )
        at, size_mm = (0.0, side * rows.beside_mm), (strip.pitch_mm, PAD_MM, DRILL_MM)
        beside.append(wires(f"J{number + 2}", on, size_mm, at, named=False))
    length = config.parameters.breakout.board_mm[0]
    edge = length / 2 - ties.WEB_MM - ties.HOLE_MM - ties.GAP_MM
    left = -edge + connectors.half_width_mm(len(emitter), wide=True)
    right = edge - connectors.half_width_mm(len(supply), wide=True)
    return (
        *sockets,
        *beside,
        _wires("J5", receiver, 0.0, -rows.wires_mm, length),
        _wires("J6", emitter, left, rows.wires_mm, length),
        _entering(config, _wires("J7", supply, right, rows.wires_mm, length)),
    )


def _spare(name: str, wired: set[str]) -> str:
    """Net of a pin without a wire: its name, unless a wire's net is called so."""
    return f"{name}_SPARE" if name in wired else name


def _entering(config: Input, cable: Component) -> Component:
    """The wire pads that the board is fed by, with its supply on the net before the fuse where it
    has one. The wires keep their names."""
    if input_board(config) != "breakout":
        return cable
    raw, supply = input_nets(config)
    nets = tuple((pad, raw if net == supply else net) for pad, net in cable.nets)
    return replace(cable, nets=nets)


def _net_of(config: Input, plug: Plug, muxing: Muxing) -> dict[str, str]:
    """Net of the wire of each pin that has one, and of the supplies. Behind a diode the pin that
    takes a supply has a net of its own."""
    nets = {pin: pin for pin in muxing.adc_pins}
    nets |= {pin: f"S{i}" for i, pin in enumerate(muxing.select_pins)}
    fed = behind_net(config, plug)
    return nets | {plug.ground: "GND", plug.supply: fed, plug.regulated: "3V3"}


def _places(plug: Plug, strip: Strip, nets: dict[str, str], rows: Rows) -> dict[str, Point]:
    """Place of a pin with each net."""
    middle = (strip.ways - 1) / 2
    return {
        nets[name]: ((i - middle) * strip.pitch_mm, side * rows.socket_mm)
        for names, side in zip(plug.rows, (-1, 1), strict=True)
        for i, name in enumerate(names)
        if name in nets
    }


def switching(config: Input) -> dict[str, str]:
    """Net of the pin that switches the LEDs; empty where they are always on."""
    pin = config.parts.controller.board.emitter_pin
    return {pin: connectors.SWITCH} if pin and config.parts.emitter.switch else {}


def _wires(
    ref: str, signals: tuple[str, ...], x_mm: float, y_mm: float, length_mm: float
) -> Component:
    """Wire pads of a cable, in the order of the connector at its other end."""
    beside = ties.WEB_MM + ties.HOLE_MM + ties.GAP_MM
    fits = connectors.half_width_mm(len(signals), wide=True) <= length_mm / 2 - beside
    size_mm = connectors.WIDE if fits else connectors.NARROW
    return wires(ref, signals, size_mm, (x_mm, y_mm))


def _refuse(
    config: Input, plug: Plug, strip: Strip, muxing: Muxing, rows: Rows, faults: Diagnostics
) -> None:
    """Refuse what does not fit onto the board."""
    p = config.parameters.breakout
    length, width = p.board_mm
    ways = {len(names) for names in plug.rows}
    faults.unless(
        ways == {strip.ways}, "socket_ways", strip=strip, rows=" and ".join(map(str, sorted(ways)))
    )
    cable = connectors.half_width_mm(len(connectors.receiver_signals(config, muxing)), wide=False)
    least_length = max(
        strip.ways * strip.pitch_mm + 2 * EDGE_MM,
        p.hole_spacing_mm + p.hole_mm + 2 * EDGE_MM,
        2 * (cable + ties.WEB_MM + ties.HOLE_MM + ties.GAP_MM),
    )
    reach = connectors.WIDE[1] / 2 + BETWEEN_MM + PAD_MM / 2
    least_width = 2 * (rows.beside_mm + reach + connectors.WIDE[1] / 2 + EDGE_MM)
    for size_mm, least, what in (
        (length, least_length, "long"),
        (width, least_width, "wide"),
    ):
        faults.unless(
            size_mm >= least - 1e-9, "breakout_small", size_mm=size_mm, what=what, least=least
        )
    faults.unless(
        p.hole_spacing_mm >= p.hole_mm + HOLE_WEB_MM,
        "screw_holes_close",
        least=p.hole_mm + HOLE_WEB_MM,
    )
    most = plug.spacing_mm - strip.pad_mm - 2 * HOLE_WEB_MM
    faults.unless(p.hole_mm <= most, "screw_hole_wide", most=most)
