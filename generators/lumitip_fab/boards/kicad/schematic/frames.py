"""Drafts in titled frames, packed beside and below each other on the smallest paper."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from lumitip_fab.boards.kicad.schematic.draft import Draft
from lumitip_fab.boards.kicad.schematic.shapes import pins_of
from lumitip_fab.boards.kicad.schematic.sheet import (
    GRID_MM,
    MARGIN_MM,
    PAPERS,
    TITLE_MM,
    Drawn,
    Sheet,
    bounds,
    jointed,
    text_mm,
    up_to_grid,
)
from lumitip_fab.boards.kicad.sexpr import Node
from lumitip_fab.design import Point

_TITLE_MM, _HEAD_MM = 2.0, 7.62
"""Letters of a title, and the room above a block for it."""
_PAD_MM = 3.81
"""Round a block inside its frame."""
Titled = tuple[str, Draft]


def framed(blocks: Sequence[Titled]) -> tuple[str, Sheet]:
    """Name of the paper and the drawing: blocks, each with its frame and its title."""
    sizes = [_size_mm(*block) for block in blocks]
    paper, places = _paper(sizes)
    sheet = Sheet()
    for (title, draft), (at, size_mm) in zip(blocks, places, strict=True):
        _put(sheet, title, draft, (at[0] + MARGIN_MM, at[1] + MARGIN_MM), size_mm)
    return paper, sheet


def _paper(sizes: Sequence[Point]) -> tuple[str, list[tuple[Point, Point]]]:
    """The smallest paper that takes frames of these sizes, and their places; A0 for more."""
    widest = max(wide for wide, _ in sizes)
    for paper, size in PAPERS.items():
        wide, high = size[0] - 2 * MARGIN_MM, size[1] - MARGIN_MM - TITLE_MM
        places, tall = packed(sizes, wide)
        if paper == "A0" or (widest <= wide and tall <= high):
            return paper, places
    raise AssertionError("A0 is the last of the papers")


def _size_mm(title: str, draft: Draft) -> Point:
    """Width and height of a frame."""
    (x0, y0), (x1, y1) = bounds(draft.sheet, draft.shapes)
    wide = max(x1 - x0, text_mm(title, _TITLE_MM))
    return up_to_grid(wide + 2 * _PAD_MM), up_to_grid(y1 - y0 + _HEAD_MM + 2 * _PAD_MM)


def _put(sheet: Sheet, title: str, draft: Draft, at: Point, size_mm: Point) -> None:
    """A block with the upper left corner of its frame at a place."""
    (x0, y0), _ = bounds(draft.sheet, draft.shapes)
    dx = up_to_grid(at[0] + _PAD_MM - x0)
    dy = up_to_grid(at[1] + _HEAD_MM + _PAD_MM - y0)

    def moved(place: Point) -> Point:
        return place[0] + dx, place[1] + dy

    drawing = draft.sheet
    sheet.frames.append((at, (at[0] + size_mm[0], at[1] + size_mm[1])))
    sheet.texts.append((title, (at[0] + 2 * GRID_MM, at[1] + 4 * GRID_MM), _TITLE_MM))
    wires = [(moved(start), moved(end)) for start, end in drawing.wires]
    symbols = [_renumbered(sheet, drawn, dx, dy) for drawn in drawing.symbols]
    cut, dots = jointed(wires, pin_places(symbols, draft.shapes))
    sheet.wires += cut
    sheet.junctions += dots
    sheet.labels += [(net, moved(place), angle) for net, place, angle in drawing.labels]
    sheet.texts += [(words, moved(place), high) for words, place, high in drawing.texts]
    sheet.symbols += symbols


def _renumbered(sheet: Sheet, drawn: Drawn, dx: float, dy: float) -> Drawn:
    """A symbol in its place on the whole sheet; those of supplies are counted there."""
    ref = drawn.ref
    if ref.startswith("#PWR"):
        sheet.powers += 1
        ref = f"#PWR{sheet.powers:03d}"
    return replace(drawn, ref=ref, x_mm=drawn.x_mm + dx, y_mm=drawn.y_mm + dy)


def pin_places(symbols: Iterable[Drawn], shapes: Mapping[str, Node]) -> list[Point]:
    """Outer ends of the pins of symbols."""
    found = []
    for drawn in symbols:
        turn = math.radians(drawn.angle_deg)
        cos, sin = round(math.cos(turn)), round(math.sin(turn))
        found += [
            (drawn.x_mm + x * cos - y * sin, drawn.y_mm - x * sin - y * cos)
            for x, y in pins_of(shapes[drawn.symbol]).values()
        ]
    return found


GAP_MM = 5.08
"""Between frames."""


@dataclass
class _Column:
    wide_mm: float
    high_mm: float
    frames: list[int]


def packed(sizes: Sequence[Point], wide_mm: float) -> tuple[list[tuple[Point, Point]], float]:
    """Place and size of each frame, and the height of them all.

    A frame is as wide as its column, and the last of a column reaches down to the row's end.

    Args:
        sizes: least widths and heights of the frames, in the order in which they are read.
        wide_mm: width of the page; a wider frame has a row of its own.
    """
    places: dict[int, tuple[Point, Point]] = {}
    y = 0.0
    for row in _rows(sizes, wide_mm):
        x, high = 0.0, _high_mm(row)
        for column in row:
            top = y
            for i in column.frames:
                last = i == column.frames[-1]
                tall = y + high - top if last else sizes[i][1]
                places[i] = (x, top), (column.wide_mm, tall)
                top += tall + GAP_MM
            x += column.wide_mm + GAP_MM
        y += high + GAP_MM
    return [places[i] for i in range(len(sizes))], y - GAP_MM


def _rows(sizes: Sequence[Point], wide_mm: float) -> list[list[_Column]]:
    rows: list[list[_Column]] = []
    for i, (wide, high) in enumerate(sizes):
        row = rows[-1] if rows else []
        before = sum(column.wide_mm + GAP_MM for column in row)
        if row and _goes_below(row, wide, high, wide_mm - before + GAP_MM):
            column = row[-1]
            column.wide_mm = max(column.wide_mm, wide)
            column.high_mm += GAP_MM + high
            column.frames.append(i)
        elif row and before + wide <= wide_mm:
            row.append(_Column(wide, high, [i]))
        else:
            rows.append([_Column(wide, high, [i])])
    return rows


def _goes_below(row: Sequence[_Column], wide: float, high: float, spare_mm: float) -> bool:
    """Whether a frame has room below the last column of a row."""
    column = row[-1]
    fits = wide - column.wide_mm <= spare_mm
    return fits and column.high_mm + GAP_MM + high <= _high_mm(row)


def _high_mm(row: Sequence[_Column]) -> float:
    return max(column.high_mm for column in row)
