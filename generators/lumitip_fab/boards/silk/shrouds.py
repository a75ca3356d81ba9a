"""Shrouds of right-angle box headers on the silkscreen: outline, notch, way of the plug."""

from collections.abc import Iterator

from shapely import LineString

from lumitip_fab.boards.model import PlacedComponent
from lumitip_fab.boards.placed import placed
from lumitip_fab.boards.silk.page import Page
from lumitip_fab.design import Point, Shroud

_HEAD_MM, _SHAFT_MM = 0.6, 1.6  # of the arrow: each side of its head, and its length
_STEP_MM = 0.25
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
    out = 1.0 if shroud.facing == "north" else -1.0
    x, y = shroud.box.centre_mm
    depth = shroud.box.length_mm
    for whole in (True, False):
        for k in range(int(depth / _STEP_MM)):
            tip = y + out * (depth / 2 - k * _STEP_MM)
            low = tip - out * _HEAD_MM
            head = ((x - _HEAD_MM, low), (x, tip), (x + _HEAD_MM, low))
            shaft = ((x, tip), (x, tip - out * _SHAFT_MM))
            yield [_on_board(part, line) for line in ((head, shaft) if whole else (head,))]


def _on_board(part: PlacedComponent, points: tuple[Point, ...]) -> LineString:
    return LineString([placed(part, *point) for point in points])
