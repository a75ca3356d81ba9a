"""Silkscreen of an auxiliary board: names of contacts, references, notes and the title."""

import dataclasses
import math
from collections.abc import Iterator
from itertools import pairwise, product

from lumitip_fab.boards.model import SIDES, PlacedComponent, Placement, Text
from lumitip_fab.boards.placed import courtyard, placed_pads
from lumitip_fab.boards.silk.page import Page, extent
from lumitip_fab.boards.silk.shrouds import draw_shroud
from lumitip_fab.design import AuxiliaryBoard, Box, Point, Rules, Side

_REMEDY = (
    "fewer digits in supply.voltage_v, shorter names of lines in [flange], or a larger "
    "breakout.board_mm"
)
_REF_MM = 1.0
_APART_MM = 0.2  # more than the least gap round references, so that they do not run together
_ASIDE_MM = (0.3, -0.3, 0.6, -0.6, 0.9, -0.9)  # of a name that has no room at its pad's middle
_AWAY_MM = 0.4  # from a pad to its name, and from a part to its reference


def with_legend(board: Placement, auxiliary: AuxiliaryBoard, rules: Rules) -> Placement:
    """The board with its silkscreen.

    Raises:
        BuildError: if a required label has no room; names the label and the place.
    """
    page = Page(board, rules)
    for note in auxiliary.notes:
        text = page.text(note.text, note.at, note.height_mm, note.angle_deg)
        _put(page, note.text, note.at, [text])
    parts = {part.ref: part for part in board.components}
    for part in parts.values():
        _names(page, part, auxiliary.box)
    for ref, part in parts.items():
        if part.kind == "fiducial":
            continue
        places = [*_round(page, ref, courtyard(part))]
        _put(page, ref, (part.x_mm, part.y_mm), places, _APART_MM, part.side)
    for part in parts.values():
        draw_shroud(page, part)
    lines = (
        (board.title, 2.0),
        (auxiliary.title, 1.5),
        (f"rev {board.revision}  {board.design_hash[:8]}", 1.5),
    )
    for side in SIDES:
        if page.block(side, lines, auxiliary.title_at) is None:
            page.miss(f"the title on its {side}", 1.0, page.length_mm(auxiliary.title), (0.0, 0.0))
    page.refuse_losses(_REMEDY)
    return dataclasses.replace(board, silk=tuple(page.strokes), texts=tuple(page.texts))


def _put(
    page: Page,
    words: str,
    at: Point,
    choices: list[Text],
    apart_mm: float = 0.0,
    side: Side = "front",
) -> None:
    """Print a text at the first place that is free, or note that there is none."""
    free = page.sides[side].free
    found = next((t for t in choices if free(extent(t, side).buffer(apart_mm))), None)
    if found:
        page.put(side, [found])
    else:
        first = choices[0]
        page.miss(repr(words), first.height_mm, page.length_mm(first.text, first.height_mm), at)


def _names(page: Page, part: PlacedComponent, board: Box) -> None:
    """The name of each contact beside it: all along their row if they fit, else upright; where
    that finds no room, along the row and a little aside."""
    if not (part.contacts and part.pins):
        return
    pads = placed_pads(part)
    apart = [abs(a.x_mm - b.x_mm) for a, b in pairwise(pads) if a.y_mm == b.y_mm]
    pitch = min(apart, default=0.0)
    flat = max(map(page.length_mm, part.pins)) + page.rules.silk_gap_mm < pitch
    inward = 1.0 if part.y_mm < board.centre_mm[1] else -1.0
    drawn = part.footprint.body.y_max_mm if part.outline else 0.0
    for pad, name in zip(pads, part.pins, strict=True):
        rise = pad.y_mm - part.y_mm
        way = math.copysign(1.0, rise) if pad.pad.y_mm else inward  # of two rows, outward
        edge = max(pad.pad.height_mm / 2, drawn - abs(pad.pad.y_mm)) + _AWAY_MM
        low, tall = (edge + size / 2 for size in (page.rules.silk_text_mm, page.length_mm(name)))
        lying = [
            page.text(name, (pad.x_mm + aside, pad.y_mm + away * low))
            for aside, away in product((0.0, *_ASIDE_MM), (way, -way))
        ]
        upright = [
            page.text(name, (pad.x_mm, pad.y_mm + away * tall), angle_deg=90.0)
            for away in (way, -way)
        ]
        places = lying if flat else [*upright, *lying]
        _put(page, f"{part.ref} {name}", (pad.x_mm, pad.y_mm), places)


def _round(page: Page, ref: str, yard: Box) -> Iterator[Text]:
    """Places for a reference round its part: at its ends, then above, below and upright; then the
    same farther away."""
    (x, y), long = yard.centre_mm, page.length_mm(ref, _REF_MM) / 2 + _AWAY_MM
    short = _REF_MM / 2 + _AWAY_MM
    for farther in (0.0, 1.0, 2.0, 3.0):
        half, rise = long + farther, short + farther
        sides = [(yard.x_min_mm, -1), (yard.x_max_mm, 1)]
        ends = [(yard.y_max_mm, 1), (yard.y_min_mm, -1)]
        yield from (page.text(ref, (at + way * half, y), _REF_MM) for at, way in sides)
        yield from (page.text(ref, (x, at + way * rise), _REF_MM) for at, way in ends)
        yield from (page.text(ref, (x, at + way * half), _REF_MM, 90.0) for at, way in ends)
        yield from (page.text(ref, (at + way * rise, y), _REF_MM, 90.0) for at, way in sides)
