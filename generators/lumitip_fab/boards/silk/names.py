"""Names of contacts, wire pads and test points on the silkscreen."""

import dataclasses
import math
from collections.abc import Iterator, Sequence
from itertools import pairwise, product

import numpy as np
from shapely import LineString

from lumitip_fab.boards.model import MASK_MM, SIDES, PlacedComponent, Text
from lumitip_fab.boards.placed import placed, placed_pads
from lumitip_fab.boards.silk.page import DOWN, LEFT, RIGHT, UP, Page, Way, extent
from lumitip_fab.design import Point, Shroud, Side

_GAP_MM = 0.3  # between names in a row, so that they are read apart
_OUTWARD_MM = 0.25  # that the first and the last name of a row give way
_STEP_MM = 0.25
_ALONG_MM = 1.3  # that a name may stand beside the middle of its pad: half a pitch of wires
_SPARE_MM = 0.06  # letters do not stand quite in the middle of their text
_BEYOND_MM = 5.0  # farthest place from a pad
_FIRST_MM = 0.6  # from the first pad to the middle of its number
_NEAR_MM = 4.5  # farthest place of that from the pad's middle: further away it is another part's
_ASIDE_MM = (0.0, 0.3, -0.3, 0.6, -0.6, 0.9, -0.9)  # of a name without room at its pad's middle
_AWAY_MM = 0.4  # from a contact to its name


def print_names(page: Page) -> None:
    """The names of all contacts. Where cells leave little room they stand in rows, and the first
    pad has its number; elsewhere each is at its contact."""
    components = page.board.components
    for part in components:
        if not (part.contacts and part.pins):
            continue
        if page.board.cells:
            pads = placed_pads(part)
            places = [(pad.x_mm, pad.y_mm) for pad in pads]
            _row(page, "front", part.pins, places, pads[0].pad.width_mm / 2)
            _first_pad(page, places[0], pads[0].pad.width_mm / 2)
        else:
            _at_contacts(page, part)
    points = [part for part in components if part.kind == "test point"]
    if not page.board.cells:
        for part in points:
            _at_probe(page, part)
        return
    for side in SIDES:
        here = sorted((p for p in points if p.side == side), key=lambda p: (p.y_mm, p.x_mm))
        if here:
            places = [(part.x_mm, part.y_mm) for part in here]
            _row(page, side, [p.value for p in here], places, here[0].footprint.body.length_mm / 2)


def _first_pad(page: Page, at: Point, half_mm: float) -> None:
    """The number of the first pad of a row: to its left, or else the nearest place that is not on
    the side of the other pads."""
    (x, y), least = at, half_mm + _FIRST_MM
    beside = [(x - d, y) for d in np.arange(least, _NEAR_MM, _STEP_MM).tolist()]
    steps = np.arange(0.0, _NEAR_MM, _STEP_MM).tolist()
    round_it = [(x - d, y + s * up) for d, up, s in product(steps, steps, (-1, 1))]
    round_it = [place for place in round_it if least <= math.dist(place, at) < _NEAR_MM]
    places = [*beside, *sorted(round_it, key=lambda place: math.dist(place, at))]
    page.require("the mark '1' of the first wire pad", [page.text("1", at) for at in places])


def _row(
    page: Page, side: Side, names: Sequence[str], pads: Sequence[Point], half_mm: float
) -> None:
    """The names of pads in a row: all alike if there is room, else each where it has some."""
    choices = [_beside(page, name, at, half_mm) for name, at in zip(names, pads, strict=True)]
    for texts in map(list, zip(*choices, strict=True)):
        flat = texts[0].angle_deg == 0.0
        if flat and len(texts) > 1:
            for end, sign in ((0, -1), (-1, 1)):
                texts[end] = _moved(texts[end], sign * _OUTWARD_MM)
        if page.free(side, texts, _GAP_MM if flat else page.rules.silk_gap_mm):
            page.put(side, texts)
            return
    steps = np.arange(_STEP_MM, _ALONG_MM, _STEP_MM).tolist()
    ends = (pads[0], LEFT), (pads[-1], RIGHT)
    for name, at, places in zip(names, pads, choices, strict=True):
        moved = [_moved(text, sign * d) for d in steps for text in places for sign in (1, -1)]
        outside = [
            text
            for end, way in ends
            if at == end
            for text in _outside(page, name, at, half_mm, way)
        ]
        page.require(f"the label {name!r}", [*places, *moved, *outside], side)


def _away_mm(page: Page) -> float:
    """From a pad in a row to its name."""
    return MASK_MM + page.rules.silk_gap_mm + _SPARE_MM


def _beside(page: Page, name: str, at: Point, half_mm: float) -> list[Text]:
    """Places for the name of a pad in a row: above it, upright above it, both ways below it."""
    away, pen, half = _away_mm(page), page.text(name, at).width_mm, (half_mm, half_mm)
    return [
        page.beside(name, at, half, way, away if upright else away + pen / 2, upright)
        for way in (UP, DOWN)
        for upright in (False, True)
    ]


def _outside(page: Page, name: str, at: Point, half_mm: float, way: Way) -> Iterator[Text]:
    """Places for the name of the first or last pad of a row, beyond the row's end."""
    for further in np.arange(0.0, _BEYOND_MM, _STEP_MM).tolist():
        for upright in (False, True):
            away, half = _away_mm(page) + further, (half_mm, half_mm)
            yield page.beside(name, at, half, way, away, upright)


def _at_contacts(page: Page, part: PlacedComponent) -> None:
    """The name of each contact beside it: along the row if most of them fit, longer ones upright;
    else all upright. Where that finds no room, along the row and a little aside."""
    pads = placed_pads(part)
    columns = sorted({round(pad.x_mm, 6) for pad in pads})
    pitch = min((b - a for a, b in pairwise(columns)), default=0.0)
    fits = [page.length_mm(name) + page.rules.silk_gap_mm < pitch for name in part.pins]
    mostly = 2 * sum(fits) > len(fits)
    inward = 1.0 if part.y_mm < page.board.outline.centre_mm[1] else -1.0
    drawn = part.footprint.body.y_max_mm if part.outline else 0.0
    for pad, name, flat in zip(pads, part.pins, fits, strict=True):
        rise = pad.y_mm - part.y_mm
        outward = math.copysign(1.0, rise) if pad.pad.y_mm else inward
        ways = (UP, DOWN) if outward > 0 else (DOWN, UP)
        at, half = (pad.x_mm, pad.y_mm), max(pad.pad.height_mm / 2, drawn - abs(pad.pad.y_mm))
        lying, upright = (
            [
                _moved(page.beside(name, at, (half, half), way, _AWAY_MM, turned), aside)
                for aside, way in product(_ASIDE_MM, ways)
            ]
            for turned in (False, True)
        )
        straight, slid = upright[: len(ways)], upright[len(ways) :]
        first = [*lying, *straight] if flat and mostly else [*straight, *lying]
        places = [*first, *slid]
        bodies = page.bodies["front"]
        seen = [t for t in places if not bodies.hide(extent(t, "front"), but=part.ref)]
        page.require(repr(f"{part.ref} {name}"), [*seen, *places])


def _at_probe(page: Page, part: PlacedComponent) -> None:
    """The name of a test point beside it, along the board or upright."""
    half = 2 * (part.footprint.pads[0].width_mm / 2,)
    choices = [
        page.beside(part.value, (part.x_mm, part.y_mm), half, way, _AWAY_MM, upright)
        for upright in (False, True)
        for way in (RIGHT, LEFT, DOWN, UP)
    ]
    page.require(f"the label {part.value!r}", choices, part.side)


def _moved(text: Text, along_mm: float) -> Text:
    return dataclasses.replace(text, x_mm=text.x_mm + along_mm)


_HEAD_MM, _SHAFT_MM = 0.6, 1.6  # of the arrow: each side of its head, and its length
_SHORTEST_MM = 2.0  # a shorter piece between two names looks like a dash
_TICK_MM = 1.0  # the least of a side of the notch
_Lines = list[LineString]


def notch(shroud: Shroud) -> tuple[tuple[Point, Point], ...]:
    """Both sides of the notch, from the back of the shroud to its front."""
    box, half = shroud.box, shroud.notch_mm / 2
    x = box.centre_mm[0]
    return tuple(((x + side, box.y_min_mm), (x + side, box.y_max_mm)) for side in (-half, half))


def draw_shroud(page: Page, part: PlacedComponent) -> None:
    """Draw the shroud where it lies on the board, as far as names leave room, and an arrow that
    points where the plug goes out; no shroud, no lines."""
    shroud = part.footprint.shroud
    if shroud is None:
        return
    side = page.sides[part.side]
    box = shroud.box
    corners = (
        (box.x_min_mm, box.y_min_mm),
        (box.x_max_mm, box.y_min_mm),
        (box.x_max_mm, box.y_max_mm),
        (box.x_min_mm, box.y_max_mm),
        (box.x_min_mm, box.y_min_mm),
    )
    pen = page.rules.silk_line_mm
    free = (a for a in _arrows(part, shroud) if all(side.free(line.buffer(pen / 2)) for line in a))
    page.lines(part.side, next(free, []))
    sides = [_on_board(part, ends) for ends in notch(shroud)]
    for lines, shortest_mm in (([_on_board(part, corners)], _SHORTEST_MM), (sides, _TICK_MM)):
        free_pieces = side.clipped(lines)
        page.lines(part.side, [each for each in free_pieces if each.length >= shortest_mm])


def _arrows(part: PlacedComponent, shroud: Shroud) -> Iterator[_Lines]:
    """Arrows within the notch, those nearest the front first; heads alone where that is all that
    has room."""
    x, y = shroud.box.centre_mm
    depth = shroud.box.length_mm
    for whole in (True, False):
        for k in range(int(depth / _STEP_MM)):
            tip = y + depth / 2 - k * _STEP_MM
            low = tip - _HEAD_MM
            head = ((x - _HEAD_MM, low), (x, tip), (x + _HEAD_MM, low))
            shaft = ((x, tip), (x, tip - _SHAFT_MM))
            yield [_on_board(part, line) for line in ((head, shaft) if whole else (head,))]


def _on_board(part: PlacedComponent, points: tuple[Point, ...]) -> LineString:
    return LineString([placed(part, *point) for point in points])
