"""Holes through the plate beside the board, which the silicone fills: they lock the skin.

They stand in rows where the plate has room: along the tip, down both sides, and at the gripper end.
A hole has a countersink in the back, as deep as fits there. Where nothing fits, there is none.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from lumitip_fab.config.load import Input
from lumitip_fab.derive.finger.strength import Body
from lumitip_fab.design import Box, Key, Mould, Point

SINKS_MM = (0.8, 0.6, 0.4)
LAND_MM = 0.5  # of the hole before its countersink
SPACING_MM = 7.0  # in a row
LEAST_APART_MM = 6.0
MARGIN_MM = 0.15  # over the thinnest wall
ROUND_BLOCK_MM = 1.0  # free beside the coupling
UNDER_FOOT_MM = 2.0  # from the middle of a stop
STEEPEST = 0.6  # wedge into which a countersink is cut
STEP_MM = 0.25

Region = Any
"""A shapely geometry: where the middle of a hole may be."""


def derive_keys(config: Input, body: Body, mould: Mould) -> tuple[Key, ...]:
    """The keys of a finger, alike on both sides of x = 0; none where none fits."""
    hole = config.parameters.backing.key_mm
    if not hole:
        return ()
    wall = config.parameters.printer.min_wall_mm + MARGIN_MM
    rooms = {sink: _room(body, mould, hole, sink, wall) for sink in SINKS_MM}
    keys: list[Key] = []
    for at in _rows(rooms[SINKS_MM[-1]], body):
        if all(math.dist(at, other.at) >= LEAST_APART_MM for other in keys):
            keys.append(Key(at, hole, _deepest(rooms, at)))
    return tuple(keys)


def _deepest(rooms: dict[float, Region], at: Point) -> float:
    import shapely

    point = shapely.Point(at)
    return next((s for s, room in rooms.items() if room.covers(point)), SINKS_MM[-1])


def _room(body: Body, mould: Mould, hole_mm: float, sink_mm: float, wall_mm: float) -> Region:
    """Where a hole fits with walls all round, on the plate and on its wedge."""
    import shapely

    tip, radius = body.tip, hole_mm / 2
    thin = body.stack.plate_mm - sink_mm - LAND_MM  # what the wedge may take
    if thin < 0:
        return shapely.Polygon()
    skin = shapely.Polygon(body.outline.polygon())
    left, low, right, high = skin.bounds
    across = radius + sink_mm
    leant = across / (1 - min(tip.slope, STEEPEST))  # on the wedge, towards the board
    if tip.slope > STEEPEST:
        high = tip.slant_start_y_mm - leant
    elif tip.slope > 0:
        high = tip.slant_start_y_mm + thin / tip.slope
    room = skin.buffer(-(across + wall_mm)) & shapely.box(left, low, right, max(high, low))
    taken = [
        *_in_front(body, mould, radius + wall_mm),
        *(_kept_off(box, across + wall_mm, leant + wall_mm) for box in _behind(body, mould)),
    ]
    return room - shapely.union_all([shapely.box(*box.bounds_mm) for box in taken])


def _kept_off(box: Box, aside_mm: float, above_mm: float) -> Box:
    """A box grown by what a countersink needs beside it, and more where a wedge follows."""
    return replace(box.grown(aside_mm), y_max_mm=box.y_max_mm + above_mm)


def _in_front(body: Body, mould: Mould, reach_mm: float) -> Iterator[Box]:
    """Pocket or board, wire notch and the mould's stops, grown by what a hole needs."""
    board, outline = body.board, body.outline
    pocket = board.pocket if body.stack.sunk else board.box
    yield replace(pocket, y_max_mm=pocket.y_max_mm + board.roof_mm).grown(reach_mm)
    yield replace(body.finger.notch, y_min_mm=outline.end_y_mm).grown(reach_mm)
    half, far = mould.pad_mm / 2, outline.tip_width_mm + outline.end_width_mm
    for x, y in mould.pads:
        left, right = (x - half, far) if x > 0 else (-far, x + half)
        yield Box(left, right, y - half, y + half).grown(reach_mm)


def _behind(body: Body, mould: Mould) -> Iterator[Box]:
    """What stands on the plate's back, or is sunk into it; a clamp's feet, behind the stops."""
    stack, mount, outline = body.stack, body.mount, body.outline
    end_y = outline.end_y_mm
    half = mount.block_width_mm / 2 + max((lug.out_mm for lug in mount.lugs), default=0.0)
    high = mount.ramp_end_y_mm(stack.back_z_mm, stack.rim_z_mm) + mount.flare_mm
    yield Box(-half, half, end_y, max(high, end_y)).grown(ROUND_BLOCK_MM)
    yield replace(body.finger.notch, y_min_mm=end_y)
    yield from (Box(x, x, y, y).grown(UNDER_FOOT_MM) for x, y in mould.pads)
    yield from body.tip.slots
    if stack.sunk:
        yield body.board.pocket
    yield from (interface.groove.grown(ROUND_BLOCK_MM) for interface in body.interfaces)


def _rows(room: Region, body: Body) -> Iterator[Point]:
    """Middles of the holes: along the tip, down the sides, at the gripper end."""
    import shapely

    box, outline = body.board.box, body.outline
    beside = box.x_max_mm
    far = float(np.abs(outline.polygon()).max())
    at_tip = shapely.clip_by_rect(room, -beside, box.y_max_mm, beside, outline.tip_y_mm)
    for x, (low, _) in _spread(at_tip, far, along_x=True):
        yield x, low  # near the board, where the wedge is thick
    at_side = shapely.clip_by_rect(room, beside, outline.end_y_mm, far, outline.tip_y_mm)
    for y, (low, high) in _spread(at_side, far, along_x=False):
        yield from (((low + high) / 2, y), (-(low + high) / 2, y))
    at_end = shapely.clip_by_rect(room, 0.0, outline.end_y_mm, beside, box.y_min_mm)
    for x, (low, high) in _spread(at_end, far, along_x=True):
        yield from ((x, (low + high) / 2), (-x, (low + high) / 2))


def _spread(
    room: Region, far_mm: float, along_x: bool
) -> Iterator[tuple[float, tuple[float, float]]]:
    """Places along x, or else along y, spread evenly over each stretch of the room, with the ends
    of the room there in the other direction."""
    steps = math.ceil(far_mm / STEP_MM)
    stretch: list[tuple[float, tuple[float, float]]] = []
    for k in range(-steps, steps + 2):
        ends = _across(room, k * STEP_MM, far_mm, along_x) if k <= steps else None
        if ends is not None:
            stretch.append((k * STEP_MM, ends))
            continue
        if stretch:
            last = len(stretch) - 1
            count = 1 + math.floor(last * STEP_MM / SPACING_MM)
            shares = [0.5] if count == 1 else [i / (count - 1) for i in range(count)]
            yield from (stretch[round(share * last)] for share in shares)
        stretch = []


def _across(room: Region, at_mm: float, far_mm: float, along_x: bool) -> tuple[float, float] | None:
    """Ends of the first piece of a line across the room, to the micrometre; None outside it."""
    import shapely

    ends = [(at_mm, -far_mm), (at_mm, far_mm)]
    line = shapely.LineString(ends if along_x else [(y, x) for x, y in ends])
    pieces = [p.bounds for p in shapely.get_parts(line & room) if p.length > 0]
    if not pieces:
        return None
    low, high = min((b[along_x], b[2 + along_x]) for b in pieces)
    return round(low, 3), round(high, 3)
