"""Placement of parts at the cells and in the zone for parts, and of the locating holes."""

import math

import numpy as np

from lumitip_fab.catalogue.electronics import Chip
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.sources import group_mm
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.cells import Cells
from lumitip_fab.derive.finger.stack import is_flex
from lumitip_fab.derive.wiring.strings import Strings
from lumitip_fab.derive.wiring.wiring import Muxing
from lumitip_fab.design import AtCells, Box, Part, Point, Relief, pull_ups

HOLE_CLEARANCE_MM = 0.25
HOLE_WEB_MM = 0.5  # board left between a hole and its edge
HOLES_APART_MM = 0.4  # board left between two holes
RELIEF_DEPTH_MM = 0.2  # below the part
ROW_GAP_MM = 1.6
"""Between two rows of string resistors, where there is room: for vias and tracks to the lower."""
RESISTOR_GAP_MM = 0.6
ZONE_MARGIN_MM = 1.0  # zone for parts to the board's long edges
COUPLING_GAP_MM = 2.0  # mounting block to a relief


def at_cells(held: AtCells, chip: Chip, turned: bool, cells: tuple[Point, ...]) -> tuple[Part, ...]:
    """One part at each cell, named in frame order: D1 or Q1 is cell 0."""
    along, across = chip.over_pads_mm
    size = (across, along) if turned else (along, across)
    return tuple(
        Part(held.ref(i), held.kind, x, y, *size, chip.body_mm[2], "front")
        for i, (x, y) in enumerate(cells)
    )


def parts_zone_depth_mm(
    config: Input, muxing: Muxing, width_mm: float, faults: Diagnostics
) -> float:
    """Depth of the zone for parts with a channel after each row of multiplexers."""
    p = config.parameters
    mux = config.parts.receiver.multiplexer
    per_row = _per_row(config, width_mm)
    _refuse_tall(config, faults)
    if per_row < 1:
        faults.add("board_narrow", width_mm=width_mm, needed_mm=_slot_mm(config) + 2)
        per_row = 1
    rows = math.ceil(muxing.muxes / per_row)
    return rows * (mux.lead_span_mm + p.board.channel_mm)


def _refuse_tall(config: Input, faults: Diagnostics) -> None:
    """Refuse parts that are longer than the multiplexer that they stand beside."""
    p, mux = config.parameters, config.parts.receiver.multiplexer
    room = f"mm beside a multiplexer; {mux.lead_span_mm:g} mm is available"
    if p.receiver.load == "each":
        array = config.parts.receiver.array
        most = pull_ups.MOST_COLUMNS * 2 * array.resistors
        faults.unless(mux.channels <= most, "too_many_pull_ups", most=most, mux=mux)
        tall = 2 * array.over_pads_mm[0] + p.board.clearance_mm
        faults.unless(tall <= mux.lead_span_mm, "arrays_long", tall=tall, room=room)
        return
    tall = sum(chip.over_pads_mm[0] for chip in _passives(config)) + p.board.clearance_mm
    faults.unless(tall <= mux.lead_span_mm, "pull_up_long", tall=tall, mux=mux)


def multiplexers(config: Input, muxing: Muxing, zone: Box) -> tuple[Part, ...]:
    """Multiplexers in rows across the zone, evenly spread, U1 at the upper left.

    Capacitor and shared pull-up stand to the left of each, where supply and output leads are.
    """
    p = config.parameters
    mux = config.parts.receiver.multiplexer
    left, right = _beside_mm(config)
    per_row = max(_per_row(config, zone.width_mm + 2), 1)
    rows = np.array_split(np.arange(muxing.muxes), math.ceil(muxing.muxes / per_row))
    parts = []
    for r, row in enumerate(rows):
        y = zone.y_max_mm - mux.lead_span_mm / 2 - r * (mux.lead_span_mm + p.board.channel_mm)
        for k, which in enumerate(row):
            slot = zone.width_mm / row.size
            x = zone.x_min_mm + slot * (k + 0.5)
            side = (slot - mux.body_mm[0]) / 2
            x += max(0.0, round(left - side, 9)) - max(0.0, round(right - side, 9))
            name = f"U{which + 1}"
            size = (mux.body_mm[0], mux.lead_span_mm)
            parts.append(Part(name, "multiplexer", x, y, *size, mux.body_mm[2], "front"))
    return tuple(parts)


def _slot_mm(config: Input) -> float:
    left, right = _beside_mm(config)
    gap = config.parameters.board.clearance_mm
    return config.parts.receiver.multiplexer.body_mm[0] + left + right + gap


def _beside_mm(config: Input) -> tuple[float, float]:
    """Room to the left and to the right of a multiplexer for the parts beside it."""
    p, parts = config.parameters, config.parts.receiver
    gap = p.board.clearance_mm
    left = max(chip.over_pads_mm[1] for chip in _passives(config)) + gap
    if p.receiver.load != "each":
        return left, 0.0
    column = parts.array.over_pads_mm[1] + gap
    columns = pull_ups.columns_of_arrays(parts.multiplexer, parts.array)
    return left + (columns - 1) * column, column


def _passives(config: Input) -> tuple[Chip, ...]:
    """Capacitor and shared pull-up, which stand upright beside each multiplexer."""
    p, parts = config.parameters, config.parts.receiver
    if p.receiver.load == "each":
        return (parts.capacitor,)
    return parts.capacitor, parts.resistor


def _per_row(config: Input, width_mm: float) -> int:
    return int((width_mm - 2) / _slot_mm(config) + 1e-9)


def tip_holes(
    config: Input, cells: Cells, parts: tuple[Part, ...], box: Box, faults: Diagnostics
) -> tuple[Point, ...]:
    """Holes ahead of the first row: outermost and middle of the columns that leave room, or near
    the long edges where fewer than two columns do.

    Args:
        config: the input.
        cells: the cells.
        parts: parts at the cells of both fingers, in the receiver's frame.
        box: the board.
        faults: where to refuse.
    """
    p = config.parameters
    y = box.y_max_mm - p.board.hole_edge_mm
    keep = p.board.hole_mm / 2 + HOLE_CLEARANCE_MM
    apart = p.board.hole_mm + HOLES_APART_MM
    farthest = box.x_max_mm - p.board.hole_mm / 2 - HOLE_WEB_MM
    boxes = np.array(
        [(b.x_min_mm, b.x_max_mm, b.y_min_mm, b.y_max_mm) for b in (q.box for q in parts)]
    )

    def with_room(places: list[float]) -> list[float]:
        x = np.array(places)
        dx = np.maximum(np.maximum(boxes[:, :1] - x, x - boxes[:, 1:2]), 0)
        dy = np.maximum(np.maximum(boxes[:, 2:3] - y, y - boxes[:, 3:]), 0)
        free = (np.hypot(dx, dy).min(axis=0) >= keep) & (np.abs(x) <= farthest + 1e-9)
        return [float(place) for place in x[free]]

    columns = sorted({round(float(v), 6) for v in cells.x_mm})
    room = with_room(columns)
    if not _spans(room, apart):
        edge = math.floor(farthest * 10) / 10
        room = with_room(sorted({-edge, *columns, edge}))
    if not _spans(room, apart):
        top = max(float(b[3]) for b in boxes)
        least = p.board.hole_edge_mm + keep + top - float(cells.y_mm.max())
        faults.add("tip_holes_collide", least=least)
        return ()
    middle = min(room, key=lambda x: abs(x - (room[0] + room[-1]) / 2))
    if min(middle - room[0], room[-1] - middle) < apart:
        middle = room[0]
    return tuple((x, y) for x in sorted({room[0], middle, room[-1]}))


def _spans(room: list[float], apart_mm: float) -> bool:
    """Whether two holes have room, one at each end of the places."""
    return bool(room) and room[-1] - room[0] >= apart_mm


def resistors(
    config: Input, strings: Strings, zone: Box, foot_half_mm: float, faults: Diagnostics
) -> tuple[tuple[Part, ...], tuple[Relief, ...]]:
    """String resistors in two banks beside the coupling, and the reliefs behind them.

    R1 is rightmost, because the strings begin with column 0, which is on the emitter's right. Where
    a bank has several rows, neighbouring strings have resistors one below the other, so that their
    tracks need not cross.
    """
    p = config.parameters
    chip = config.parts.emitter.resistor
    along, across = chip.over_pads_mm
    inner = _inner_mm(config, foot_half_mm)
    outer = zone.x_max_mm - p.backing.relief_clearance_mm
    step_x, step_y = across + RESISTOR_GAP_MM, along + RESISTOR_GAP_MM
    across_bank = int((outer - inner + RESISTOR_GAP_MM) / step_x + 1e-9)
    count = len(strings.cells)
    rows = math.ceil(math.ceil(count / 2) / max(across_bank, 1))
    if across_bank < 1 or rows * step_y > zone.length_mm:
        faults.refuse(
            "emitter.resistor",
            f"is {p.emitter.resistor!r}; {count} string resistors do not fit into two "
            f"banks of {outer - inner:.1f} x {zone.length_mm:.1f} mm"
            + (" beside the coupling" if p.emitter.resistor_side == "back" else "")
            + ". Use a smaller package, the other emitter.resistor_side, or a larger "
            "board.channel_mm.",
        )
        return (), ()
    if rows > 1:
        step_y = min(along + ROW_GAP_MM, zone.length_mm / rows)
    parts: list[Part] = []
    reliefs: list[Relief] = []
    for side, in_bank in ((1, math.ceil(count / 2)), (-1, count // 2)):
        places = [
            (
                side * (inner + outer) / 2 - (k - (row.size - 1) / 2) * step_x,
                zone.centre_mm[1] + ((rows - 1) / 2 - r) * step_y,
            )
            for r, row in enumerate(np.array_split(np.arange(in_bank), rows))
            for k in range(row.size)
        ]
        bank = [
            Part(
                name=f"R{number}",
                kind="resistor",
                x_mm=x_mm,
                y_mm=y_mm,
                size_x_mm=across,
                size_y_mm=along,
                height_mm=chip.body_mm[2],
                side=p.emitter.resistor_side,
            )
            for number, (x_mm, y_mm) in enumerate(
                sorted(places, key=lambda at: (-at[0], -at[1])), start=len(parts) + 1
            )
        ]
        parts += bank
        if bank and p.emitter.resistor_side == "back":
            reliefs.append(_relief(config, bank, chip.body_mm[2]))
    return tuple(parts), tuple(reliefs)


def least_half_width_mm(config: Input, foot_half_mm: float) -> float:
    """Half the board's width that takes one string resistor on each side of the coupling, or a
    current source with its resistors."""
    p = config.parameters
    if p.emitter.drive == "source":
        return group_mm(config)[0] / 2 + ZONE_MARGIN_MM
    _, across = config.parts.emitter.resistor.over_pads_mm
    return _inner_mm(config, foot_half_mm) + across + p.backing.relief_clearance_mm + ZONE_MARGIN_MM


def _inner_mm(config: Input, foot_half_mm: float) -> float:
    """Inner end of the banks of string resistors: behind the board, beside the coupling."""
    p = config.parameters
    if p.emitter.resistor_side == "front":
        return RESISTOR_GAP_MM / 2
    return foot_half_mm + COUPLING_GAP_MM + p.backing.relief_clearance_mm


def _relief(config: Input, bank: list[Part], height_mm: float) -> Relief:
    p = config.parameters
    boxes = [part.box for part in bank]
    box = Box(
        min(b.x_min_mm for b in boxes),
        max(b.x_max_mm for b in boxes),
        min(b.y_min_mm for b in boxes),
        max(b.y_max_mm for b in boxes),
    ).grown(p.backing.relief_clearance_mm)
    depth = height_mm + RELIEF_DEPTH_MM
    # A plate that is printed face down must not hang over.
    through = is_flex(p) or p.stack.floor_mm - depth < p.printer.min_wall_mm
    return Relief(box, p.stack.floor_mm if through else depth, through)
