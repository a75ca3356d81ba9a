"""The boards' KiCad files: places of cells, edge, holes and parts; widths, gaps and whole nets."""

import math
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeVar

import numpy as np
import shapely

from lumitip_fab.checks.board_auxiliary import (
    measure_contact_map,
    measure_edge,
    measure_hot_loop,
    measure_joined,
    measure_keep_outs,
    measure_lands,
    measure_names,
    measure_screws,
    measure_supplies,
)
from lumitip_fab.checks.board_circuit import measure_channels, measure_connector, measure_strings
from lumitip_fab.checks.board_flex import measure_flexible
from lumitip_fab.checks.board_pour import measure_spokes
from lumitip_fab.checks.board_read import (
    Read,
    ReadAuxiliary,
    ReadBoard,
    middle,
    names_of,
    path_of,
    read_any,
)
from lumitip_fab.checks.board_silk import measure_silk, measure_targets
from lumitip_fab.checks.board_ties import measure_finger_ties, measure_ties
from lumitip_fab.checks.readers.kicad_board import Copper, Part
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.checks.settling import measure_settling
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError

CELL_MM = 0.001
EDGE_MM = 0.002
HOLE_MM = 0.01
_HEIGHT = re.compile(r"X(\d+)(?:-\d+)?N$")  # of an IPC-7351 name, in hundredths
_FLAT = ("TestPoint", "Fiducial", "WirePads", "MountingHole")


def measure_cells(read: Read) -> Iterator[Measurement]:
    """LED or detector i on the front at cell i: at (-x, y) on the emitter, by the facing rule."""
    letter, sign = read.finger.cells_hold.letter, read.finger.cells_hold.x_sign
    cells = read.design.cells
    wanted = np.array([(sign * cell.x_mm, cell.y_mm) for cell in cells])
    found = [read.parts.get(f"{letter}{i + 1}") for i in range(len(cells))]
    found = [part if part and part.front else None for part in found]
    off = np.hypot(*(read.sensor([middle(part) for part in found]) - wanted).T)
    worst = int(np.nan_to_num(off, nan=math.inf).argmax())
    yield read.figure("cells", off[worst], 0, CELL_MM, note=f"worst at {letter}{worst + 1}")
    extra = [ref for ref in read.parts if re.fullmatch(rf"{letter}\d+", ref)]
    yield read.figure("cell_count", len(extra), len(cells), len(cells), "parts")


def measure_outline(read: Read) -> Iterator[Measurement]:
    """The edge against the board's box, and the gap to the pocket on each side."""
    box, pocket = read.design.board.box, read.design.board.pocket
    left, low, right, high = read.outline.bounds
    (x_min, y_max), (x_max, y_min) = read.sensor([(left, low), (right, high)])
    off = [x_min - box.x_min_mm, x_max - box.x_max_mm, y_min - box.y_min_mm, y_max - box.y_max_mm]
    yield read.figure("outline", np.abs(off).max(), 0, EDGE_MM)
    gaps = [
        x_min - pocket.x_min_mm,
        pocket.x_max_mm - x_max,
        y_min - pocket.y_min_mm,
        pocket.y_max_mm - y_max,
    ]
    clearance = read.design.board.pocket_clearance_mm
    worst = max(gaps, key=lambda gap: abs(gap - clearance))
    yield read.figure("pocket_gap", worst, clearance - EDGE_MM, clearance + EDGE_MM)


def measure_holes(read: Read) -> Iterator[Measurement]:
    """The unplated holes against the backing's pins: place, and room all round."""
    board, wanted = read.design.board, np.array(read.finger.holes)
    found = read.sensor([hole.at for hole in read.screws])
    yield read.figure("hole_count", len(found), len(wanted), len(wanted), "holes")
    apart = np.hypot(*(wanted[:, None] - found[None]).transpose(2, 0, 1))
    off = apart.min(axis=1).max() if found.size else math.nan
    yield read.figure("holes", off, 0, HOLE_MM, note="from the backing's pins")
    room = [(hole.drill_mm - board.pin_mm) / 2 for hole in read.screws]
    least = (board.hole_mm - board.pin_mm) / 2
    worst = max(room, key=lambda gap: abs(gap - least), default=math.nan)
    yield read.figure("pin_clearance", worst, least - EDGE_MM, least + EDGE_MM)


def measure_heights(read: Read) -> Iterator[Measurement]:
    """Heights of the parts by their footprints' names: those on the front at most the silicone's
    thickness, those on the back with room to the walls and the floor of their relief."""
    tall = {part.ref: _height_mm(part) for part in read.board.parts if part.terminals}
    front = [tall[p.ref] for p in read.board.parts if p.terminals and p.front]
    highest = max(front, key=lambda h: math.inf if math.isnan(h) else h, default=math.nan)
    yield read.figure("height_front", highest, 0, read.design.stack.silicone_mm)
    spare = [
        _spare_mm(read, part, tall[part.ref])
        for part in read.board.parts
        if part.terminals and not part.front and tall[part.ref] != 0
    ]
    if spare or read.finger.reliefs:
        least = min(spare, key=lambda s: -math.inf if math.isnan(s) else s, default=math.nan)
        yield read.figure("room_behind", least, 0, math.inf, note="left round parts on the back")


def _height_mm(part: Part) -> float:
    """By the footprint's name; bare copper has none, NaN if the name does not give it."""
    if part.footprint.startswith(_FLAT):
        return 0.0
    height = _HEIGHT.search(part.footprint)
    return int(height[1]) / 100 if height else math.nan


def _spare_mm(read: Read, part: Part, height_mm: float) -> float:
    """Least room between a part on the back and the walls and floor of its relief."""
    copper = [t.copper.area for t in part.terminals if t.copper is not None]
    left, low, right, high = shapely.union_all(copper).bounds
    (x_min, y_max), (x_max, y_min) = read.sensor([(left, low), (right, high)])
    spares = [
        min(
            x_min - r.box.x_min_mm,
            r.box.x_max_mm - x_max,
            y_min - r.box.y_min_mm,
            r.box.y_max_mm - y_max,
            r.depth_mm - height_mm,
        )
        for r in read.finger.reliefs
    ]
    return float(max(spares, default=math.nan))


_ROUND_MM = 0.0006  # what chords of round copper take away, and six digits in files


def measure_copper(read: ReadBoard) -> Iterator[Measurement]:
    """Gaps, widths and rings against the rules of the design."""
    rules = read.design.rules
    yield _gap(read, rules.copper_gap_mm)
    yield _edge_gap(read, rules.edge_gap_mm)
    if read.holes:
        yield _hole_gap(read, rules.hole_gap_mm)
    tracks = [piece.width_mm for piece in read.board.loose if piece.kind == "track"]
    yield read.figure("track_width", min(tracks, default=math.nan), rules.track_mm, math.inf)
    rings = [_ring_mm(piece) for piece in read.board.loose if piece.kind == "via"]
    wanted = (rules.via_mm - rules.via_drill_mm) / 2 - _ROUND_MM
    if rings:
        yield read.figure("via_ring", min(rings), wanted, math.inf)


def measure_nets(read: ReadBoard) -> Iterator[Measurement]:
    """Nets that the copper leaves open, and those that it joins."""
    groups, names = read.clusters.groups(), read.clusters.nets()
    opened = sorted(net for net, found in groups.items() if len(found) > 1)
    yield read.count("open", [f"{net} in {len(groups[net])} pieces" for net in opened], "nets")
    joined = sorted(" and ".join(sorted(labels)) for labels in names.values() if len(labels) > 1)
    yield read.count("short", joined, "places")
    grounded = {label for label, labels in names.items() if "GND" in labels}
    adrift = [
        f"on {'/'.join(sorted(piece.layers))}"
        for piece in read.board.loose
        if piece.kind == "fill" and read.clusters.of(piece) not in grounded & groups["GND"]
    ]
    yield read.count("islands", adrift, "fills")


def _gap(read: ReadBoard, least_mm: float) -> Measurement:
    """The narrowest gap between copper that is not connected."""
    gaps = read.clusters.gaps(2 * least_mm)
    worst = min(gaps, key=lambda gap: gap[0], default=None)
    if worst is None:
        return read.figure("clearance", 2 * least_mm, least_mm - _ROUND_MM, math.inf)
    note = " and ".join(sorted(f"{piece.kind} of {piece.net or 'no net'}" for piece in worst[1:]))
    return read.figure("clearance", worst[0], least_mm - _ROUND_MM, math.inf, note=note)


def _edge_gap(read: ReadBoard, least_mm: float) -> Measurement:
    """The narrowest gap from copper to the edge."""
    copper = [piece.area for piece in read.clusters.pieces]
    inside = all(read.outline.contains(area) for area in copper)
    gap = float(shapely.distance(read.outline.boundary, copper).min()) if inside else -math.inf
    return read.figure("edge_clearance", gap, least_mm - _ROUND_MM, math.inf)


def _hole_gap(read: ReadBoard, least_mm: float) -> Measurement:
    """The narrowest gap from copper to unplated holes."""
    copper = [piece.area for piece in read.clusters.pieces]
    holes = [shapely.Point(h.at).buffer(h.drill_mm / 2, quad_segs=32) for h in read.holes]
    gaps = [float(shapely.distance(hole, copper).min()) for hole in holes]
    return read.figure("hole_clearance", min(gaps), least_mm - _ROUND_MM, math.inf)


def _ring_mm(via: Copper) -> float:
    left, _, right, _ = via.area.bounds
    return float(right - left - via.drill_mm) / 2


READS = ("boards/*.kicad_pcb",)

_Any = TypeVar("_Any", Read, ReadAuxiliary)
_OF_FINGERS: tuple[Callable[[Read], Iterator[Measurement]], ...] = (
    measure_cells,
    measure_outline,
    measure_holes,
    measure_finger_ties,
    measure_heights,
    measure_copper,
    measure_nets,
    measure_spokes,
    measure_connector,
    measure_silk,
    measure_targets,
    measure_flexible,
)
_OF_AUXILIARY_BOARDS: tuple[Callable[[ReadAuxiliary], Iterator[Measurement]], ...] = (
    measure_edge,
    measure_screws,
    measure_ties,
    measure_lands,
    measure_names,
    measure_copper,
    measure_nets,
    measure_spokes,
    measure_joined,
    measure_supplies,
    measure_hot_loop,
    measure_keep_outs,
    measure_contact_map,
)


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every figure of every board."""
    for name in names_of(design):
        yield from measure_board(outputs, design, name)


def measure_board(outputs: Path, design: Design, name: str) -> Iterator[Measurement]:
    """Every figure of one board."""
    try:
        read = read_any(outputs, design, name)
    except OutputError as error:
        yield unreadable("board.readable", path_of(name), str(error))
        return
    yield read.figure("readable", len(read.board.parts), 1, float("inf"), "parts")
    if isinstance(read, ReadAuxiliary):
        yield from _measured(read, _OF_AUXILIARY_BOARDS)
    else:
        lights = read.finger.cells_hold.kind == "led"
        own = (measure_strings,) if lights else (measure_channels, measure_settling)
        yield from _measured(read, (*_OF_FINGERS, *own))


def _measured(
    read: _Any, steps: "tuple[Callable[[_Any], Iterator[Measurement]], ...]"
) -> Iterator[Measurement]:
    for step in steps:
        try:
            yield from step(read)
        except (ArithmeticError, LookupError, ValueError, shapely.errors.ShapelyError) as error:
            name = step.__name__.removeprefix("measure_")
            yield unreadable(f"board.{name}", read.subject, f"cannot be measured: {error!r:.200}")
