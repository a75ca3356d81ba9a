"""Ways along the ground copper of a board: where tracks cut a plane into pieces, it still joins all
pads, but round about."""

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import lands
from lumitip_fab.checks.readers.kicad_board import Copper, KicadBoard

STEP_MM = 0.25
"""Between the points of a way. It turns by 45 degrees only, and so is up to 8 % too long."""
_LINK_MM = 1.5 * STEP_MM
_TRIED = (0.25, 0.5, 0.75)
"""Of a link, where copper must be: nearer together than any gap is wide."""
_THROUGH_MM = 1.6
"""Of a hole's wall, which counts as much way."""
_GROUND = "GND"
_Points = NDArray[np.float64]


def ground_ways_mm(board: KicadBoard, start: str, ends: str) -> dict[str, float]:
    """The shortest way from each ground pad of some parts to the nearest of others.

    Args:
        board: the board.
        start: first letter of the parts from which.
        ends: first letter of the others.

    Returns:
        Ways in mm, by names of pads such as `U1.8`; infinite where none leads.
    """
    pads = [
        (f"{part.ref}.{terminal.number}", copper)
        for part, terminal, copper in lands(board)
        if terminal.net == _GROUND
    ]
    ways, goals = _Ways(board), [copper for name, copper in pads if name[0] == ends]
    return {
        name: float(ways.shortest_mm(copper, goals).min())
        for name, copper in pads
        if name[0] == start
    }


class _Ways:
    """Points on the ground copper of all layers, and the links between neighbours."""

    def __init__(self, board: KicadBoard) -> None:
        copper = [piece for piece in board.copper() if piece.net == _GROUND]
        self._of: dict[int, list[int]] = {}
        """Points at the middle of each pad and via, one for each layer."""
        found: list[tuple[_Points, NDArray[np.int64]]] = []
        count = 0
        for layer in board.layers:
            here = [piece for piece in copper if layer in piece.layers]
            if not here:
                continue
            marks = [piece for piece in here if piece.kind in ("pad", "via")]
            for number, piece in enumerate(marks, start=count):
                self._of.setdefault(id(piece), []).append(number)
            whole = shapely.union_all([piece.area for piece in here])
            middles = [shapely.get_coordinates(piece.area.centroid) for piece in marks]
            tracks = [_along(piece) for piece in here if piece.kind == "track"]
            points = np.concatenate([*middles, *tracks, _grid(whole)])
            lengths, pairs = _links(points, whole)
            found.append((lengths, pairs + count))
            count += len(points)
        through = [pair for points in self._of.values() for pair in pairwise(points)]
        found.append(
            (np.full(len(through), _THROUGH_MM), np.array(through, dtype=np.int64).reshape(-1, 2))
        )
        lengths, pairs = (np.concatenate(each) for each in zip(*found, strict=True))
        self._links = coo_array((lengths, pairs.T), shape=(count, count)).tocsr()

    def shortest_mm(self, start: Copper, ends: Sequence[Copper]) -> _Points:
        """Ways from a pad to others, shape `(n,)`; infinite where none leads."""
        far = dijkstra(self._links, directed=False, indices=self._of[id(start)][0])
        return np.asarray(far[[self._of[id(end)][0] for end in ends]], dtype=np.float64)


def _along(track: Copper) -> _Points:
    """Points along the middle of a track, which may be narrower than the grid; shape `(n, 2)`."""
    a, b, c, d = shapely.get_coordinates(track.area.minimum_rotated_rectangle)[:4]
    ends = (
        ((a + b) / 2, (c + d) / 2)
        if math.dist(a, b) < math.dist(b, c)
        else ((b + c) / 2, (d + a) / 2)
    )
    length = math.dist(*ends)
    share = track.width_mm / 2 / length
    steps = np.linspace(share, 1 - share, math.ceil(length / STEP_MM) + 1)[:, None]
    return np.asarray(ends[0] + (ends[1] - ends[0]) * steps, dtype=np.float64)


def _grid(area: BaseGeometry) -> _Points:
    """Whole multiples of the step within an area, shape `(n, 2)`."""
    x_min, y_min, x_max, y_max = np.array(area.bounds) / STEP_MM
    x, y = np.meshgrid(np.arange(math.ceil(x_min), x_max), np.arange(math.ceil(y_min), y_max))
    points = np.stack([x.ravel(), y.ravel()], axis=1) * STEP_MM
    shapely.prepare(area)
    inside = shapely.contains_xy(area, points[:, 0], points[:, 1])
    return np.asarray(points[inside], dtype=np.float64)


def _links(points: _Points, area: BaseGeometry) -> tuple[_Points, NDArray[np.int64]]:
    """Lengths of the links within an area, shape `(n,)`, and their ends, shape `(n, 2)`."""
    pairs = cKDTree(points).query_pairs(_LINK_MM, output_type="ndarray")
    start, run = points[pairs[:, 0]], points[pairs[:, 1]] - points[pairs[:, 0]]
    shapely.prepare(area)
    held = np.ones(len(pairs), dtype=bool)
    for part in _TRIED:
        held &= shapely.intersects_xy(area, *(start + part * run).T)
    return np.hypot(*run[held].T), pairs[held].astype(np.int64)
