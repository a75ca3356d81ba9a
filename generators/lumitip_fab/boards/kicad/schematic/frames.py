"""Drafts in titled frames, beside and below each other on the smallest paper."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from lumitip_fab.boards.kicad.schematic.draft import Draft
from lumitip_fab.boards.kicad.schematic.extent import bounds
from lumitip_fab.boards.kicad.schematic.joints import jointed
from lumitip_fab.boards.kicad.schematic.packing import packed
from lumitip_fab.boards.kicad.schematic.shapes import pins_of
from lumitip_fab.boards.kicad.schematic.sheet import MARGIN_MM, PAPERS, TITLE_MM, Drawn, Sheet
from lumitip_fab.boards.kicad.schematic.text_size import GRID_MM, text_mm, up_to_grid
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
