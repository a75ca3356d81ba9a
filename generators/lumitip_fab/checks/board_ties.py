"""Strain relief of the cables: two holes for a thread beside a row of wire pads."""

import math
from collections.abc import Iterator

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import affinity
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.readers.kicad_board import Part
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Box, Finger

PLACE_MM = 0.01
REACH_MM = 4.5
"""From a hole to the nearest pad of its row, at most: the thread is to hold that row's wires."""
PART_GAP_MM = 0.25
"""From a hole to the body of a part, at least."""
LETTER = 0.6
"""Width of a letter at least, of its height."""
_ROUND_MM = 1e-3


def measure_ties(read: ReadBoard) -> Iterator[Measurement]:
    """The holes beside every row of wire pads that a cable ends at."""
    if read.finger is None:
        rows = [d.ref for d in read.components if d.kind == "wires" and d.pins]
        yield from _measured(read, rows, list(bodies_of(read)))
        return
    yield from _measured(read, [tie.ref for tie in read.ties], [])
    if read.ties:
        yield from _in_finger(read, read.finger)


def _in_finger(read: ReadBoard, finger: Finger) -> Iterator[Measurement]:
    """The plate and the film are open at the holes, and no part is there."""
    places = shapely.points(read.sensor([hole.at for hole in read.threads]))
    holes = [(at, hole.drill_mm / 2) for hole, at in zip(read.threads, places, strict=True)]
    for name, box in (("notch", finger.notch), ("window", finger.window)):
        inside = shapely.box(*box.bounds_mm)
        room = [
            float(inside.exterior.distance(at)) - radius if inside.contains(at) else -math.inf
            for at, radius in holes
        ]
        yield read.figure(f"tie_{name}", min(room, default=-math.inf), 0, math.inf)
    parts = [shapely.box(*part.box.bounds_mm) for part in finger.parts]
    discs = [at.buffer(radius) for at, radius in holes]
    yield read.figure("tie_parts", _least_mm(discs, parts), PART_GAP_MM, math.inf)


def _measured(
    read: ReadBoard, rows: list[str], bodies: list[BaseGeometry]
) -> Iterator[Measurement]:
    """How many holes there are for threads, where, how wide, and what is beside them."""
    yield read.figure("tie_count", len(read.threads), 2 * len(rows), 2 * len(rows), "holes")
    if not rows:
        return
    found = read.sensor([hole.at for hole in read.threads])
    wanted = np.array([at for tie in read.ties for at in tie.holes])
    apart = np.hypot(*(wanted[:, None] - found[None]).transpose(2, 0, 1))
    off = apart.min(axis=1).max() if found.size else math.nan
    yield read.figure("ties", off, 0, PLACE_MM, note="from the design")
    first = read.ties[0]
    wide = max((abs(hole.drill_mm - first.hole_mm) for hole in read.threads), default=math.nan)
    yield read.figure("tie_width", wide, 0, PLACE_MM, note="from the design")
    far = {ref: _reach_mm(read.sensor(_pads(read.parts.get(ref))), found) for ref in rows}
    worst = max(rows, key=lambda ref: math.inf if math.isnan(far[ref]) else far[ref])
    yield read.figure("tie_reach", far[worst], 0, REACH_MM, note=f"worst at {worst}")
    discs = [shapely.Point(h.at).buffer(h.drill_mm / 2, quad_segs=32) for h in read.threads]
    yield read.figure("tie_edge", _edge_mm(read, discs), first.web_mm - _ROUND_MM, math.inf)
    if bodies:
        yield read.figure("tie_parts", _least_mm(discs, bodies), PART_GAP_MM, math.inf)
    least = read.design.rules.silk_gap_mm - _ROUND_MM
    yield read.figure("tie_silk", _least_mm(discs, [*_printed(read)]), least, math.inf)


def _pads(part: Part | None) -> list[tuple[float, float]]:
    return [terminal.at for terminal in part.terminals] if part else []


def _reach_mm(pads: NDArray[np.float64], holes: NDArray[np.float64]) -> float:
    """From the second nearest hole to a row's pads; not a number with fewer holes or no pads."""
    if len(holes) < 2 or not len(pads):
        return math.nan
    apart = np.hypot(*(holes[:, None] - pads[None]).transpose(2, 0, 1)).min(axis=1)
    return float(np.sort(apart)[1])


def _edge_mm(read: ReadBoard, discs: list[BaseGeometry]) -> float:
    """Least board between a hole and the edge; negative where one lies across it."""
    if not all(read.outline.contains(disc) for disc in discs):
        return -math.inf
    return min((float(read.outline.boundary.distance(disc)) for disc in discs), default=math.nan)


def _printed(read: ReadBoard) -> Iterator[BaseGeometry]:
    """Silkscreen of both sides; of a text a rectangle within it."""
    yield from (line.area for line in read.board.silk.lines)
    for word in read.board.silk.words:
        half = len(word.text) * LETTER * word.height_mm / 2, word.height_mm / 2
        flat = shapely.box(-half[0], -half[1], *half)
        turned = affinity.rotate(flat, -word.angle_deg, origin=(0, 0))
        yield affinity.translate(turned, *word.at)


def bodies_of(read: ReadBoard) -> Iterator[BaseGeometry]:
    """Bodies and shrouds, of the catalogue's sizes, where the file has the parts; on the page."""
    for device in read.components:
        part, shape = read.parts.get(device.ref), device.footprint
        if part is None or not shape.height_mm:
            continue
        for box in (shape.body, *([shape.shroud.box] if shape.shroud else [])):
            yield lying(box, part)


def lying(box: Box, part: Part) -> BaseGeometry:
    """A rectangle of a footprint's frame where the file has the part; on the page, y down."""
    flat = affinity.scale(shapely.box(*box.bounds_mm), 1.0, -1.0, origin=(0, 0))
    turned = affinity.rotate(flat, -part.angle_deg, origin=(0, 0))
    return affinity.translate(turned, *part.at)


def _least_mm(discs: list[BaseGeometry], others: list[BaseGeometry]) -> float:
    """Least distance from a hole to any of these; infinite where there is none."""
    if not discs:
        return math.nan
    tree = shapely.union_all(others)
    return min(float(tree.distance(disc)) for disc in discs) if others else math.inf
