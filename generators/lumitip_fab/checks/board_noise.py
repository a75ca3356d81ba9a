"""Copper against noise: vias beside capacitors, a crystal away from what a regulator switches."""

import math
from collections.abc import Iterator

import shapely

from lumitip_fab.checks.board_read import ReadBoard, lands, on_page
from lumitip_fab.checks.readers.kicad_board import Copper
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design.board_rules import rules_of

VIA_MM = 1.0  # from the edge of a capacitor's ground pad to the middle of a via, at most
CRYSTAL_MM = 2.0
"""From the crystal's copper to that which a regulator switches: more than the board's thickness,
beyond which the ground on its back takes most of the field; assumed."""
_GRID_MM = 0.1  # that room for a via is wide at least, on each side: routers have a grid


def measure_bypass_vias(read: ReadBoard) -> Iterator[Measurement]:
    """From each soldered ground pad of a capacitor to the nearest via of its net, where there is
    room for one."""
    vias = [(c, shapely.centroid(c.area)) for c in read.board.loose if c.kind == "via"]
    away: dict[str, float] = {}
    for part, terminal, pad in lands(read.board):
        if part.ref.startswith("C") and terminal.net == "GND" and not terminal.drill_mm:
            group = read.clusters.of(pad)
            near = [pad.area.distance(at) for via, at in vias if read.clusters.of(via) == group]
            least = min(near, default=math.inf)
            if least <= VIA_MM or _has_room(read, pad):
                away[f"{part.ref}.{terminal.number}"] = least
    if away:
        worst = max(away, key=lambda name: away[name])
        yield read.figure("bypass_via", away[worst], 0, VIA_MM, note=f"to a via, at {worst}")


def _has_room(read: ReadBoard, pad: Copper) -> bool:
    """Whether a via of ground could be near a pad: clear of other nets, pads, holes and edge."""
    rules = rules_of(read.design, read.name)
    half = rules.via_mm / 2
    pads = {id(c) for layer in read.board.layers for *_, c in lands(read.board, layer)}
    taken = [
        copper.area.buffer(half + rules.copper_gap_mm)
        for copper in read.board.copper()
        if copper.net != "GND" or id(copper) in pads or copper.kind == "via"
    ]
    taken += [
        shapely.Point(h.at).buffer(h.drill_mm / 2 + half + rules.hole_gap_mm) for h in read.holes
    ]
    taken += [area.buffer(half) for area in read.board.keep_outs]
    if read.flexible:
        taken.append(on_page(read.flexible.bend).buffer(half))
    inside = read.outline.buffer(-half - rules.edge_gap_mm)
    free = pad.area.buffer(VIA_MM).intersection(inside).difference(shapely.union_all(taken))
    return not free.buffer(-_GRID_MM).is_empty


def measure_crystal(read: ReadBoard) -> Iterator[Measurement]:
    """How far a crystal is from what a regulator switches, copper to copper."""
    parts = [(d.kind, {net for _, net in d.nets}) for d in read.components]
    quiet, coil, smoothed = (
        set().union(*(nets for kind, nets in parts if kind == wanted and among <= nets))
        for wanted, among in (("crystal", set()), ("inductor", set()), ("capacitor", {"GND"}))
    )
    if not quiet:
        return
    switched = coil - smoothed
    # What a capacitor joins to it, as the supply of the upper switch, moves with it.
    switched |= set().union(
        *(nets for kind, nets in parts if kind == "capacitor" and nets & switched)
    )
    areas = [
        shapely.union_all([c.area for c in read.board.copper() if c.net in of])
        for of in (quiet, switched)
    ]
    yield read.figure("crystal", areas[0].distance(areas[1]), CRYSTAL_MM, math.inf)
