"""Measures of finger boards alone: LED or photodetector at each cell, the cells' outlines and names
on the silkscreen, the arrow to the tip; and, if it is flexible, stack-up, bend without holes,
stiffener and teardrops."""

import math
import re
from collections import Counter
from collections.abc import Iterator

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import ReadBoard, lands, middle, on_page
from lumitip_fab.checks.readers.kicad_board import Copper
from lumitip_fab.checks.readers.kicad_silk import Word
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Box, Flexible
from lumitip_fab.design.frames import on_board_page

CELL_MM = 0.001
CELL_SHARE = 0.3  # least of a cell's outline that is drawn: pads, parts and holes interrupt it
TO_EDGE_MM = 0.02  # from a drawn line to the outline of its cell
ARROW_MM = 5.0  # from the word to its arrow, at most
TURN_DEG = 1.0
NAMED_LETTERS = 6.25  # heights of letters from cell to cell, from which every name has room
NAMED_FIGURES = 2  # in the longest name that has
END_SHARE = 0.5  # least of the columns' ends that are named where not all cells are
_NOISE_MM = 1e-4
PLY_MM = 0.001
PLACE_MM = 0.01
ROOM_MM = 0.2  # stiffener to the sides of the wire notch
IN_BEND = 95.0  # of all joints that must have teardrops (%),
ELSEWHERE = 60.0  # and between the leads of multiplexers, where some have no room
OUTSIDE_MM = 0.1  # of pad or via, where a joint's width is taken
WIDER = 1.6  # than the track
_OF_PAD = 0.9  # of the pad's width, where that is less
_STIFFENER, _BEND = "User.1", "User.2"


def measure_cells(read: ReadBoard) -> Iterator[Measurement]:
    """LED or detector i on the front at cell i: at (-x, y) on the emitter, by the facing rule."""
    if not (at_cells := read.cells_hold):
        return
    letter, cells = at_cells.letter, read.design.cells
    wanted = np.array([(at_cells.x_sign * cell.x_mm, cell.y_mm) for cell in cells])
    found = [read.parts.get(f"{letter}{i + 1}") for i in range(len(cells))]
    found = [part if part and part.front else None for part in found]
    off = np.hypot(*(read.sensor([middle(part) for part in found]) - wanted).T)
    worst = int(np.nan_to_num(off, nan=math.inf).argmax())
    yield read.figure("cells", off[worst], 0, CELL_MM, note=f"worst at {letter}{worst + 1}")
    extra = [ref for ref in read.parts if re.fullmatch(rf"{letter}\d+", ref)]
    yield read.figure("cell_count", len(extra), len(cells), len(cells), "parts")


def measure_cell_prints(read: ReadBoard) -> Iterator[Measurement]:
    """Arrow to the tip, and the cells' outlines and names."""
    if not (at_cells := read.cells_hold):
        return
    yield read.count("silk_arrow", list(_astray(read)), "arrows")
    share, cell = _least_cell(read, at_cells.x_sign)
    yield read.figure("silk_cells", share, CELL_SHARE, 1.0, "drawn", f"least of cell {cell}")
    wrong = [*_misnamed(read, at_cells.x_sign), *_unnamed(read)]
    yield read.count("silk_cell_names", wrong, "cells")


def _astray(read: ReadBoard) -> Iterator[str]:
    """Arrows to the tip that are missing or do not point there."""
    tips = [word for word in read.board.silk.words if word.text == "TIP"]
    if not tips:
        yield "no arrow to the tip"
    for tip in tips:
        turn = _turn_deg(read, tip)
        if not abs(turn) <= TURN_DEG:
            yield f"the arrow at the word on the {'front' if tip.front else 'back'} by {turn:.0f}°"


def _turn_deg(read: ReadBoard, tip: Word) -> float:
    """Angle from the tip's direction to the arrow at a word; NaN if there is no arrow.

    Its head is where three lines meet; it points there from their other ends.
    """
    spot = shapely.Point(tip.at)
    near = [
        line.path
        for line in read.board.silk.lines
        if line.front == tip.front and not line.ref and line.path.distance(spot) < ARROW_MM
    ]
    ends = [[(round(x, 3), round(y, 3)) for x, y in shapely.get_coordinates(p)] for p in near]
    met = Counter(end for line in ends for end in (line[0], line[-1]))
    heads = [end for end, count in met.items() if count == 3]
    heads = [head for head in heads if _is_tip(head, ends, tip)]
    if not heads:
        return math.nan
    tails = [line[0] if line[-1] == heads[0] else line[-1] for line in ends if heads[0] in line]
    head, tail = read.sensor([heads[0], np.mean(tails, axis=0)])
    return math.degrees(math.atan2(tail[0] - head[0], head[1] - tail[1]))


def _is_tip(head: tuple[float, float], ends: list[list[tuple[float, float]]], tip: Word) -> bool:
    """Whether lines that meet are an arrow's and not three cells': one is longer than the rest,
    and comes from the word."""
    lengths = {math.dist(line[0], line[-1]): line for line in ends if head in line}
    longest = lengths[max(lengths)]
    tail = longest[0] if longest[-1] == head else longest[-1]
    return max(lengths) > 1.5 * min(lengths) and math.dist(tail, tip.at) < math.dist(head, tip.at)


def _least_cell(read: ReadBoard, sign: float) -> tuple[float, int]:
    """The least share of a cell's outline that is drawn on the front, and which cell it is."""
    cells = read.design.cells
    radius = read.design.grid.pitch_mm / math.sqrt(3)
    angles = np.radians(60 * np.arange(7))
    corners = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    middles = np.array([(sign * cell.x_mm, cell.y_mm) for cell in cells])
    hexagons = shapely.linestrings(middles[:, None] + corners[None])
    drawn = [line.path for line in read.board.silk.lines if line.front and not line.ref]
    on_board = shapely.transform(shapely.union_all(drawn), read.sensor)
    near = on_board.buffer(TO_EDGE_MM, cap_style="flat")
    shares = shapely.length(shapely.intersection(hexagons, near)) / shapely.length(hexagons)
    return float(shares.min()), int(shares.argmin())


def _misnamed(read: ReadBoard, sign: float) -> Iterator[str]:
    """Names of cells' parts that stand nearer to another cell than to their own."""
    middles = np.array([(cell.x_mm, cell.y_mm) for cell in read.design.cells])
    middles = middles * (sign, 1)
    for number, word in _names(read):
        nearest = int(np.hypot(*(middles - read.sensor([word.at])[0]).T).argmin()) + 1
        if number != nearest:
            yield f"{word.ref} stands at cell {nearest - 1}"


def _unnamed(read: ReadBoard) -> Iterator[str]:
    """Cells without a name. In narrow ones columns may be named at their ends alone, and at some
    of these there may be no room: between a hole and the edge."""
    cells, named = read.design.cells, {number for number, _ in _names(read)}
    letter_mm, figures = read.design.rules.silk_text_mm, len(str(len(cells)))
    narrow = read.design.grid.pitch_mm < NAMED_LETTERS * letter_mm - _NOISE_MM
    lengths = read.design.grid.columns
    last = {sum(lengths[: column + 1]) for column in range(len(lengths))}
    ends = last | {end - length + 1 for end, length in zip(sorted(last), lengths, strict=True)}
    wanted = set(range(1, len(cells) + 1))
    if (narrow or figures > NAMED_FIGURES) and named <= ends:
        wanted = ends if len(named) < END_SHARE * len(ends) else set()
    yield from (f"cell {number - 1} has no name" for number in sorted(wanted - named))


def _names(read: ReadBoard) -> Iterator[tuple[int, Word]]:
    """The names of cells' parts that are printed on the front, each with its figure."""
    letter = read.cells_hold.letter if read.cells_hold else ""
    for word in read.board.silk.words:
        if re.fullmatch(rf"{letter}\d+", word.ref) and word.text == word.ref and word.front:
            yield int(word.ref[1:]), word


def measure_flexible(read: ReadBoard) -> Iterator[Measurement]:
    """Everything that a flexible board is ordered by."""
    finger, flexible = read.finger, read.flexible
    if finger is None or flexible is None:
        return
    yield _stack_up(read)
    yield from _regions(read, flexible, finger.notch)
    yield _bend(read, flexible)
    yield _held(read, finger.cells_hold.letter)
    yield from _teardrops(read, flexible)


def _stack_up(read: ReadBoard) -> Measurement:
    """Thickness of all layers together; between copper there is polyimide, and nothing else."""
    plies, wanted = read.board.plies, read.design.stack.pcb_mm
    copper = [ply for ply in plies if ply.kind == "copper"]
    stiff = [ply for ply in plies if ply.kind != "copper" and ply.material != "Polyimide"]
    whole = sum(ply.thickness_mm for ply in plies)
    good = len(copper) == len(read.board.layers) and len(plies) > len(copper) and not stiff
    note = f"{len(copper)} of copper, the rest of polyimide"
    return read.figure(
        "stack_up", whole if good else np.nan, wanted - PLY_MM, wanted + PLY_MM, note=note
    )


def _regions(read: ReadBoard, flexible: Flexible, notch: Box) -> Iterator[Measurement]:
    """Stiffener and bend where the design has them, and the stiffener within the wire notch."""
    wanted = {_STIFFENER: flexible.stiffener, _BEND: flexible.bend}
    off = [
        _off(read.board.regions[layer], box) if layer in read.board.regions else np.nan
        for layer, box in wanted.items()
    ]
    yield read.figure("regions", np.max(off), 0, PLACE_MM, note="stiffener and bend")
    drawn = read.board.regions.get(_STIFFENER, shapely.Point())
    low, high = on_board_page((notch.x_min_mm, 0.0))[0], on_board_page((notch.x_max_mm, 0.0))[0]
    room = min(drawn.bounds[0] - low, high - drawn.bounds[2]) if not drawn.is_empty else np.nan
    yield read.figure("stiffener_room", room, ROOM_MM, np.inf, note="to the sides of the notch")


def _bend(read: ReadBoard, flexible: Flexible) -> Measurement:
    """Vias and plated holes where the board bends."""
    bend = on_page(flexible.bend)
    holes = [c for c in read.board.copper() if c.drill_mm and c.area.intersects(bend)]
    plated = [t for _, t, c in lands(read.board) if t.drill_mm and c.area.intersects(bend)]
    return read.figure("bend", len(holes) + len(plated), 0, 0, "vias and plated holes")


def _held(read: ReadBoard, at_cells: str) -> Measurement:
    """How far parts that are not at the cells are from the bend, where their joints would break."""
    bend = read.board.regions.get(_BEND, shapely.Point())
    bends = (at_cells, "FID")
    apart = [
        (copper.area.bounds[1] - bend.bounds[3], part.ref)
        for part, _, copper in lands(read.board)
        if part.ref.rstrip("0123456789") not in bends and not bend.is_empty
    ]
    least, ref = min(apart, default=(np.nan, "no part"))
    return read.figure("held", least, 0, np.inf, note=f"from the bend to {ref}")


def _teardrops(read: ReadBoard, flexible: Flexible) -> Iterator[Measurement]:
    """Joints of tracks with pads and vias that are wider there than the track, but for ground,
    which the pour joins: where the board bends, and where the interface holds it."""
    copper = [c for c in read.board.copper() if c.net not in ("", "GND")]
    bend = on_page(flexible.bend)
    found: dict[bool, list[bool]] = {True: [], False: []}
    for layer in read.board.layers:
        here = [c for c in copper if layer in c.layers]
        for net in sorted({c.net for c in here}):
            tracks = [c for c in here if c.net == net and c.kind == "track"]
            if tracks:
                for land in (c for c in here if c.net == net and c.kind in ("pad", "via")):
                    bends = bool(land.area.intersects(bend))
                    found[bends] += _widened(tracks, land)
    for bends, where, least in ((True, "bends", IN_BEND), (False, "is held", ELSEWHERE)):
        joints = found[bends]
        share = 100.0 * sum(joints) / len(joints) if joints else np.nan
        note = f"of {len(joints)} joints where the board {where}"
        yield read.figure("teardrops", share, least, 100, "%", note)


def _widened(tracks: list[Copper], land: Copper) -> list[bool]:
    """Whether the copper is wider than a track at each place where tracks leave a land."""
    thin = min(track.width_mm for track in tracks)
    together = shapely.union_all([track.area for track in tracks])
    corners = shapely.get_coordinates(shapely.minimum_rotated_rectangle(land.area))
    side = float(np.hypot(*np.diff(corners[:3], axis=0).T).min())
    needed = min(WIDER * thin, _OF_PAD * side)
    ring = land.area.buffer(OUTSIDE_MM).exterior
    crossed = shapely.line_merge(ring.intersection(together))
    return [float(part.length) >= needed for part in shapely.get_parts(crossed)]


def _off(drawn: BaseGeometry, box: Box) -> float:
    return float(np.abs(np.array(drawn.bounds) - np.array(on_page(box).bounds)).max())
