"""Thermal reliefs of the ground pour, as KiCad's default rules ask for them."""

from collections.abc import Iterator, Sequence

import shapely
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.readers.kicad_board import Copper
from lumitip_fab.checks.result import Measurement

LEAST_SPOKES = 2
"""Default of `min_resolved_spokes` of KiCad 6 to 10."""
_BESIDE_MM = 0.1  # from the pad, inside its thermal gap
_SOLID = 0.6  # of a pad's area, which the pour covers where it joins the pad all round


def measure_spokes(read: ReadBoard) -> Iterator[Measurement]:
    """Pads that the pour joins with too few spokes; those to a piece that leads nowhere do not
    count."""
    found = [fault for layer in read.board.layers for fault in _starved(read, layer)]
    yield read.count("spokes", found, "pads")


def _starved(read: ReadBoard, layer: str) -> Iterator[str]:
    here = [piece for piece in read.board.loose if layer in piece.layers and piece.net == "GND"]
    fills = [piece.area for piece in here if piece.kind == "fill"]
    others = [piece.area for piece in here if piece.kind != "fill"]
    pads = [
        (f"{part.ref}.{terminal.number}", terminal.copper)
        for part in read.board.parts
        for terminal in part.terminals
        if terminal.copper and terminal.net == "GND" and layer in terminal.copper.layers
    ]
    through = [fill for fill in fills if _leads_on(fill, others, [pad for _, pad in pads])]
    for name, pad in pads:
        near = [fill for fill in fills if fill.intersects(pad.area)]
        if (
            not near
            or sum(fill.intersection(pad.area).area for fill in near) > _SOLID * pad.area.area
        ):
            continue
        spokes = sum(_spokes(fill, pad) for fill in near if fill in through)
        if spokes < LEAST_SPOKES:
            yield f"{name} has {spokes} on {layer}"


def _leads_on(fill: BaseGeometry, others: Sequence[BaseGeometry], pads: Sequence[Copper]) -> bool:
    """Whether a piece of pour joins more than a single pad."""
    if any(bool(fill.intersects(other)) for other in others):
        return True
    return sum(bool(fill.intersects(pad.area)) for pad in pads) > 1


def _spokes(fill: BaseGeometry, pad: Copper) -> int:
    ring = pad.area.buffer(_BESIDE_MM).boundary
    crossed = shapely.line_merge(shapely.intersection(ring, fill))
    pieces = [part for part in shapely.get_parts(crossed) if part.length > 0]
    if len(pieces) > 1:  # a ring begins somewhere, and a spoke may stand there
        start, end = ring.coords[0], ring.coords[-1]
        touching = [p for p in pieces if p.distance(shapely.Point(start)) < 1e-9]
        if start == end and len(touching) > 1:
            return len(pieces) - 1
    return len(pieces)
