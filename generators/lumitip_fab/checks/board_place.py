"""Where a board's cells, edge, holes and parts are, against layout, pocket, pins and room."""

import math
import re
from collections.abc import Iterator

import numpy as np
import shapely

from lumitip_fab.checks.board_read import Read, middle
from lumitip_fab.checks.kicad_board import Part
from lumitip_fab.checks.result import Measurement

CELL_MM = 0.001
EDGE_MM = 0.002
HOLE_MM = 0.01
_HEIGHT = re.compile(r"X(\d+)(?:-\d+)?N$")  # of an IPC-7351 name, in hundredths
_FLAT = ("TestPoint", "Fiducial", "WirePads", "MountingHole")


def measure_cells(read: Read) -> Iterator[Measurement]:
    """LED or detector i on the front at cell i: at (-x, y) on the emitter, by the facing rule."""
    letter, sign = ("D", -1) if read.finger.name == "emitter" else ("Q", 1)
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
    gaps = [x_min - pocket.x_min_mm, pocket.x_max_mm - x_max, y_min - pocket.y_min_mm,
            pocket.y_max_mm - y_max]  # fmt: skip
    clearance = read.design.board.pocket_clearance_mm
    worst = max(gaps, key=lambda gap: abs(gap - clearance))
    yield read.figure("pocket_gap", worst, clearance - EDGE_MM, clearance + EDGE_MM)


def measure_holes(read: Read) -> Iterator[Measurement]:
    """The unplated holes against the backing's pins: place, and room all round."""
    board, wanted = read.design.board, np.array(read.finger.holes)
    found = read.sensor([hole.at for hole in read.holes])
    yield read.figure("hole_count", len(found), len(wanted), len(wanted), "holes")
    apart = np.hypot(*(wanted[:, None] - found[None]).transpose(2, 0, 1))
    off = apart.min(axis=1).max() if found.size else math.nan
    yield read.figure("holes", off, 0, HOLE_MM, note="from the backing's pins")
    room = [(hole.drill_mm - board.pin_mm) / 2 for hole in read.holes]
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
    spare = [_spare_mm(read, part, tall[part.ref]) for part in read.board.parts
             if part.terminals and not part.front and tall[part.ref] != 0]  # fmt: skip
    if spare or read.finger.reliefs:
        least = min(spare, key=lambda s: -math.inf if math.isnan(s) else s, default=math.nan)
        yield read.figure("room_behind", least, 0, math.inf, note="left round parts on the back")


def _height_mm(part: Part) -> float:
    """By the footprint's name; bare copper has none, NaN if the name tells nothing."""
    if part.footprint.startswith(_FLAT):
        return 0.0
    told = _HEIGHT.search(part.footprint)
    return int(told[1]) / 100 if told else math.nan


def _spare_mm(read: Read, part: Part, height_mm: float) -> float:
    """Least room between a part on the back and the walls and floor of its relief."""
    copper = [t.copper.area for t in part.terminals if t.copper is not None]
    left, low, right, high = shapely.union_all(copper).bounds
    (x_min, y_max), (x_max, y_min) = read.sensor([(left, low), (right, high)])
    spares = [
        min(x_min - r.box.x_min_mm, r.box.x_max_mm - x_max, y_min - r.box.y_min_mm,
            r.box.y_max_mm - y_max, r.depth_mm - height_mm)
        for r in read.finger.reliefs
    ]  # fmt: skip
    return float(max(spares, default=math.nan))
