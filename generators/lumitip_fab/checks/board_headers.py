"""Box headers: room round the shroud, and the contacts that a ribbon cable's socket meets."""

import math
from collections.abc import Iterator

import numpy as np
import shapely

from lumitip_fab.checks.board_read import ReadBoard, lands
from lumitip_fab.checks.board_ties import lying
from lumitip_fab.checks.readers.kicad_board import Part
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Box

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
        (part.ref, copper.area)
        for part, pad, copper in lands(read.board)
        if pad.drill_mm or front in copper.layers
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


def measure_sockets(read: ReadBoard) -> Iterator[Measurement]:
    """Whether every contact of the socket on a ribbon cable meets the pad of its number.

    Contact 1 of a socket is away from the cable's way out, at the left of one who looks along it;
    contact 2 is before it, and so on across both rows, as IDC-Header_2x07_P2.54mm_Horizontal of
    KiCad's libraries has it.
    """
    shrouds = {
        device.ref: device.footprint.shroud.box
        for device in read.components
        if device.footprint.shroud and device.ref in read.parts
    }
    if shrouds:
        wrong = [
            f"{ref}.{number}"
            for ref, box in shrouds.items()
            for number in _misplaced(box, read.parts[ref])
        ]
        yield read.count("socket_contacts", wrong, "pads")


def _misplaced(shroud: Box, part: Part) -> list[str]:
    """Numbers of the pads that another contact of the socket meets than the one of that number."""
    places = {terminal.number: np.array(terminal.at) for terminal in part.terminals}
    out = np.array(lying(shroud, part).centroid.coords[0]) - np.mean(list(places.values()), axis=0)
    out /= np.hypot(*out)
    right = np.array([-out[1], out[0]])  # of one who looks along the cable; the page is y down

    def column_and_row(number: str) -> tuple[float, float]:
        return round(float(places[number] @ right), 2), round(float(places[number] @ out), 2)

    contacts = enumerate(sorted(places, key=column_and_row), start=1)
    return [number for contact, number in contacts if number != str(contact)]
