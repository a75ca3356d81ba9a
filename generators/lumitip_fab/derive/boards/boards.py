"""Outline, holes, zones and parts of the two boards.

y_max ┌──────────────────┐
      │   ·    ·    ·    │  holes for the pins, clear of the first row
      │  o o o o o o o   │
      │  o o o o o o o   │  zone "cells"
      │                  │  channel
      │   [U1][U2][U3]   │  zone "parts": multiplexers (receiver), resistors (emitter)
      │                  │  channel
      │ ·  ▫▫▫▫▫▫▫▫▫   · │  zone "connector", two more holes
y_min └──────────────────┘
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from lumitip_fab.config.load import Input
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.derive.boards import bulk, connectors, led_switch, placing
from lumitip_fab.derive.boards.packages import flexible_board
from lumitip_fab.derive.boards.sources import source_parts
from lumitip_fab.derive.boards.ties import OPEN_MM, finger_ties
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.cells import Cells, bending_lines, derive_turned, refuse_lines
from lumitip_fab.derive.finger.stack import foot_half_mm, is_flex, roof_mm
from lumitip_fab.derive.making.fits import derive_fits
from lumitip_fab.derive.wiring.strings import Strings
from lumitip_fab.derive.wiring.wiring import Muxing
from lumitip_fab.design import AtCells, Board, Box, Connector, Finger, Part, Point, Relief, Zone

LED = AtCells("led", "D", -1.0)
DETECTOR = AtCells("photodetector", "Q", 1.0)
NOTCH_BEFORE_PADS_MM = 0.6
NOTCH_BESIDE_MM = 0.5
SEAT_CLEARANCE_MM = 1.8  # a wire of 1.5 mm passes on each side of the coupling
WINDOW_MARGIN_MM = 2.0
HOLE_TO_EDGE_MM = 1.0
PAD_TO_EDGE_MM = 0.3
LEAST_PIN_MM = 1.0
LEAST_CLEARANCE_MM = 0.02  # of a pin as drawn


@dataclass(frozen=True)
class Plan:
    """Both boards, and where the multiplexers are."""

    board: Board
    emitter: Finger
    receiver: Finger
    muxes: tuple[Point, ...]
    """Centre of each multiplexer, U1 first, in the receiver's frame."""


@dataclass(frozen=True)
class Frame:
    """Common extents and rows of both boards, before parts are placed."""

    box: Box
    cells: Box
    parts: Box
    connector_y_mm: float
    wide: bool
    notch: Box
    pin_mm: float
    rear_hole_x_mm: float
    foot_half_mm: float


def derive_plan(
    config: Input, cells: Cells, strings: Strings, muxing: Muxing, faults: Diagnostics
) -> Plan:
    """Lay out both boards."""
    p, parts = config.parameters, config.catalogue
    led = parts.leds[p.emitter.led]
    detector = parts.photodetectors[p.receiver.photodetector]
    refuse_lines(p, detector, faults)
    led_turned = derive_turned(p, "emitter.led", p.emitter.led, led, 0, faults)
    detector_turned = derive_turned(
        p, "receiver.photodetector", p.receiver.photodetector, detector, bending_lines(p), faults
    )
    leds = placing.at_cells(LED, led, led_turned, _facing(cells, LED))
    detectors = placing.at_cells(DETECTOR, detector, detector_turned, _facing(cells, DETECTOR))
    frame = _frame(config, cells, muxing, (*leds, *detectors), faults)
    board = _board(config, frame)
    muxes = placing.multiplexers(config, muxing, frame.parts)
    tip_holes = placing.tip_holes(config, cells, (*detectors, *_flipped(leds)), frame.box, faults)
    rear = (
        (-frame.rear_hole_x_mm, frame.connector_y_mm),
        (frame.rear_hole_x_mm, frame.connector_y_mm),
    )
    driving, reliefs = _driving(config, strings, frame, faults)
    lit = connectors.emitter_signals(config)
    wires = connectors.place(lit, connectors.lit_supply(config), True, frame.connector_y_mm)
    switch = led_switch.switch_parts(config, frame.parts, wires, driving)
    led_switch.refuse_switch(config, strings, bool(switch), faults)
    emitter = Finger(
        name="emitter",
        cells_hold=LED,
        cells=_facing(cells, LED),
        turned=led_turned,
        holes=(*((-x, y) for x, y in tip_holes), *rear),
        connector=wires,
        parts=(*leds, *driving, *switch),
        zones=_zones(frame),
        reliefs=reliefs,
        notch=frame.notch,
        window=_window(wires),
    )
    signals = connectors.receiver_signals(config, muxing)
    wires = connectors.place(signals, connectors.CONTROLLER, frame.wide, frame.connector_y_mm)
    receiver = Finger(
        name="receiver",
        cells_hold=DETECTOR,
        cells=_facing(cells, DETECTOR),
        turned=detector_turned,
        holes=(*tip_holes, *rear),
        connector=wires,
        parts=(*detectors, *muxes),
        zones=_zones(frame),
        reliefs=(),
        notch=frame.notch,
        window=_window(wires),
    )
    emitter, receiver = (
        replace(finger, ties=finger_ties(finger, board)) for finger in (emitter, receiver)
    )
    receiver = bulk.with_bulk(config, receiver, board.box, muxing, faults)
    return Plan(board, emitter, receiver, tuple((m.x_mm, m.y_mm) for m in muxes))


def _frame(
    config: Input, cells: Cells, muxing: Muxing, chips_: tuple[Part, ...], faults: Diagnostics
) -> Frame:
    p = config.parameters
    gripper = config.parts.coupling.gripper
    ways = len(connectors.receiver_signals(config, muxing))
    pin_mm = p.board.hole_mm - 2 * p.backing.pin_clearance_mm
    printed_mm = derive_fits(config, p.printer.fit_mm).pin_mm
    faults.unless(
        printed_mm >= LEAST_PIN_MM, "pins_thin", printed_mm=printed_mm, least_pin_mm=LEAST_PIN_MM
    )
    faults.unless(
        p.backing.pin_clearance_mm + p.printer.fit_mm >= LEAST_CLEARANCE_MM,
        "pins_as_wide_as_holes",
        least=LEAST_CLEARANCE_MM - p.backing.pin_clearance_mm,
    )
    half = float(np.abs(cells.x_mm).max()) + p.board.side_margin_mm
    rim = p.board.hole_mm / 2 + HOLE_TO_EDGE_MM
    fits = half - rim - p.board.hole_mm / 2 - NOTCH_BESIDE_MM
    wide = ways <= connectors.MOST_WIDE_WAYS and connectors.half_width_mm(ways, True) <= fits
    wires_half = connectors.half_width_mm(ways, wide)
    # Wide enough for a thread's holes at the row's ends, where the board need not grow for it.
    wider_half = wires_half + OPEN_MM
    fits_wider = wider_half + p.printer.min_wall_mm + pin_mm / 2 + rim <= half
    beside = wider_half if fits_wider and not is_flex(p) else wires_half + NOTCH_BESIDE_MM
    notch_half = max(beside, gripper.seat_width_mm / 2 + SEAT_CLEARANCE_MM)
    foot_half = foot_half_mm(config, notch_half)
    least_hole_x = notch_half + p.printer.min_wall_mm + pin_mm / 2
    if is_flex(p):
        least_hole_x = foot_half + p.printer.min_wall_mm + p.flex.thread_hole_mm / 2
    half = _up(max(half, least_hole_x + rim, placing.least_half_width_mm(config, foot_half)))
    hole_x = min(max(float(np.abs(cells.x_mm).max()), least_hole_x), half - rim)
    top, bottom = float(cells.y_mm.max()), float(cells.y_mm.min())
    reach = max(part.size_y_mm for part in chips_) / 2
    side = max(part.size_x_mm for part in chips_) / 2
    parts_top = bottom - reach - p.board.channel_mm
    depth = placing.parts_zone_depth_mm(config, muxing, 2 * half, faults)
    pad = connectors.WIDE[1]  # the emitter's few pads are wide whatever the receiver's are
    connector_y = parts_top - depth - pad / 2
    y_max = top + p.board.tip_margin_mm
    y_min = y_max - 2 * _up((y_max - (connector_y - p.board.end_margin_mm)) / 2)
    _refuse_holes(p, pad, faults)
    for field, margin, taken in (
        ("board.tip_margin_mm", p.board.tip_margin_mm, reach),
        ("board.side_margin_mm", p.board.side_margin_mm, side),
    ):
        faults.unless(
            margin >= taken + p.board.clearance_mm,
            "margin_below_parts",
            field=field,
            margin=margin,
            taken=taken,
            least=taken + p.board.clearance_mm,
        )
    x_min, x_max = float(cells.x_mm.min()), float(cells.x_mm.max())
    widest = max(-x_min, x_max) + side
    end = y_min - p.outline.end_margin_mm
    # Behind the plate the block rises at 45° from the notch; the solder tails are to stay clear.
    before_pads = max(NOTCH_BEFORE_PADS_MM, p.backing.tail_mm - p.stack.floor_mm)
    notch = Box(-notch_half, notch_half, end, connector_y + pad / 2 + before_pads)
    return Frame(
        box=Box(-half, half, y_min, y_max),
        cells=Box(-widest, widest, bottom - reach, top + reach),
        parts=Box(
            -half + placing.ZONE_MARGIN_MM,
            half - placing.ZONE_MARGIN_MM,
            parts_top - depth + p.board.channel_mm,
            parts_top,
        ),
        connector_y_mm=connector_y,
        wide=wide,
        notch=notch,
        pin_mm=pin_mm,
        rear_hole_x_mm=hole_x,
        foot_half_mm=foot_half,
    )


def _refuse_holes(p: Parameters, pad_mm: float, faults: Diagnostics) -> None:
    """Refuse holes and pads that break out of the board or into the parts."""
    radius = p.board.hole_mm / 2
    for_hole, for_pad = radius + placing.HOLE_WEB_MM, pad_mm / 2 + PAD_TO_EDGE_MM
    what = f"holes of {p.board.hole_mm:g} mm"
    faults.unless(
        p.board.end_margin_mm >= max(for_hole, for_pad) - 1e-9,
        "end_margin_small",
        what=what,
        pad_mm=pad_mm,
        least=max(for_hole, for_pad),
    )
    faults.unless(
        p.board.hole_edge_mm >= for_hole - 1e-9, "hole_near_edge", what=what, for_hole=for_hole
    )
    least = radius + placing.HOLE_CLEARANCE_MM - pad_mm / 2
    faults.unless(p.board.channel_mm >= least - 1e-9, "channel_small", what=what, least=least)


def _driving(
    config: Input, strings: Strings, frame: Frame, faults: Diagnostics
) -> tuple[tuple[Part, ...], tuple[Relief, ...]]:
    """Current sources or resistors of the strings, and the reliefs behind them."""
    if config.parameters.emitter.drive == "source":
        return source_parts(config, len(strings.cells), frame.parts, faults), ()
    room = _resistor_room(config, frame)
    return placing.resistors(config, strings, room, frame.foot_half_mm, faults)


def _resistor_room(config: Input, frame: Frame) -> Box:
    """The zone for string resistors; on the back it keeps the printer's least wall between their
    relief and the notch and pins."""
    p, zone = config.parameters, frame.parts
    if p.emitter.resistor_side == "front":
        return zone
    solid = max(frame.notch.y_max_mm, frame.connector_y_mm + frame.pin_mm / 2)
    lowest = solid + p.printer.min_wall_mm + p.backing.relief_clearance_mm
    return Box(zone.x_min_mm, zone.x_max_mm, max(zone.y_min_mm, lowest), zone.y_max_mm)


def _board(config: Input, frame: Frame) -> Board:
    fits = derive_fits(config, config.parameters.printer.fit_mm)
    return Board(
        box=frame.box,
        hole_mm=config.parameters.board.hole_mm,
        pocket=frame.box.grown(fits.pocket_gap_mm),
        roof_mm=roof_mm(config),
        pocket_clearance_mm=fits.pocket_gap_mm,
        pin_mm=fits.pin_mm,
        flexible=flexible_board(config, frame.box, frame.notch, frame.connector_y_mm),
    )


def _zones(frame: Frame) -> tuple[Zone, ...]:
    half = connectors.WIDE[1] / 2
    wires = Box(
        frame.notch.x_min_mm,
        frame.notch.x_max_mm,
        frame.connector_y_mm - half,
        frame.connector_y_mm + half,
    )
    return Zone("cells", frame.cells), Zone("parts", frame.parts), Zone("connector", wires)


def _window(wires: Connector) -> Box:
    half = wires.pad_mm / 2 + WINDOW_MARGIN_MM
    (first, y), (last, _) = wires.pads[0], wires.pads[-1]
    return Box(first - half, last + half, y - half, y + half)


def _facing(cells: Cells, held: AtCells) -> tuple[Point, ...]:
    """Facing rule: in the emitter's own frame, LED i is at (-x_i, y_i)."""
    x_mm = (held.x_sign * cells.x_mm + 0.0).tolist()
    return tuple(zip(x_mm, cells.y_mm.tolist(), strict=True))


def _flipped(parts: tuple[Part, ...]) -> tuple[Part, ...]:
    """Parts of the emitter as they face the receiver's frame."""
    return tuple(replace(part, x_mm=-part.x_mm) for part in parts)


def _up(value_mm: float) -> float:
    """Rounded up so that twice the value is a whole tenth of a millimetre."""
    return math.ceil(round(value_mm * 20, 6)) / 20
