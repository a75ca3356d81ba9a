"""Parts that protect the controller's pins, in their places on its board.

On the breakout the diodes stand beside the wire pads, the others beside the pins: of the upper row
outside of it, of the lower row, which has the analog pins, under the controller.

```
   □   □      wires to the emitter and from the flange
   Z   Z      diodes, each with its cathode at its wire's pad
 R   R        ┐
 ○ ○ ○ ○      │ upper row
 ■ ■ ■ ■      ┘ socket
     ·        screw hole
 R C R C      ┐
 ■ ■ ■ ■      │ lower row
 ○ ○ ○ ○      ┘
   Z   Z
   □   □      wires to the receiver
```
"""

import math
from collections.abc import Iterator, Mapping, Sequence

from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards import connectors
from lumitip_fab.derive.boards.packages import capacitor
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring import protection
from lumitip_fab.derive.wiring.wiring import Muxing
from lumitip_fab.design import Component, Point
from lumitip_fab.design.components import chip, resistor

ESD = "esd diode"
GAP_MM = 0.3
"""Between pads and parts: more than `Rules.copper_gap_mm` by default."""
NAME_MM = 1.8
"""Between contacts and parts, for the contacts' names."""
HOLE_GAP_MM = 1.3
"""From a part to a screw's hole: half of what the head of an M2 screw is wider."""


def esd_diode(config: Input, number: int, net: str, at: Point, angle_deg: float) -> Component:
    """The diode of a wire, its cathode to the left without an angle. Its letter is Z: pins of an
    Arduino are called D1, D2 …"""
    name, part = config.parameters.protection.diode, config.parts.protection.diode
    assert part is not None
    return chip(f"Z{number}", ESD, name, part, (net, connectors.GROUND), at, angle_deg)


def series_resistor(
    config: Input, number: int, nets: tuple[str, str], at: Point, angle_deg: float
) -> Component:
    """The resistor from a wire to its pin."""
    ohm, part = config.parameters.protection.series_ohm, config.parts.protection.resistor
    return resistor(f"R{number}", ohm, part, nets, at, angle_deg)


def pin_capacitor(
    config: Input, number: int, net: str, at: Point, angle_deg: float
) -> Component | None:
    """The capacitor of an analog pin; none where pins have none."""
    if config.parts.protection.capacitor is None:
        return None
    name, nets = config.parameters.protection.capacitor, (net, connectors.GROUND)
    return capacitor(config, f"C{number}", name, nets, at, angle_deg)


def breakout_protection(
    config: Input,
    muxing: Muxing,
    rows: Sequence[Component],
    pins: Mapping[str, Point],
    beside_mm: float,
) -> tuple[Component, ...]:
    """Parts of the breakout.

    Args:
        config: the input.
        muxing: analog and select pins.
        rows: wire pads of all cables.
        pins: place of the pin of each signal.
        beside_mm: from the middle to the outer end of the pads beside the sockets.
    """
    if protection.protecting_board(config) is None:
        return ()
    held = protection.clamped(config, muxing)
    ends = [end for row in rows for end in _ends(row) if end[0] in held]
    diodes = [
        esd_diode(config, number, net, _beside(config, at, pad_mm), 0.0)
        for number, (net, at, pad_mm) in enumerate(ends, start=1)
    ]
    others = list[Component]()
    for number, net in enumerate(protection.lines(config, muxing), start=1):
        x, y = pins[net]
        reach_mm = config.parts.protection.resistor.over_pads_mm[0] / 2
        pitch_mm = config.parts.breakout.socket.pitch_mm  # as wide is the socket's body
        inside = y + pitch_mm / 2 + NAME_MM + reach_mm
        at = x, inside if y < 0 else beside_mm + GAP_MM + reach_mm
        others += _at_pin(config, muxing, number, net, at)
    return (*diodes, *others)


def _ends(row: Component) -> Iterator[tuple[str, Point, float]]:
    """Net, place and width of each pad of a row that is not turned."""
    for (_, net), pad in zip(row.nets, row.footprint.pads, strict=True):
        yield net, (row.x_mm + pad.x_mm, row.y_mm + pad.y_mm), pad.width_mm


def _beside(config: Input, pad_at: Point, pad_mm: float) -> Point:
    """The place of a diode between a wire's pad and the sockets, its cathode above the pad."""
    part = config.parts.protection.diode
    assert part is not None
    away_mm = pad_mm / 2 + NAME_MM + part.over_pads_mm[1] / 2
    inward = -math.copysign(1.0, pad_at[1])
    return pad_at[0] + part.pad_pitch_mm / 2, pad_at[1] + inward * away_mm


def _at_pin(config: Input, muxing: Muxing, number: int, net: str, at: Point) -> Iterator[Component]:
    """The resistor of a line above its pin, and the capacitor of an analog one beside it."""
    pin = protection.pin_net(config, muxing, net)
    yield series_resistor(config, number, (net, pin), at, 270.0)
    if net in muxing.adc_pins:
        which = muxing.adc_pins.index(net) + 1
        beside = at[0] + config.parts.breakout.socket.pitch_mm / 2, at[1]
        made = pin_capacitor(config, which, pin, beside, 90.0)
        if made:
            yield made


def refuse_breakout(
    config: Input,
    rows: Sequence[Component],
    parts: Sequence[Component],
    band_mm: float,
    holes: Sequence[Point],
    faults: Diagnostics,
) -> None:
    """Refuse parts that have no room.

    Args:
        config: the input.
        rows: wire pads of all cables.
        parts: of the protection.
        band_mm: between wire pads and the pads beside the sockets.
        holes: for screws.
        faults: where they are refused.
    """
    if not parts:
        return
    p, protecting = config.parameters, config.parts.protection
    diode = protecting.diode
    assert diode is not None
    along, across = diode.over_pads_mm
    high = NAME_MM + across + GAP_MM
    pitch_mm = min(row.footprint.pads[1].x_mm - row.footprint.pads[0].x_mm for row in rows)
    faults.unless(
        pitch_mm >= along + GAP_MM and band_mm >= high - 1e-9,
        "diode_room",
        needed_mm=along + GAP_MM,
        high_mm=high,
        pitch_mm=pitch_mm,
        band_mm=band_mm,
    )
    half_mm, capacitor_part = config.parts.breakout.socket.pitch_mm / 2, protecting.capacitor
    wide = protecting.resistor.over_pads_mm[1]
    wide = max(wide, capacitor_part.over_pads_mm[1] if capacitor_part else 0.0)
    faults.unless(
        wide + GAP_MM <= half_mm + 1e-9, "series_wide", wide_mm=wide, most_mm=half_mm - GAP_MM
    )
    keep_mm = p.breakout.hole_mm / 2 + HOLE_GAP_MM
    near = {part.ref for part in parts for hole in holes if apart_mm(part, hole) < keep_mm}
    faults.unless(not near, "protection_near_hole", refs=", ".join(sorted(near)))


def apart_mm(part: Component, at: Point) -> float:
    """From a place to an upright or lying part's land pattern and body."""
    shape = part.footprint
    half_x = max(abs(pad.x_mm) + pad.width_mm / 2 for pad in shape.pads)
    half_y = max(pad.height_mm / 2 for pad in shape.pads)
    if part.angle_deg % 180:
        half_x, half_y = half_y, half_x
    x = max(abs(at[0] - part.x_mm) - half_x, 0.0)
    y = max(abs(at[1] - part.y_mm) - half_y, 0.0)
    return math.hypot(x, y)
