"""Shrouds of box headers lie flat on the board: pads under one cannot be soldered after it."""

import math
from collections.abc import Iterator

import shapely

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.board_ties import lying
from lumitip_fab.checks.result import Measurement

ROOM_MM = 0.25
"""From a shroud to the pads of other parts, at least."""


def measure_shrouds(read: ReadBoard) -> Iterator[Measurement]:
    """Least room from a shroud to the pads of other parts on its face, or with a hole."""
    shrouds = {
        device.ref: lying(device.footprint.shroud.box, read.parts[device.ref])
        for device in read.components
        if device.footprint.shroud and device.ref in read.parts
    }
    front = read.board.layers[0]
    pads = [
        (part.ref, pad.copper.area)
        for part in read.board.parts
        for pad in part.terminals
        if pad.copper and (pad.drill_mm or front in pad.copper.layers)
    ]
    rooms = {
        (ref, other): float(shapely.distance(shroud, area))
        for ref, shroud in shrouds.items()
        for other, area in pads
        if other != ref
    }
    if not rooms:
        return
    nearest = min(rooms, key=lambda pair: rooms[pair])
    note = f"from the shroud of {nearest[0]} to {nearest[1]}"
    yield read.figure("shroud_room", rooms[nearest], ROOM_MM, math.inf, note=note)
