"""References of parts on the silkscreen, and the outlines of the cells that they stand in.

A board without cells has the references of its parts, each nearer to its part than to any other and
under no body; one that finds no such place is left out, as assembly drawings have them all. On one
with cells, parts elsewhere have theirs where there is room. At the cells there are all of them, for
which the outlines give way if need be, or, where that is too narrow, those at the ends of each
column: cells are counted from the tip.
"""

import dataclasses
import math
from collections import defaultdict
from collections.abc import Iterator, Sequence

import numpy as np
import shapely
from shapely import LineString

from lumitip_fab.boards.model import AT_CELLS, PlacedComponent, Text
from lumitip_fab.boards.placed import courtyard
from lumitip_fab.boards.silk.page import DOWN, LEFT, RIGHT, UP, Clear, Page, Way, extent
from lumitip_fab.design import Box, Point, Side

_APART_MM = 0.1  # more than the least gap round references, so that they do not run together
_FREE_MM = 0.2  # the same on a board without cells
_REF_MM, _AWAY_MM = 1.0, 0.4  # height there, and from a part to its reference
_STEP_MM = 0.1
_ALONG = (0.0, 0.3, -0.3, 0.6, -0.6, 1.0, -1.0)  # places along a part's side, of half of it
_BEYOND_MM = 2.5  # farthest end of a column's reference from the column
_SHOWN = ("multiplexer", "current source", "switch", "resistor", "resistor array", "capacitor")
_Places = dict[str, Text]


def print_references(page: Page) -> tuple[PlacedComponent, ...]:
    """Print the references of parts, and the outlines of the cells; the parts of the board, with
    their references where those belong to their footprints."""
    cells, components = page.board.cells, page.board.components
    if cells:
        return _among_cells(page, _edges(cells.at, cells.pitch_mm), cells.pitch_mm)
    for part in components:
        if part.kind not in ("fiducial", "test point"):  # a test point has the name of its net
            height_mm = _height_mm(page, part)
            bodies = page.bodies[part.side]
            places = _round(page, part.ref, courtyard(part), height_mm)
            for apart_mm in (_FREE_MM, 0.0) if height_mm else (0.0,):
                seen = (
                    text
                    for text in places
                    if not bodies.hide(extent(text, part.side)) and not bodies.misleads(text)
                )
                if page.first_free(part.side, seen, apart_mm):
                    break
    return components


def _height_mm(page: Page, part: PlacedComponent) -> float:
    """Of the reference: less in a row of parts that are nearer to each other than it is long; 0 is
    as small as is legible."""
    alike = (p for p in page.board.components if p.footprint.name == part.footprint.name)
    apart = [math.dist((p.x_mm, p.y_mm), (part.x_mm, part.y_mm)) for p in alike if p is not part]
    return _REF_MM if page.length_mm(part.ref, _REF_MM) < min(apart, default=math.inf) else 0.0


def _round(page: Page, ref: str, yard: Box, height_mm: float) -> list[Text]:
    """Places for a reference round its part: at its ends, then above, below and upright; then the
    same farther away, and all of them in the smallest letters. In a dense row upright first, and
    nearer."""
    turns = (
        *((way, False) for way in (LEFT, RIGHT, UP, DOWN)),
        *((way, True) for way in (UP, DOWN, LEFT, RIGHT)),
    )
    if not height_mm:  # level it would take its neighbours' places
        turns = (*turns[4:], *turns[:4])
    away = _AWAY_MM if height_mm else _AWAY_MM / 2
    return [
        _slid(page.beside(ref, *_rectangle(yard), way, away + farther, upright, high), way, yard, s)
        for high in (height_mm, 0.0)
        for farther in (0.0, 0.5, 1.0, 2.0, 3.0)
        for s in _ALONG
        for way, upright in turns
    ]


def _slid(text: Text, way: Way, yard: Box, share: float) -> Text:
    """A text beside a part moved along its side, by a share of half the side."""
    if way[0]:
        return dataclasses.replace(text, y_mm=text.y_mm + share * yard.length_mm / 2)
    return dataclasses.replace(text, x_mm=text.x_mm + share * yard.width_mm / 2)


def _rectangle(yard: Box) -> tuple[Point, Point]:
    """Middle, and half the width and length."""
    return yard.centre_mm, (yard.width_mm / 2, yard.length_mm / 2)


def _edges(cells: Sequence[Point], pitch_mm: float) -> list[LineString]:
    """Every edge of the hexagons once, in the order of the cells."""
    around = [
        (
            pitch_mm / math.sqrt(3) * math.cos(math.radians(60 * k)),
            pitch_mm / math.sqrt(3) * math.sin(math.radians(60 * k)),
        )
        for k in range(6)
    ]
    found: dict[Point, LineString] = {}
    for x, y in cells:
        corners = [(x + dx, y + dy) for dx, dy in around]
        for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
            middle = (
                round((start[0] + end[0]) / 2, 3) + 0.0,
                round((start[1] + end[1]) / 2, 3) + 0.0,
            )
            found.setdefault(middle, LineString([start, end]))
    return list(found.values())


def _among_cells(
    page: Page, edges: Sequence[LineString], pitch_mm: float
) -> tuple[PlacedComponent, ...]:
    """Parts with their references where there is room, and the outlines of the cells."""
    front, components = page.sides["front"], page.board.components
    lines = front.clipped(edges)
    rooms = _rooms(page, lines)
    shown = _of_parts(page, rooms)
    cells = [part for part in components if part.kind in AT_CELLS]
    at_cells, cut = _at_cells(page, cells, rooms["front"]), False
    if not at_cells:
        bare = front.taking(
            extent(shown[p.ref], "front")
            for p in components
            if p.ref in shown and p.side == "front"
        )
        at_cells = _through_outlines(page, cells, bare, pitch_mm)
        cut = bool(at_cells)
    if not at_cells:  # the ends of columns have the first choice: there are few places for them
        rooms = _rooms(page, lines)
        at_cells = _at_ends(page, cells, rooms["front"], pitch_mm)
        shown = _of_parts(page, rooms)
    shown |= at_cells
    named = tuple(
        _printed(page, part, shown[part.ref]) if part.ref in shown else part for part in components
    )
    page.lines("front", front.clipped(edges) if cut else lines)
    return named


def _rooms(page: Page, lines: Sequence[LineString]) -> dict[Side, Clear]:
    """Both sides with the outlines of the cells, to try where references fit."""
    half = page.rules.silk_line_mm / 2
    outlines = [line.buffer(half) for line in lines]
    return {"front": page.sides["front"].taking(outlines), "back": page.sides["back"].taking([])}


def _of_parts(page: Page, rooms: dict[Side, Clear]) -> _Places:
    """References of parts elsewhere than at cells, where there is room."""
    shown: _Places = {}
    for part in page.board.components:
        room = rooms[part.side]
        if part.kind in _SHOWN and (text := _place_of(page, part, room)):
            shown[part.ref] = text
            room.take(extent(text, part.side))
    return shown


def _at_cells(page: Page, cells: Sequence[PlacedComponent], room: Clear) -> _Places:
    """All of them, or none."""
    found = {part.ref: _place_of(page, part, room) for part in cells}
    return {ref: text for ref, text in found.items() if text} if all(found.values()) else {}


def _through_outlines(
    page: Page, cells: Sequence[PlacedComponent], room: Clear, pitch_mm: float
) -> _Places:
    """All of them, upright beside their parts and within their cells, or none; all at one side
    where that is possible."""
    found: _Places = {}
    angles = np.radians(60 * np.arange(6))
    corners = pitch_mm / np.sqrt(3) * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    for part in cells:
        hexagon = shapely.Polygon([(part.x_mm + dx, part.y_mm + dy) for dx, dy in corners])
        cell = hexagon.buffer(page.rules.silk_gap_mm)
        places = (
            page.text(part.ref, (part.x_mm + sign * off, part.y_mm), angle_deg=90.0)
            for sign in (-1, 1)
            for off in np.arange(0.0, pitch_mm / 2, _STEP_MM / 4).tolist()
        )
        free = (
            t for t in places if cell.contains(extent(t, "front")) and room.free(extent(t, "front"))
        )
        text = next(free, None)
        if text is None:
            return {}
        found[part.ref] = text
        room.take(extent(text, "front"))
    return found


def _at_ends(page: Page, cells: Sequence[PlacedComponent], room: Clear, pitch_mm: float) -> _Places:
    """References of the first and the last cell of each column, beyond it, where there is room."""
    columns: dict[float, list[PlacedComponent]] = defaultdict(list)
    for part in cells:
        columns[round(part.x_mm, 3)].append(part)
    found: _Places = {}
    for column in columns.values():
        ordered = sorted(column, key=lambda part: part.y_mm)
        for part, sign in ((ordered[-1], 1), (ordered[0], -1)):
            if part.ref in found:
                continue
            for text in _beyond(page, part, sign * pitch_mm / 2, sign):
                at = text.x_mm, text.y_mm
                own = min(cells, key=lambda cell: math.dist((cell.x_mm, cell.y_mm), at)) is part
                if own and room.free(extent(text, "front")):
                    found[part.ref] = text
                    room.take(extent(text, "front"))
                    break
    return found


def _beyond(page: Page, part: PlacedComponent, start_mm: float, sign: int) -> Iterator[Text]:
    """Places beyond a part that stands at the end of its column: upright, then level."""
    for angle in (90.0, 0.0):
        size = page.length_mm(part.ref) if angle else page.text("", (0.0, 0.0)).height_mm
        for off in np.arange(0.0, _BEYOND_MM, _STEP_MM).tolist():
            y = part.y_mm + start_mm + sign * (size / 2 + off)
            yield page.text(part.ref, (part.x_mm, y), angle_deg=angle)


def _place_of(page: Page, part: PlacedComponent, room: Clear) -> Text | None:
    """A free place for a part's reference, on the board."""
    yard, ref = _rectangle(courtyard(part)), part.ref
    half = page.text(ref, yard[0]).height_mm / 2
    choices = [page.text(ref, yard[0], 1.2)] if part.kind == "multiplexer" else []
    for closer in (0.0, 0.1, 0.2, 0.3, 0.4):
        away = half + page.rules.silk_gap_mm - closer
        choices += [
            page.beside(ref, *yard, way, away, upright=way in (LEFT, RIGHT))
            for way in (UP, DOWN, LEFT, RIGHT)
        ]
        choices.append(page.beside(ref, *yard, UP, half - closer, upright=True))
    free = (
        text
        for apart in (_APART_MM, 0.0)
        for text in choices
        if room.free(extent(text, part.side).buffer(apart))
    )
    return next(free, None)


def _printed(page: Page, part: PlacedComponent, text: Text) -> PlacedComponent:
    """A part with its reference at a place on the board, in its footprint's frame."""
    page.sides[part.side].take(extent(text, part.side))
    x, y = _in_footprint(part, (text.x_mm, text.y_mm))
    angle = text.angle_deg - part.angle_deg
    local = dataclasses.replace(
        text, text="", x_mm=x, y_mm=y, angle_deg=angle if part.side == "front" else -angle
    )
    return dataclasses.replace(part, ref_text=local)


def _in_footprint(part: PlacedComponent, at: Point) -> Point:
    """A place on the board in the frame of a part's footprint."""
    turn = np.radians(part.angle_deg)
    dx, dy = at[0] - part.x_mm, at[1] - part.y_mm
    x, y = dx * np.cos(turn) + dy * np.sin(turn), dy * np.cos(turn) - dx * np.sin(turn)
    return (-float(x) if part.side == "back" else float(x)), float(y)
