"""Connections from the copper itself, not from the names of nets."""

from collections import defaultdict
from collections.abc import Iterator

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.readers.kicad_board import Copper, KicadBoard

TOUCH_MM = 1e-5
_STRETCH = 12  # edges
Pairs = NDArray[np.int64]


class Clusters:
    """The pieces of copper of a board, in groups that are connected."""

    def __init__(self, board: KicadBoard) -> None:
        self.pieces = tuple(board.copper())
        self.layers = board.layers
        count = len(self.pieces)
        found = [pairs for _, pairs in self.near(TOUCH_MM)]
        a, b = np.concatenate([np.empty((0, 2), dtype=np.int64), *found]).T
        links = coo_array((np.ones(a.size), (a, b)), shape=(count, count))
        _, labels = connected_components(links, directed=False)
        self.label: NDArray[np.int64] = np.asarray(labels, dtype=np.int64)
        self._of = {id(piece): int(label) for piece, label in zip(self.pieces, labels, strict=True)}

    def of(self, piece: Copper) -> int:
        """Number of the group that a piece belongs to."""
        return self._of[id(piece)]

    def near(self, distance_mm: float) -> Iterator[tuple[str, Pairs]]:
        """Pairs of pieces, shape `(n, 2)`, no farther apart than this on a layer."""
        for layer in self.layers:
            here = np.array([i for i, p in enumerate(self.pieces) if layer in p.layers], dtype=int)
            areas = np.array([self.pieces[i].area for i in here], dtype=object)
            yield layer, here[_pairs(areas, distance_mm)]

    def gaps(self, within_mm: float) -> Iterator[tuple[float, Copper, Copper]]:
        """Pieces that are not connected but nearer than this, with their distance.

        Fills have very many corners: of those, short stretches of the edge are held against the
        others.
        """
        for layer in self.layers:
            here = [(i, p) for i, p in enumerate(self.pieces) if layer in p.layers]
            cut = [(i, part) for i, p in here for part in _stretches(p)]
            which = np.array([i for i, _ in cut], dtype=int)
            shapes = np.array([part for _, part in cut], dtype=object)
            a, b = _pairs(shapes, within_mm).T
            apart = self.label[which[a]] != self.label[which[b]]
            a, b = a[apart], b[apart]
            for gap, i, j in zip(
                shapely.distance(shapes[a], shapes[b]), which[a], which[b], strict=True
            ):
                yield float(gap), self.pieces[i], self.pieces[j]

    def nets(self) -> dict[int, set[str]]:
        """The net names in each group; copper without a name has none."""
        found: dict[int, set[str]] = defaultdict(set)
        for label, piece in zip(self.label, self.pieces, strict=True):
            found[int(label)].update({piece.net} - {""})
        return found

    def groups(self) -> dict[str, set[int]]:
        """The groups that hold pads of each net: more than one where it is open."""
        found: dict[str, set[int]] = defaultdict(set)
        for label, piece in zip(self.label, self.pieces, strict=True):
            if piece.kind == "pad" and piece.net:
                found[piece.net].add(int(label))
        return found


def _pairs(shapes: NDArray[np.object_], distance_mm: float) -> Pairs:
    """Pairs of shapes no farther apart than this, shape `(n, 2)`, the smaller number first."""
    if not shapes.size:
        return np.empty((0, 2), dtype=np.int64)
    shapely.prepare(shapes)
    a, b = shapely.STRtree(shapes).query(shapes, predicate="dwithin", distance=distance_mm)
    return np.asarray(np.stack([a, b], axis=1)[a < b])


def _stretches(piece: Copper) -> list[BaseGeometry]:
    """The piece itself; of a fill its edge, cut up."""
    if piece.kind != "fill":
        return [piece.area]
    rings = [shapely.get_coordinates(ring) for ring in shapely.get_rings(piece.area)]
    return [
        shapely.LineString(ring[i : i + _STRETCH + 1])
        for ring in rings
        for i in range(0, len(ring) - 1, _STRETCH)
    ]
