"""Nets of a zip: pieces of copper in its Gerbers, joined by its plated holes, and the pads of the
board that lie on them."""

from collections import defaultdict
from collections.abc import Iterable, Iterator

import shapely
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import ReadBoard, lands
from lumitip_fab.checks.readers.gerber import Hole
from lumitip_fab.checks.result import Measurement, Subject

Pieces = tuple[shapely.STRtree, ...]
"""Connected areas of each copper layer, from front to back."""


def measure_nets(
    path: str, read: ReadBoard, copper: Iterable[BaseGeometry], plated: list[Hole]
) -> Iterator[Measurement]:
    """Nets that the copper leaves open, those that it joins, and pads without copper.

    Args:
        path: of the zip.
        read: its board.
        copper: area of the front and of the back.
        plated: its plated holes.
    """
    pieces = tuple(shapely.STRtree(shapely.get_parts(area)) for area in copper)
    owner = _joined(pieces, plated)
    nets: dict[str, set[int]] = defaultdict(set)
    labels: dict[int, set[str]] = defaultdict(set)
    bare = []
    layers = (read.board.layers[0], read.board.layers[-1])
    for part, terminal, land in lands(read.board):
        at, name = read.sensor([terminal.at])[0], f"{part.ref}.{terminal.number}"
        for side in (n for n, layer in enumerate(layers) if layer in land.layers):
            area = shapely.transform(land.area, read.sensor)
            point = area if terminal.drill_mm else shapely.Point(at)
            touched = pieces[side].query(point, predicate="intersects").tolist()
            if not touched:
                bare.append(name)
            net = terminal.net or name  # a pad of no net is alone
            for piece in touched:
                nets[net].add(owner[side, piece])
                labels[owner[side, piece]].add(net)
    of = Subject("orders", path)
    opened = sorted(
        f"{net} in {len(found)} pieces" for net, found in nets.items() if len(found) > 1
    )
    yield of.count("open", opened, "nets")
    joined = sorted(" and ".join(sorted(found)) for found in labels.values() if len(found) > 1)
    yield of.count("short", joined, "places")
    yield of.count("bare", sorted(bare), "pads without copper")


def _joined(pieces: Pieces, plated: list[Hole]) -> dict[tuple[int, int], int]:
    """A number for each piece, by layer and place in it: the same for what plated holes join."""
    every = [(side, n) for side, tree in enumerate(pieces) for n in range(len(tree))]
    owner = {piece: number for number, piece in enumerate(every)}
    for x, y, diameter in plated:
        hole = shapely.Point(x, y).buffer(diameter / 2)
        touched = [
            (side, n)
            for side, tree in enumerate(pieces)
            for n in tree.query(hole, predicate="intersects").tolist()
        ]
        numbers = {owner[piece] for piece in touched}
        if len(numbers) > 1:
            least = min(numbers)
            owner = {piece: least if n in numbers else n for piece, n in owner.items()}
    return owner
