"""Boards as drawings, seen from the front: copper by net and layer, openings of the solder mask,
silkscreen, and parts with their references and pads."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.readers.kicad_board import KicadBoard, Part
from lumitip_fab.design.frames import BOARD_ON_PAGE_MM

_NEAR_MM = 0.01  # of a drawn contour from the copper
_LEAST_MM2 = 0.002
_CLOSED_MM = 0.001  # between ends of lines of the outline that meet
_MARGIN_MM = 0.8
_ROOM_MM = 0.25  # from pads to the border of a part
_LETTERS_MM = 0.7  # references beside cells and numbers of pads, if there is room
_CELL_MM = 1.5  # numbers of cells
_WIDE = 0.7  # of a letter over its size
_CAPITALS = 1.4  # size of a font over the height of its capitals
_POLYGON = 3  # of shapely's types


@dataclass(frozen=True)
class Followed:
    """Parts and nets of a board that belong to one cell alone."""

    parts: Mapping[str, int]
    """Cell of each part, by reference."""
    nets: Mapping[str, int]
    """Cell of each net."""


def board_svg(name: str, board: KicadBoard, label: str, followed: Followed) -> str:
    """A board as SVG; its colours are those of the page's classes.

    Args:
        name: of the board, for the names of its parts and nets.
        board: the board.
        label: what it shows, in words.
        followed: parts and nets of cells.

    Raises:
        ValueError: if the board has no closed outline.
    """
    outline = _outline(board)
    holes = [t for p in board.parts for t in p.terminals if t.drill_mm]
    across, down = BOARD_ON_PAGE_MM
    left, top, right, bottom = shapely.total_bounds([outline])
    box = (left - across - _MARGIN_MM, top - down - _MARGIN_MM)
    size = (right - left + 2 * _MARGIN_MM, bottom - top + 2 * _MARGIN_MM)
    view_box = " ".join(f"{v:.2f}" for v in (*box, *size))
    laminate = f'<path class="laminate" d="{path(outline)}"/>'
    layers = f'<g class="copper">{"".join(_layers(name, board, followed))}</g>'
    drills = "".join(
        f'<circle class="drill" cx="{t.at[0] - across:.2f}" cy="{t.at[1] - down:.2f}" '
        f'r="{t.drill_mm / 2:.2f}"/>'
        for t in holes
    )
    parts = "".join(_parts(name, board.parts, followed))
    return (
        f'<svg class="board" data-board="{name}" viewBox="{view_box}" role="group" '
        f'aria-label="{escape(label)}"><g class="sheet">{laminate}{layers}{drills}'
        f"{''.join(_finish(board))}{parts}</g></svg>"
    )


def _outline(board: KicadBoard) -> BaseGeometry:
    """The board: what its outline encloses, without what inner outlines enclose."""
    edges = shapely.set_precision(np.array(board.edges, dtype=object), _CLOSED_MM)
    rings = shapely.get_parts(shapely.polygonize([shapely.union_all(edges)]))
    if not len(rings):
        raise ValueError("it has no closed outline")
    return max(rings, key=lambda ring: float(ring.area))


def _layers(name: str, board: KicadBoard, followed: Followed) -> Iterator[str]:
    """Copper of each layer, the back first: it is seen through the board."""
    for layer in reversed(board.layers):
        nets: dict[str, list[BaseGeometry]] = {}
        fills: dict[str, list[BaseGeometry]] = {}
        for piece in board.copper():
            if layer in piece.layers:
                kind = fills if piece.kind == "fill" else nets
                kind.setdefault(piece.net, []).append(piece.area)
        drawn = [_net(name, net, fills[net], followed, "fill") for net in sorted(fills)]
        drawn += [_net(name, net, nets[net], followed, "net") for net in sorted(nets)]
        side = {board.layers[0]: "front", board.layers[-1]: "back"}.get(layer, "inner")
        yield f'<g class="layer {side}" data-layer="{escape(layer)}">{"".join(drawn)}</g>'


def _net(name: str, net: str, areas: Sequence[BaseGeometry], followed: Followed, kind: str) -> str:
    cell = f' data-follow="{followed.nets[net]}"' if net in followed.nets else ""
    return (
        f'<path class="{kind}" data-net="{name}:{escape(net)}"{cell} '
        f'd="{path(shapely.union_all(list(areas)))}"/>'
    )


def _finish(board: KicadBoard) -> Iterator[str]:
    """Openings of the solder mask and silkscreen of each side."""
    for front, side in ((True, "front"), (False, "back")):
        free = shapely.union_all([o.area for o in board.openings if o.front == front])
        drawn = shapely.union_all([line.area for line in board.silk.lines if line.front == front])
        # Text on the back is mirrored in the file; the drawing is when it is seen from there.
        words = "".join(
            _text(word.at, word.text, _CAPITALS * word.height_mm, word.angle_deg * (1 - 2 * front))
            for word in board.silk.words
            if word.front == front
        )
        yield f'<path class="openings" data-side="{side}" d="{path(free)}"/>'
        yield f'<g class="silk" data-side="{side}"><path d="{path(drawn)}"/>{words}</g>'


def _text(at: tuple[float, float], text: str, size_mm: float, turn_deg: float = 0.0) -> str:
    """A text about its middle, on a board's page."""
    x, y = at[0] - BOARD_ON_PAGE_MM[0], at[1] - BOARD_ON_PAGE_MM[1]
    turn = f";--turn:{turn_deg:g}deg" if turn_deg else ""
    style = f"font-size:{size_mm:.2f}px{turn}"
    return f'<text x="{x:.2f}" y="{y:.2f}" style="{style}">{escape(text)}</text>'


def drawn_parts(board: KicadBoard) -> set[str]:
    """References of the parts that a drawing of the board has: those with pads."""
    return {part.ref for part in board.parts if _pads(part)}


def _pads(part: Part) -> list[BaseGeometry]:
    return [t.copper.area for t in part.terminals if t.copper is not None and t.number]


def _parts(name: str, parts: Sequence[Part], followed: Followed) -> Iterator[str]:
    """Parts with pads; those of cells can be chosen."""
    for part in sorted(parts, key=lambda p: (p.ref in followed.parts, p.ref)):
        pads = _pads(part)
        if not pads:
            continue
        body = shapely.minimum_rotated_rectangle(shapely.union_all(pads)).buffer(
            _ROOM_MM, join_style="mitre"
        )
        side = "" if part.front else " behind"
        marks = f'data-part="{name}.{escape(part.ref)}"'
        cell = followed.parts.get(part.ref)
        title = f"<title>{escape(part.ref)} {escape(part.value)}</title>"
        drawn = f'<path d="{path(body)}"/>{"".join(_numbers(part))}'
        if cell is None:
            yield f'<g class="part{side}" {marks}>{title}{drawn}{_reference(part, body)}</g>'
            continue
        left, _, right, bottom = body.bounds
        below = ((left + right) / 2, bottom + _LETTERS_MM / 2)
        yield (
            f'<g class="part cell" {marks} data-cell="{cell}" '
            f'aria-label="Cell {cell}: {escape(part.ref)}">{drawn}'
            f"{_text(below, part.ref, _LETTERS_MM)}{_text(part.at, str(cell), _CELL_MM)}</g>"
        )


def _reference(part: Part, body: BaseGeometry) -> str:
    """The reference in the middle of a part, along its longer side."""
    left, top, right, bottom = body.bounds
    wide, high = sorted((right - left, bottom - top), reverse=True)
    size = min(_CELL_MM, 0.6 * high, wide / (_WIDE * max(len(part.ref), 1)))
    turn = -90.0 if bottom - top > right - left else 0.0
    return _text(((left + right) / 2, (top + bottom) / 2), part.ref, size, turn)


def _numbers(part: Part) -> Iterator[str]:
    """Numbers of the pads."""
    for terminal in part.terminals:
        if terminal.copper is None or not terminal.number:
            continue
        left, top, right, bottom = terminal.copper.area.bounds
        size = min(_LETTERS_MM, 0.9 * (bottom - top), (right - left) / _WIDE / len(terminal.number))
        yield _text(terminal.at, terminal.number, size).replace("<text", '<text class="pin"')


def path(area: BaseGeometry) -> str:
    """The contours of an area on a board's page, moved to the board's frame, y down."""
    pieces = shapely.get_parts(area)
    shown = pieces[(shapely.get_type_id(pieces) == _POLYGON) & (shapely.area(pieces) > _LEAST_MM2)]
    rings = shapely.simplify(shapely.get_rings(shown), _NEAR_MM, preserve_topology=False)
    outlines = (shapely.get_coordinates(ring)[:-1] - BOARD_ON_PAGE_MM for ring in rings)
    return "".join(f"M{_points(points)}Z" for points in outlines if len(points) > 2)


def _points(points: NDArray[np.float64]) -> str:
    return " ".join(f"{x:.2f},{y:.2f}".replace("-0.00", "0.00") for x, y in points.tolist())
