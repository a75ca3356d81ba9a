"""The bulk capacitor of the receiver, beside the wires that its supply comes in by.

3V3 ── wire ──┬── multiplexers and pull-ups
              C
             GND

When the LEDs are switched, the current of all detectors changes at once. The wire's inductance L
lets the supply dip by I √(L / C).
"""

import math
from collections.abc import Iterator
from dataclasses import replace

from lumitip_fab.catalogue.electronics import Capacitor
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.connectors import WIDE
from lumitip_fab.derive.boards.led_switch import overlap, steps
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring.ratings import SUPPLY_TOLERANCE
from lumitip_fab.derive.wiring.wiring import Muxing
from lumitip_fab.design import Box, Finger, Part, Point
from lumitip_fab.design.electrical import Bulk

WIRE_UH_PER_M = 1.0
"""Inductance of a wire beside its return."""
CAPACITANCE_TOLERANCE = 0.2
MOST_COUNTS = 0.5
"""Dip of the supply, in counts of 255."""
REACH_MM = 20.0
"""From the capacitor's supply pad to that of the wire, at most: 20 nH of track, where the wire has
190 nH."""
BESIDE_WIRES_MM, MARK_MM = 1.1, 1.6
"""To the row of wire pads, at whose end the mark of the first one stands, and its height."""
APART_MM = 0.6
EDGE_MM = 0.5
BELOW_PARTS_MM = 0.6


def derive_bulk(config: Input, pull_ups: int) -> Bulk | None:
    """Figures of the capacitor; none without it."""
    p, part = config.parameters, config.parts.receiver.bulk_capacitor
    if part is None:
        return None
    volts = config.parts.controller.board.supply_v
    length_m = (p.wiring.controller_mm + p.wiring.slack_mm) / 1000
    bulk = Bulk(
        supply_v=volts,
        wire_uh=WIRE_UH_PER_M * length_m,
        step_ma=1000 * pull_ups * volts / p.receiver.pull_up_ohm,
        capacitor_uf=part.capacitance_nf / 1000,
        left=part.left,
        tolerance=CAPACITANCE_TOLERANCE,
        dip_mv=0.0,
        most_mv=1000 * MOST_COUNTS * volts / 255,
        reach_mm=REACH_MM,
    )
    least_uf = bulk.capacitor_uf * bulk.left * (1 - bulk.tolerance)
    return replace(bulk, dip_mv=bulk.step_ma * math.sqrt(bulk.wire_uh / least_uf))


def with_bulk(
    config: Input, finger: Finger, box: Box, muxing: Muxing, faults: Diagnostics
) -> Finger:
    """The receiver with its bulk capacitor, if it has one.

    Args:
        config: the input.
        finger: the receiver with its other parts and the holes for its cable.
        box: the board.
        muxing: number of multiplexers, whose capacitors are numbered first.
        faults: where a capacitor is refused that breaks, does not hold the supply or has no room.
    """
    part, name = config.parts.receiver.bulk_capacitor, config.parameters.receiver.bulk_capacitor
    if part is None:
        return finger
    at = _place(part, finger, box)
    for message in _problems(config, part, muxing, at):
        faults.refuse("receiver.bulk_capacitor", f"is {name!r}{message}")
    if at is None:
        return finger
    along, across = part.over_pads_mm
    ref = f"C{muxing.muxes + 1}"
    bulk = Part(ref, "capacitor", *at, across, along, part.body_mm[2], "front")
    return replace(finger, parts=(*finger.parts, bulk))


def _problems(config: Input, part: Capacitor, muxing: Muxing, at: Point | None) -> Iterator[str]:
    volts = config.parts.controller.board.supply_v
    needed_v = (1 + SUPPLY_TOLERANCE) * volts
    if part.rated_v < needed_v:
        yield f", rated {part.rated_v:g} V; a rating of {needed_v:g} V is needed"
    each = config.parameters.receiver.load == "each"
    bulk = derive_bulk(config, sum(config.parameters.grid.columns) if each else muxing.muxes)
    if bulk is not None and bulk.dip_mv > bulk.most_mv:
        yield (
            f", with which the supply dips by {bulk.dip_mv:.1f} mV as the LEDs are switched; at "
            f'most {bulk.most_mv:.1f} mV is allowed. Choose a larger one, or "none".'
        )
    if at is None:
        yield (
            ", for which wire pads, holes and edge leave no room beside the wires. Use a smaller "
            'package, or "none".'
        )


def _place(part: Capacitor, finger: Finger, box: Box) -> Point | None:
    """Upright at the left end of the row of wire pads: the place nearest to the supply's pad; none
    where that is too far."""
    along, across = part.over_pads_mm
    pads, zone = finger.connector.pads, next(z.box for z in finger.zones if z.name == "parts")
    (first_x, _), (supply_x, supply_y) = (
        pads[0],
        pads[finger.connector.signals.index(finger.connector.supply)],
    )
    right = first_x - finger.connector.pad_mm / 2 - BESIDE_WIRES_MM - across / 2
    half = finger.connector.pad_mm / 2
    taken = [Box(x, x, y, y).grown(half + APART_MM) for x, y in pads]
    taken += [Box(x, x, y, y).grown(WIDE[1] / 2 + APART_MM) for x, y in finger.holes]
    taken += [
        Box(x, x, y, y).grown(tie.hole_mm / 2 + APART_MM)
        for tie in finger.ties
        for x, y in tie.holes
    ]
    taken.append(_mark(finger))
    places = [
        (math.dist((x, y + along / 2), (supply_x, supply_y)), x, y)
        for x in steps(box.x_min_mm + EDGE_MM + across / 2, right)
        for y in steps(
            box.y_min_mm + EDGE_MM + along / 2, zone.y_min_mm - BELOW_PARTS_MM - along / 2
        )
        if not any(overlap(_upright((x, y), across, along), each) for each in taken)
    ]
    reach, x, y = min(places, default=(math.inf, 0.0, 0.0))
    return (x, y) if reach <= REACH_MM else None


def _mark(finger: Finger) -> Box:
    """Room for the mark of the first wire pad, which stands beyond a hole at the row's end."""
    x, y = finger.connector.pads[0]
    high = MARK_MM / 2
    ends = [x - finger.connector.pad_mm / 2]
    for tie in finger.ties:
        ends += [
            at - tie.hole_mm / 2 for at, up in tie.holes if abs(up - y) < high + tie.hole_mm / 2
        ]
    return Box(min(ends) - BESIDE_WIRES_MM, min(ends), y - high, y + high)


def _upright(at: Point, across_mm: float, along_mm: float) -> Box:
    x, y = at
    return Box(x - across_mm / 2, x + across_mm / 2, y - along_mm / 2, y + along_mm / 2)
