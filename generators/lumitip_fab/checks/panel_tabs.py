"""Tabs of a panel and their mouse bites."""

import itertools
import math
from collections.abc import Iterator

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board import as_it_lies, footprints_of
from lumitip_fab.checks.panel_read import PanelBoard
from lumitip_fab.checks.readers.kicad_board import Terminal
from lumitip_fab.checks.result import Measurement

NOISE_MM = 0.005  # of chords, and of edges that are drawn to 1 nm
WEB_MOST = 1.5
"""Widest web, by the narrowest that a fab asks for: a wider one tears."""
_REACH_MM = 1.0  # holes nearer to a tab's edge are of its mouse bite


def measure_tabs(read: PanelBoard) -> Iterator[Measurement]:
    """The copies are whole; each is held at its left and right edge, and nowhere else."""
    cut = shapely.union_all(list(read.copies)) - read.body
    yield read.figure("copies", cut.area, 0, NOISE_MM, "mm²", "of them routed away")
    wanted, wrong = read.panel.tabs, []
    for number, (copy, contacts) in enumerate(
        zip(read.copies, read.contacts, strict=True), start=1
    ):
        left, _, right, _ = copy.bounds
        held = [_at_x(line) for line in contacts]
        for edge, x in (("left", left), ("right", right)):
            count = sum(abs(at - x) < NOISE_MM for at in held)
            if count != wanted:
                wrong.append(f"copy {number}, {edge} edge: {count} instead of {wanted}")
        if len(held) != 2 * wanted:
            wrong.append(f"copy {number}: {len(held)} in all instead of {2 * wanted}")
    yield read.count("tabs", wrong, "edges with too many or too few")


def _at_x(line: BaseGeometry) -> float:
    """Where an upright line is along x; NaN of any other line."""
    left, _, right, _ = line.bounds
    return float(left) if right - left < NOISE_MM else math.nan


def measure_room(read: PanelBoard) -> Iterator[Measurement]:
    """Tabs and mouse bites to copper; tabs to mounted parts, which may reach over an edge, and to
    pads for wires and holes of the copies."""
    tabs = shapely.union_all(list(read.tabs))
    holes = [_disc(read, hole) for hole in read.bites]
    copper = shapely.union_all([read.flat(piece.area) for piece in read.board.copper()])
    near = _apart_mm(shapely.union_all([tabs, *holes]), copper)
    yield read.figure("tab_copper", near, read.rules.copper_mm - NOISE_MM, math.inf)
    away = _apart_mm(tabs, _mounted(read))
    yield read.figure("tab_parts", away, read.rules.part_mm - NOISE_MM, math.inf)
    away = _apart_mm(tabs, _lands(read))
    yield read.figure("tab_pads", away, read.rules.pad_mm - NOISE_MM, math.inf)


def _apart_mm(tabs: BaseGeometry, others: BaseGeometry) -> float:
    """Distance of tabs from what a board may lack; NaN without tabs."""
    return math.inf if others.is_empty else float(shapely.distance(tabs, others))


def _mounted(read: PanelBoard) -> BaseGeometry:
    """Bodies and pads of mounted parts."""
    shapes = footprints_of(read.single)
    found = []
    for part in (p for p in read.board.parts if p.bought):
        device = as_it_lies(read, part, shapes)
        if device is None:
            raise ValueError(f"{part.ref} has the footprint {part.footprint}, which no part has")
        box = device.body_on_board
        found.append(shapely.box(*box.bounds_mm))
        found += [read.flat(t.copper.area) for t in part.terminals if t.copper is not None]
    return shapely.union_all(found)


def _lands(read: PanelBoard) -> BaseGeometry:
    """Pads for wires, and the unplated holes of the copies."""
    wires = [
        read.flat(t.copper.area)
        for part in read.board.parts
        if part.footprint.startswith("WirePads")
        for t in part.terminals
        if t.copper is not None
    ]
    bites = {id(hole) for hole in read.bites}
    copies = shapely.union_all(list(read.copies))
    holes = [_disc(read, hole) for hole in read.holes if id(hole) not in bites]
    return shapely.union_all([*wires, *(hole for hole in holes if hole.intersects(copies))])


def measure_bites(read: PanelBoard) -> Iterator[Measurement]:
    """Mouse bites: holes in a row along each tab, over the edge, with webs that hold and break."""
    rules, few, depths, webs = read.rules, [], [], []
    taken: set[int] = set()
    for copy, contacts in zip(read.copies, read.contacts, strict=True):
        for line in contacts:
            row = [h for h in read.bites if _disc(read, h).distance(line) < NOISE_MM]
            row = sorted(row, key=lambda hole: read.at(hole.at)[1])
            taken |= {id(hole) for hole in row}
            if len(row) < rules.bites:
                few.append(f"{len(row)} holes at y {line.centroid.y:.2f}")
                continue
            depths += [_depth_mm(read, hole, copy) for hole in row]
            discs = [_disc(read, hole) for hole in row]
            webs += [a.distance(b) for a, b in itertools.pairwise(discs)]
            webs += [disc.distance(read.openings) for disc in (discs[0], discs[-1])]
    astray = [hole for hole in read.bites if id(hole) not in taken]
    few += [f"a hole at {x:.2f}, {y:.2f} beside a tab" for x, y in (read.at(h.at) for h in astray)]
    yield read.count("bites", few, "rows")
    sizes = np.array([hole.drill_mm for hole in read.bites])
    yield read.near("bite_size", sizes, rules.bite_mm, NOISE_MM)
    deepest = max(depths, default=math.nan)
    yield read.figure("bite_depth", deepest, NOISE_MM, rules.bite_inset_mm + NOISE_MM)
    for check, web in (("web", min), ("widest_web", max)):
        low, high = rules.bite_web_mm - NOISE_MM, WEB_MOST * rules.bite_web_mm
        yield read.figure(check, web(webs, default=math.nan), low, high)


def _depth_mm(read: PanelBoard, hole: Terminal, copy: BaseGeometry) -> float:
    """How far a hole reaches into a copy."""
    at = shapely.Point(read.at(hole.at))
    beyond = at.distance(copy.exterior)
    return float(hole.drill_mm / 2 + (beyond if copy.contains(at) else -beyond))


def _disc(read: PanelBoard, hole: Terminal) -> BaseGeometry:
    return shapely.Point(read.at(hole.at)).buffer(hole.drill_mm / 2, quad_segs=32)
