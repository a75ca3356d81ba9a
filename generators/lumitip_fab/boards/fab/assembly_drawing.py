"""Assembly drawing of a board's side: every part with its reference and its mark."""

from xml.sax.saxutils import escape, quoteattr

import shapely
from shapely.geometry.base import BaseGeometry

from lumitip_fab.boards.fab.svg_path import corners, disc, mirrored, path_of, short
from lumitip_fab.boards.fab.ways import MARKED_END, MARKED_FIRST
from lumitip_fab.boards.model import SIDES, PlacedComponent, Placement
from lumitip_fab.boards.outline import outline_area
from lumitip_fab.boards.placed import placed, placed_pads
from lumitip_fab.boards.silk.strokes import silkscreen, upright
from lumitip_fab.design import Box, Point, Side

SCALE = 4.0
"""Of the drawing, against the board."""
_INK, _PRINT, _COPPER = "#1a1a1a", "#8b939b", "#e3cf97"
_MARGIN_MM, _LINE_MM, _PRINT_MM = 1.0, 0.06, 0.1
_END = 0.24  # of a body, that is dark at the marked end
_DOT_MM, _DOT = 0.25, 0.12
"""Radius of the dot at lead 1, at most, and as a share of the body's shorter side."""
_LETTER, _FILLED, _MOST_LETTER_MM = 0.66, 0.78, 1.6
"""Width of a letter and the share of a body that it fills, in heights; and its height at most."""
_ARC = 6  # chords of a quarter circle
_DECIMALS = 2


def assembly_drawings(board: Placement) -> dict[str, bytes]:
    """Drawing of the front, and of the back where parts are on it, as SVG by their names."""
    sides = [side for side in SIDES if side == "front" or _mounted(board, side)]
    return {f"{board.name}_assembly_{side}.svg": _drawing(board, side) for side in sides}


def _mounted(board: Placement, side: Side) -> list[PlacedComponent]:
    """Parts that somebody solders onto a side."""
    return [part for part in board.components if part.part and part.side == side]


def _drawing(board: Placement, side: Side) -> bytes:
    body, seen = outline_area(board), _Seen(side)
    holes = [disc(*at, diameter_mm, _ARC) for at, diameter_mm in board.unplated]
    parts = _mounted(board, side)
    reach = [shapely.box(*part.body_on_board.bounds_mm) for part in parts]
    left, low, right, high = seen.area(shapely.union_all([body, *reach]).buffer(_MARGIN_MM)).bounds
    wide, tall = right - left, high - low
    title = f"{board.title} {board.revision}, {board.name} board, {side}: where each part goes"
    drawn = [
        _path(
            seen,
            body - shapely.union_all(holes),
            f'id="board" fill="#fff" {_stroked(2 * _LINE_MM)}',
        ),
        _path(seen, _copper(board, side), f'fill="{_COPPER}"'),
        _printed(board, seen, side),
        *(_part(seen, part) for part in parts),
    ]
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{left:.3f} {-high:.3f} {wide:.3f} '
            f'{tall:.3f}" width="{SCALE * wide:.3f}mm" height="{SCALE * tall:.3f}mm" '
            'font-family="Helvetica, Arial, sans-serif">',
            f"<title>{escape(title)}</title>",
            *drawn,
            "</svg>\n",
        ]
    ).encode()


class _Seen:
    """A side as it is seen: from the back, x is mirrored."""

    def __init__(self, side: Side) -> None:
        self.side = side

    def area(self, area: BaseGeometry) -> BaseGeometry:
        return area if self.side == "front" else mirrored(area)

    def at(self, point: Point) -> Point:
        return point if self.side == "front" else (-point[0], point[1])

    def upright_deg(self, angle_deg: float) -> float:
        """An angle of a text, turned by half turns until it is read from below or the right."""
        turned = upright(angle_deg, self.side)
        return turned if self.side == "front" else -turned


def _part(seen: _Seen, part: PlacedComponent) -> str:
    """Body, mark and reference."""
    shape, line = part.footprint, _stroked(_LINE_MM)
    pieces = [_path(seen, _box(part, shape.body), f'fill="#fff" {line}')]
    if shape.shroud:
        pieces.append(_path(seen, _box(part, shape.shroud.box), f'fill="none" {line}'))
    if part.contacts:
        contacts = [pad.area for pad in placed_pads(part)]
        pieces.append(_path(seen, shapely.union_all(contacts), f'fill="{_COPPER}"'))
    mark, room = _mark(part)
    if mark is not None:
        pieces.append(_path(seen, mark, f'class="mark" fill="{_INK}"'))
    return f"<g id={quoteattr(part.ref)}>{''.join(pieces)}{_reference(seen, part, room)}</g>"


def _mark(part: PlacedComponent) -> tuple[BaseGeometry | None, Box]:
    """The mark at pad 1, as it is on the part; and what it leaves of the body."""
    shape, body = part.footprint, part.footprint.body
    if part.kind in MARKED_END:
        end = body.x_min_mm + _END * body.width_mm
        room = Box(end, body.x_max_mm, body.y_min_mm, body.y_max_mm)
        return _box(part, Box(body.x_min_mm, end, body.y_min_mm, body.y_max_mm)), room
    if part.kind == "header":
        first = next(pad.area for pad in placed_pads(part) if pad.pad.number == "1")
        return first, body
    if part.kind not in MARKED_FIRST:
        return None, body
    radius = min(_DOT_MM, _DOT * min(body.width_mm, body.length_mm))
    left, low, right, high = body.grown(-1.3 * radius).bounds_mm
    first_pad = shape.pads[0]
    at = min(max(first_pad.x_mm, left), right), min(max(first_pad.y_mm, low), high)
    return disc(*placed(part, *at), 2 * radius, _ARC), body


def _reference(seen: _Seen, part: PlacedComponent, room: Box) -> str:
    """Along the room, as high as it allows."""
    sides = sorted((room.width_mm, room.length_mm))
    size = min(_FILLED * sides[0], sides[1] / (_LETTER * len(part.ref)), _MOST_LETTER_MM)
    at = seen.at(placed(part, *room.centre_mm))
    along = part.angle_deg + (90.0 if room.length_mm > room.width_mm else 0.0)
    x, y, turned = (short(v, _DECIMALS) for v in (at[0], -at[1], -seen.upright_deg(along)))
    turn = f"translate({x} {y}) rotate({turned})"
    wide = _LETTER * len(part.ref) * size
    # Contacts lie under the letters.
    plate = (
        f'<rect x="{-wide / 2:.3f}" y="{-size / 2:.3f}" width="{wide:.3f}" height="{size:.3f}" '
        'fill="#fff"/>'
    )
    letters = (
        f'<text font-size="{size:.3f}" text-anchor="middle" x="0" y="{0.36 * size:.3f}" '
        f'fill="{_INK}">{escape(part.ref)}</text>'
    )
    return f'<g transform="{turn}">{plate * part.contacts}{letters}</g>'


def _copper(board: Placement, side: Side) -> BaseGeometry:
    """Pads of a side, without their drills."""
    pads = [p for part in board.components for p in placed_pads(part) if side in p.sides]
    drills = [disc(p.x_mm, p.y_mm, p.pad.drill_mm, _ARC) for p in pads if p.pad.drill_mm]
    return shapely.union_all([p.area for p in pads]) - shapely.union_all(drills)


def _printed(board: Placement, seen: _Seen, side: Side) -> str:
    """What is printed on a side, in a fine line."""
    lines = "".join(
        corners(map(seen.at, stroke.points), _DECIMALS)
        for where, stroke in silkscreen(board)
        if where == side
    )
    look = f'fill="none" stroke="{_PRINT}" stroke-width="{_PRINT_MM:g}" stroke-linecap="round"'
    return f'<path {look} d="{lines}"/>'


def _box(part: PlacedComponent, box: Box) -> BaseGeometry:
    """A rectangle of a footprint's frame in its place."""
    left, low, right, high = box.bounds_mm
    corners = ((left, low), (right, low), (right, high), (left, high))
    return shapely.Polygon([placed(part, *corner) for corner in corners])


def _stroked(width_mm: float) -> str:
    return f'stroke="{_INK}" stroke-width="{width_mm:g}" stroke-linejoin="round"'


def _path(seen: _Seen, area: BaseGeometry, look: str) -> str:
    return f'<path {look} fill-rule="evenodd" d="{path_of(seen.area(area), _DECIMALS)}"/>'
