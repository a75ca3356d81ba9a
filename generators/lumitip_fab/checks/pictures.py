"""Pictures of the boards, SVG and PNG: copper, bare board, silkscreen and outline stand where the
board's file has them."""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import shapely

from lumitip_fab.checks.board_read import ReadBoard, names_of, read_closed
from lumitip_fab.checks.readers.board_picture import (
    EDGE,
    NOTHING,
    BoardDrawing,
    Names,
    Places,
    png_names,
    read_drawing,
)
from lumitip_fab.checks.result import Measurement, Subject, unreadable
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError

READS = ("boards/*/*.kicad_pcb", "boards/*/*_front.*", "boards/*/*_back.*")
_COPPER = ("covered copper", "plated copper", "rims", "silkscreen")
_BARE = ("mask", "laminate", "silkscreen")
_STEP_MM = 0.3  # from one place that is looked at to the next
_EDGE_MM = 0.05  # of an area, where its chords are not its arcs
_BESIDE_MM = 0.8  # beyond the board's outline
_MOST, _MOST_EDGES = 0.1, 40.0  # percent of all places


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Both pictures of both sides of every board."""
    for name in names_of(design):
        yield from measure_board(outputs, design, name)


def measure_board(outputs: Path, design: Design, name: str) -> Iterator[Measurement]:
    """Both pictures of both sides of a board."""
    try:
        read = read_closed(outputs, design, name)
    except OutputError as error:
        yield unreadable("pictures.readable", f"boards/{name}", str(error))
        return
    for side in ("front", "back"):
        yield from _side(outputs / f"boards/{name}/{name}_{side}.svg", read, side)


def _side(path: Path, read: ReadBoard, side: str) -> Iterator[Measurement]:
    """The SVG of a side, and the PNG beside it."""
    svg, png = path, path.with_suffix(".png")
    expected = list(_expected(read, side))
    left, top, right, bottom = read.outline.bounds
    middle, turned = ((left + right) / 2, (top + bottom) / 2), (1 if side == "front" else -1, 1)
    at_mm = np.concatenate([(places - middle) * turned for places, _ in expected])
    allowed = [names for places, names in expected for _ in places]
    try:
        drawing = read_drawing(svg)
    except OutputError as error:
        yield unreadable("pictures.readable", f"boards/{read.name}/{svg.name}", str(error))
        return
    yield from _colours(read, svg, drawing, drawing.names(at_mm), allowed)
    try:
        shown = png_names(png, drawing, at_mm)
    except OutputError as error:
        yield unreadable("pictures.readable", f"boards/{read.name}/{png.name}", str(error))
        return
    yield from _colours(read, png, drawing, shown, allowed)


def _colours(
    read: ReadBoard,
    path: Path,
    drawing: BoardDrawing,
    found: Names,
    allowed: list[tuple[str, ...]],
) -> Iterator[Measurement]:
    of = Subject("pictures", f"boards/{read.name}/{path.name}")
    edges = 100 * float(np.mean(found == EDGE))
    wrong = [name not in names for name, names in zip(found, allowed, strict=True) if name != EDGE]
    missing = sorted({*_COPPER, *_BARE} - drawing.colours.keys())
    yield of.count("areas", missing, "areas missing")
    share = 100 * float(np.mean(wrong)) if wrong else math.nan
    yield of.figure("colours", share, 0, _MOST, "%", "of places unlike the board")
    yield of.figure("edges", edges, 0, _MOST_EDGES, "%", "of places between two colours")


def _expected(read: ReadBoard, side: str) -> Iterator[tuple[Places, tuple[str, ...]]]:
    """Places beside the board, on copper and between it, and middles of pads and printed lines."""
    board, front = read.board, side == "front"
    layer = board.layers[0 if front else -1]
    terminals = [t for part in board.parts for t in part.terminals]
    drills = [shapely.Point(t.at).buffer(t.drill_mm / 2) for t in terminals if t.drill_mm]
    body = read.outline - shapely.union_all(drills)
    copper = shapely.union_all([c.area for c in board.copper() if layer in c.layers]) & body
    left, top, right, bottom = around = read.outline.buffer(_BESIDE_MM).bounds
    across, down = np.arange(left, right, _STEP_MM), np.arange(top, bottom, _STEP_MM)
    grid = np.stack(np.meshgrid(across, down), axis=-1).reshape(-1, 2)
    for area, names in (
        (shapely.box(*around) - body, (NOTHING,)),
        (copper, _COPPER),
        (body - copper, _BARE),
    ):
        yield grid[shapely.contains_xy(area.buffer(-_EDGE_MM), *grid.T)], names
    soldered = [t for t in terminals if t.copper and layer in t.copper.layers and not t.drill_mm]
    yield np.array([t.at for t in soldered]).reshape(-1, 2), ("plated copper",)
    lines = [line.path for line in board.silk.lines if line.front == front and line.path.length]
    middles = [line.interpolate(0.5, normalized=True).coords[0] for line in lines]
    yield np.array(middles).reshape(-1, 2), ("silkscreen",)
