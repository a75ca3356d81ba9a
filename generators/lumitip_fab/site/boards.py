"""Boards as drawings: copper by net and layer, and parts, seen from the front."""

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
    layers = "".join(_layers(name, board, followed))
    drills = "".join(
        f'<circle class="drill" cx="{t.at[0] - across:.2f}" cy="{t.at[1] - down:.2f}" '
        f'r="{t.drill_mm / 2:.2f}"/>'
        for t in holes
    )
    parts = "".join(_parts(name, board.parts, followed))
    return (
        f'<svg class="board" data-board="{name}" viewBox="{view_box}" role="group" '
        f'aria-label="{escape(label)}">{laminate}{layers}{drills}{parts}</svg>'
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


def drawn_parts(board: KicadBoard) -> set[str]:
    """References of the parts that a drawing of the board has: those with pads."""
    return {part.ref for part in board.parts if _pads(part)}


def _pads(part: Part) -> list[BaseGeometry]:
    return [t.copper.area for t in part.terminals if t.copper is not None and t.number]


def _parts(name: str, parts: Sequence[Part], followed: Followed) -> Iterator[str]:
    """Parts with pads; those of cells can be chosen."""
    across, down = BOARD_ON_PAGE_MM
    for part in sorted(parts, key=lambda p: (p.ref in followed.parts, p.ref)):
        pads = _pads(part)
        if not pads:
            continue
        body = shapely.minimum_rotated_rectangle(shapely.union_all(pads)).buffer(
            _ROOM_MM, join_style="mitre"
        )
        x, y = part.at[0] - across, part.at[1] - down
        side = "" if part.front else " behind"
        marks = f'data-part="{name}.{escape(part.ref)}"'
        cell = followed.parts.get(part.ref)
        title = f"<title>{escape(part.ref)} {escape(part.value)}</title>"
        drawn = f'<path d="{path(body)}"/>'
        if cell is None:
            yield f'<g class="part{side}" {marks}>{title}{drawn}</g>'
            continue
        yield (
            f'<g class="part cell" {marks} data-cell="{cell}" '
            f'aria-label="Cell {cell}: {escape(part.ref)}">{drawn}'
            f'<text x="{x:.2f}" y="{y:.2f}">{cell}</text></g>'
        )


def path(area: BaseGeometry) -> str:
    """The contours of an area on a board's page, moved to the board's frame, y down."""
    pieces = shapely.get_parts(area)
    shown = pieces[(shapely.get_type_id(pieces) == _POLYGON) & (shapely.area(pieces) > _LEAST_MM2)]
    rings = shapely.simplify(shapely.get_rings(shown), _NEAR_MM, preserve_topology=False)
    outlines = (shapely.get_coordinates(ring)[:-1] - BOARD_ON_PAGE_MM for ring in rings)
    return "".join(f"M{_points(points)}Z" for points in outlines if len(points) > 2)


def _points(points: NDArray[np.float64]) -> str:
    return " ".join(f"{x:.2f},{y:.2f}".replace("-0.00", "0.00") for x, y in points.tolist())
