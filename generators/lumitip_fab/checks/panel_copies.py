"""The copies in a panel: each is the board, moved."""

import math
from collections import defaultdict
from collections.abc import Iterator

import numpy as np
import shapely
from shapely import affinity
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.order_layers import Holes, farthest_mm
from lumitip_fab.checks.panel_read import PanelBoard
from lumitip_fab.checks.readers.kicad_board import KicadBoard, Part
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Point
from lumitip_fab.design.panel import in_copy

AREA_MM2 = 0.01
PLACE_MM = 0.001
TURN_DEG = 0.01
_Copper = dict[tuple[str, str], BaseGeometry]
"""Area of each net on each layer."""


def measure_copper(read: PanelBoard) -> Iterator[Measurement]:
    """The copper of each net of each copy against that of the board, and copper elsewhere."""
    of_board, of_panel = _copper(read, read.single.board), _copper(read, read.board)
    worst, where = 0.0, ""
    for copy, by in enumerate(read.panel.copies, start=1):
        for (net, layer), area in of_board.items():
            if not net:
                continue
            found = of_panel.pop((in_copy(net, copy), layer), shapely.Polygon())
            off = affinity.translate(area, *by).symmetric_difference(found).area
            if off > worst:
                worst, where = off, f"{in_copy(net, copy)} on {layer}"
    note = f"differs from the board's; most at {where}" if where else "differs from the board's"
    yield read.figure("copper", worst, 0, AREA_MM2, "mm²", note)
    wanted = shapely.union_all(
        [
            affinity.translate(area, *by)
            for (net, _), area in of_board.items()
            for by in read.panel.copies
            if not net
        ]
    )
    marks = shapely.union_all(
        [read.flat(t.copper.area) for part in read.on_frame for t in part.terminals if t.copper]
    )
    other = shapely.union_all(list(of_panel.values())) - marks
    off = other.symmetric_difference(wanted).area
    yield read.figure("loose_copper", off, 0, AREA_MM2, "mm²", "without a net, or of another one")


def _copper(read: PanelBoard, board: KicadBoard) -> _Copper:
    pieces: dict[tuple[str, str], list[BaseGeometry]] = defaultdict(list)
    for piece in board.copper():
        for layer in piece.layers:
            pieces[piece.net, layer].append(piece.area)
    return {key: read.flat(shapely.union_all(areas)) for key, areas in pieces.items()}


def measure_parts(read: PanelBoard) -> Iterator[Measurement]:
    """Every part of the board once in each copy: its place, angle, side, footprint and value."""
    found = {part.ref: part for part in read.board.parts if _has_copper(part)}
    wrong = []
    for copy, by in enumerate(read.panel.copies, start=1):
        for part in (part for part in read.single.board.parts if _has_copper(part)):
            ref = in_copy(part.ref, copy)
            if not _same(read, part, found.pop(ref, None), by):
                wrong.append(ref)
    marks = {part.ref for part in read.on_frame if part.footprint.startswith("Fiducial")}
    wrong += sorted(found.keys() - marks)
    refs = [part.ref for part in read.board.parts]
    wrong += sorted({ref for ref in refs if refs.count(ref) > 1})
    yield read.count("parts", wrong, "parts")


def _same(read: PanelBoard, part: Part, copy: Part | None, by: Point) -> bool:
    """Whether a part of a copy is that of the board, moved."""
    if copy is None:
        return False
    off = math.dist(np.add(read.at(part.at), by), read.at(copy.at))
    turn = abs((part.angle_deg - copy.angle_deg + 180) % 360 - 180)
    alike = all(
        getattr(part, name) == getattr(copy, name)
        for name in ("value", "footprint", "front", "attributes", "models")
    )
    return alike and off <= PLACE_MM and turn <= TURN_DEG


def _has_copper(part: Part) -> bool:
    return any(terminal.copper is not None for terminal in part.terminals)


def measure_holes(read: PanelBoard) -> Iterator[Measurement]:
    """The unplated holes of the board in each copy; all others are mouse bites or on the frame."""
    frame = {id(t) for part in read.on_frame for t in part.terminals}
    frame |= {id(hole) for hole in read.bites}
    found: Holes = [(*read.at(h.at), h.drill_mm) for h in read.holes if id(h) not in frame]
    wanted: Holes = [
        (x + by_x, y + by_y, hole.drill_mm)
        for by_x, by_y in read.panel.copies
        for hole in read.single.holes
        for x, y in (read.at(hole.at),)
    ]
    off = farthest_mm(found, wanted) if found or wanted else 0.0
    yield read.figure("holes", off, 0, PLACE_MM, note=f"worst of {len(wanted)} of the copies")
