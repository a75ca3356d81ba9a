"""Which tracks and vias the ground net still needs once the pour carries it."""

import dataclasses
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import networkx as nx
import numpy as np
import shapely
from networkx.algorithms.approximation import steiner_tree
from numpy.typing import NDArray

from lumitip_fab.boards.model import SIDES, Routing, Track, Via
from lumitip_fab.boards.placed import PlacedPad
from lumitip_fab.boards.pour.room import Sheet
from lumitip_fab.design import Point, Side
from lumitip_fab.errors import BuildError

STEP_MM = 0.5  # tracks are kept or left out in pieces of this length
VIA_MM = 1.0  # a via of the router counts as this much track,
STITCH_MM = 0.3  # and one through two pieces of pour as this


Thing = tuple[str, int] | tuple[str, Point]
"""A pad or a piece of pour by its number, or a place on a side."""
Copper = Via | tuple[Side, int, int, Track]
"""A via, or a piece of a track: which track, which piece of it, and where."""


@dataclass
class Net:
    """The ground net as a graph: pads, pieces of pour, and what may join them, by length."""

    graph: nx.Graph = field(default_factory=nx.Graph)
    numbers: dict[Thing, int] = field(default_factory=dict)
    """Node of each thing."""

    def node(self, thing: Thing) -> int:
        """The number of a thing, which is added when it is new."""
        number = self.numbers.setdefault(thing, len(self.numbers))
        self.graph.add_node(number)
        return number

    def join(self, a: Thing, b: Thing, length_mm: float, by: Copper | None = None) -> None:
        """Let two things be joined by a track or a via, or by touch."""
        first, second = self.node(a), self.node(b)
        if not self.graph.has_edge(first, second):
            self.graph.add_edge(first, second, weight=round(length_mm, 6), by=by)


@dataclass(frozen=True)
class Kept:
    """Remaining copper of the ground net."""

    tracks: tuple[Track, ...]
    vias: tuple[Via, ...]
    pieces: dict[Side, tuple[int, ...]]
    """Pieces of pour that are joined to its pads."""


def needed(
    pads: list[PlacedPad], sheets: dict[Side, Sheet], routing: Routing, stitches: Iterable[Via]
) -> Kept:
    """The shortest copper that joins all ground pads, with the pour for nothing.

    Args:
        pads: of the ground net.
        sheets: the pour of each side, with the bridges of those of the pads that are on it.
        routing: tracks and vias of the ground net that join all of its pads.
        stitches: vias that could be added.

    Raises:
        BuildError: a pad is not joined to the others.
    """
    net = Net()
    terminals = [net.node(("pad", i)) for i in range(len(pads))]
    _pads(net, pads, sheets)
    _copper(net, pads, sheets, routing)
    _vias(net, sheets, routing.vias, VIA_MM)
    _vias(net, sheets, _one_for_each_pair(sheets, tuple(stitches)), STITCH_MM)
    whole = nx.node_connected_component(net.graph, terminals[0])
    for pad, terminal in zip(pads, terminals, strict=True):
        if terminal not in whole:
            raise BuildError(
                f"pad {pad.component.ref}.{pad.pad.number} at ({pad.x_mm:.2f}, {pad.y_mm:.2f}) mm "
                f"is not joined to net {pad.net}: route the board before its pour"
            )
    # Taken out in place: a view of a part of the graph makes the search several times slower.
    net.graph.remove_nodes_from([node for node in net.graph if node not in whole])
    tree = steiner_tree(net.graph, terminals, weight="weight", method="mehlhorn")
    return _kept(net, tree, sheets)


def _pads(net: Net, pads: list[PlacedPad], sheets: dict[Side, Sheet]) -> None:
    """Join pads with the pieces of pour that they are bridged to, in the order of each sheet."""
    for side, sheet in sheets.items():
        on_side = [i for i, pad in enumerate(pads) if side in pad.sides]
        for i, pieces in zip(on_side, sheet.reached, strict=True):
            for piece in pieces:
                net.join(("pad", i), (side, piece), 0.0)


def _copper(net: Net, pads: list[PlacedPad], sheets: dict[Side, Sheet], routing: Routing) -> None:
    """Tracks in short pieces, and what their ends touch."""
    for side in SIDES:
        tracks = [t for t in routing.tracks if t.side == side]
        joints = {at for t in tracks for at in (t.start, t.end)}
        joints |= {(v.x_mm, v.y_mm) for v in routing.vias}
        ordered = sorted(joints)
        spots = shapely.points(np.array(ordered).reshape(-1, 2))
        ends = [_cut(track, ordered, spots) for track in tracks]
        for index, (track, points) in enumerate(zip(tracks, ends, strict=True)):
            for part, (a, b) in enumerate(pairwise(points)):
                piece = dataclasses.replace(track, start=a, end=b)
                by = (side, index, part, piece)
                net.join((side, a), (side, b), math.dist(a, b), by)
        places = [at for points in ends for at in points]
        pieces, over = sheets[side].pieces_at(places), _over(pads, side, places)
        for at, found, touched in zip(places, pieces, over, strict=True):
            if found >= 0:
                net.join((side, at), (side, found), 0.0)
            for i in touched:
                net.join((side, at), ("pad", i), 0.0)


def _vias(net: Net, sheets: dict[Side, Sheet], vias: tuple[Via, ...], length_mm: float) -> None:
    """Vias, and the pieces of pour round them."""
    places = [(v.x_mm, v.y_mm) for v in vias]
    for via, at in zip(vias, places, strict=True):
        net.join(("front", at), ("back", at), length_mm, via)
    for side in SIDES:
        for at, found in zip(places, sheets[side].pieces_at(places), strict=True):
            if found >= 0:
                net.join((side, at), (side, found), 0.0)


def _one_for_each_pair(sheets: dict[Side, Sheet], vias: tuple[Via, ...]) -> tuple[Via, ...]:
    """The first of all vias that join the same two pieces of pour: the others do no more."""
    places = [(v.x_mm, v.y_mm) for v in vias]
    pairs = zip(*(sheets[side].pieces_at(places) for side in SIDES), strict=True)
    first: dict[tuple[int, ...], Via] = {}
    for via, pair in zip(vias, pairs, strict=True):
        if min(pair) >= 0:
            first.setdefault(pair, via)
    return tuple(first.values())


def _over(pads: list[PlacedPad], side: Side, places: list[Point]) -> list[list[int]]:
    """The pads of a side over each place."""
    on_side = [i for i, pad in enumerate(pads) if side in pad.sides]
    tree = shapely.STRtree([pads[i].area for i in on_side])
    spots = shapely.points(np.array(places).reshape(-1, 2))
    found: list[list[int]] = [[] for _ in places]
    for place, pad in sorted(zip(*tree.query(spots, predicate="covered_by").tolist(), strict=True)):
        found[place].append(on_side[pad])
    return found


def _cut(track: Track, joints: Sequence[Point], spots: NDArray[np.object_]) -> list[Point]:
    """Ends of the short pieces of a track: on the grid that it is on, and where others join it.

    Args:
        track: to cut.
        joints: where others end.
        spots: the joints once more, as points to measure from.
    """
    run = [b - a for a, b in zip(track.start, track.end, strict=True)]
    reach = max(map(abs, run))
    steps = np.arange(1, math.ceil(reach / STEP_MM - 1e-6)) * STEP_MM / reach
    inner = [tuple(a + d * t for a, d in zip(track.start, run, strict=True)) for t in steps]
    line = shapely.LineString([track.start, track.end])
    inner += [joints[i] for i in np.flatnonzero(shapely.distance(spots, line) < 1e-6).tolist()]
    places = {(round(float(x), 3), round(float(y), 3)) for x, y in inner} | {track.start, track.end}
    return sorted(places, key=lambda at: math.dist(at, track.start))


def _kept(net: Net, tree: nx.Graph, sheets: dict[Side, Sheet]) -> Kept:
    """The copper of the edges of a tree, and the pieces of pour that it reaches."""
    used = [by for _, _, by in tree.edges.data("by") if by is not None]
    vias = sorted((v for v in used if isinstance(v, Via)), key=lambda v: (v.x_mm, v.y_mm))
    pieces = sorted((p for p in used if not isinstance(p, Via)), key=lambda p: p[:3])
    tracks: list[Track] = []
    for k, (side, index, part, track) in enumerate(pieces):
        follows = k > 0 and pieces[k - 1][:3] == (side, index, part - 1)
        start = tracks.pop().start if follows else track.start
        tracks.append(dataclasses.replace(track, start=start))
    reached = {
        side: {piece for found in sheet.reached for piece in found}
        for side, sheet in sheets.items()
    }
    things = {number: thing for thing, number in net.numbers.items()}
    for thing in (things[number] for number in tree.nodes):
        if thing[0] in reached and isinstance(thing[1], int):
            reached[thing[0]].add(thing[1])
    for side, sheet in sheets.items():
        copper: list[shapely.Geometry] = [shapely.Point(via.x_mm, via.y_mm) for via in vias]
        copper += [shapely.LineString([t.start, t.end]) for t in tracks if t.side == side]
        cores = np.array(copper, dtype=object)
        touched = shapely.STRtree(sheet.pieces).query(cores, predicate="intersects")[1]
        reached[side].update(touched.tolist())
    return Kept(tuple(tracks), tuple(vias), {s: tuple(sorted(p)) for s, p in reached.items()})
