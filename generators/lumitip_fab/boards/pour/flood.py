"""The ground pour: filled areas on both sides, and the vias that make them one."""

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry

from lumitip_fab.boards.model import SIDES, Fill, NetClass, Placement, Routing, Track, Via
from lumitip_fab.boards.placed import PlacedPad, bypass_pads, placed_pads
from lumitip_fab.boards.pour.beside import beside
from lumitip_fab.boards.pour.room import MARGIN_MM, Sheet, room, sheet, via_room
from lumitip_fab.boards.route.kernels import kernel
from lumitip_fab.boards.verify import DRILL_WALL_MM
from lumitip_fab.design import Point, Side

LATTICE_MM = 0.5  # places tried
APART_MM = 6.0  # between stitching vias, where there is room
_APART_MM = 0.01  # round pieces of pour that are left out


def candidates(placement: Placement, room: Geometry, front: Geometry, back: Geometry) -> list[Via]:
    """Vias that could join a piece of pour on the front with one on the back.

    Args:
        placement: the board.
        room: where the middle of a via may be.
        front: pour of one side.
        back: pour of the other.
    """
    both = shapely.intersection(shapely.intersection(front, back), room)
    places: list[Point] = []
    for part in shapely.get_parts(both):
        if part.area < 1e-6:
            continue
        inside = part.representative_point()
        places += _lattice(part) or [(round(inside.x, 3), round(inside.y, 3))]
    kind = _kind(placement)
    return [
        Via(placement.ground, x, y, kind.via_mm, kind.via_drill_mm)
        for x, y in spread(places, (), kind.via_drill_mm + DRILL_WALL_MM + MARGIN_MM)
    ]


def spread(places: Sequence[Point], taken: Sequence[Point], apart_mm: float) -> list[Point]:
    """Places in their order, without those too near to one before them or to a taken one."""
    every = np.array([*taken, *places]).reshape(-1, 2)
    if not every.size:
        return []
    kept = _thinned(every, np.floor((every - every.min(axis=0)) / apart_mm), len(taken), apart_mm)
    return [at for at, keeps in zip(places, kept[len(taken) :].tolist(), strict=True) if keeps]


@kernel
def _thinned(
    places: NDArray[np.float64], cells: NDArray[np.float64], taken: int, apart_mm: float
) -> NDArray[np.bool_]:
    """Which places stay, the first ones in any case.

    Args:
        places: `(n, 2)`, in mm.
        cells: `(n, 2)`: column and row of the square of `apart_mm` that each is in, from 0.
        taken: number of those that stay in any case.
        apart_mm: least distance.
    """
    width, height = int(cells[:, 0].max()) + 3, int(cells[:, 1].max()) + 3
    last = np.full(width * height, -1)  # last kept place of each square
    before = np.full(len(places), -1)  # kept place before it in the same square
    kept = np.ones(len(places), dtype=np.bool_)
    for i in range(len(places)):
        square = (int(cells[i, 1]) + 1) * width + int(cells[i, 0]) + 1
        for near in (square - width, square, square + width):
            for j in (last[near - 1], last[near], last[near + 1]):
                while j >= 0 and i >= taken and kept[i]:
                    dx, dy = places[j, 0] - places[i, 0], places[j, 1] - places[i, 1]
                    kept[i] = dx * dx + dy * dy >= apart_mm * apart_mm
                    j = before[j]  # noqa: PLW2901 - on to the next one in the square
        if kept[i]:
            before[i], last[square] = last[square], i
    return kept


def _kind(placement: Placement) -> NetClass:
    """The class whose vias are smallest."""
    return min(placement.classes, key=lambda c: c.via_mm)


def _lattice(part: Geometry) -> list[Point]:
    """Whole multiples of the lattice inside an area."""
    x_min, y_min, x_max, y_max = part.bounds
    x = np.arange(math.ceil(x_min / LATTICE_MM), math.floor(x_max / LATTICE_MM) + 1) * LATTICE_MM
    y = np.arange(math.ceil(y_min / LATTICE_MM), math.floor(y_max / LATTICE_MM) + 1) * LATTICE_MM
    if not (x.size and y.size):
        return []
    across, along = (a.ravel() for a in np.meshgrid(x, y))
    shapely.prepare(part)
    inside = shapely.contains_xy(part, across, along)
    return list(zip(across[inside].tolist(), along[inside].tolist(), strict=True))


def pour(
    placement: Placement, routing: Routing
) -> tuple[Routing, tuple[Fill, ...], frozenset[tuple[str, str]]]:
    """Fill both sides with ground.

    Args:
        placement: the board.
        routing: tracks and vias that connect every net, ground too.

    Returns:
        The routing with stitching vias; the pour, without pieces that nothing joins to ground; and
        the pads that it joins all round. Areas are polygons on whole micrometres.

    The tracks of ground stay, though the pour joins their ends, too: it may do so round the whole
    board, and a multiplexer's capacitor is there for the short way.
    """
    pads = [
        pad
        for component in placement.components
        for pad in placed_pads(component)
        if pad.net == placement.ground
    ]
    if not pads:
        return routing, (), frozenset()
    bypasses = bypass_pads(placement)
    rooms = {side: room(placement, routing, side) for side in SIDES}
    own, loose = _of_ground(placement, routing, pads)
    kind = _kind(placement)
    free = via_room(placement, routing, kind.via_mm, kind.via_drill_mm)
    filled = _Sheets(pads)
    while True:
        filled.fill(rooms)
        sheets = filled.of
        whole = [shapely.union_all(sheets[side].pieces) for side in SIDES]
        possible = candidates(placement, free, *whole)
        pieces, joined = _stitched(sheets, own, loose, possible, bypasses)
        islands = _islands(sheets, pieces, own.tracks, (*own.vias, *joined))
        if not any(islands.values()):
            break
        for side, found in islands.items():
            if found:
                rooms[side] = shapely.difference(
                    rooms[side], shapely.union_all(found).buffer(_APART_MM)
                )
    others = (via for via in routing.vias if via not in loose)
    done = dataclasses.replace(routing, vias=(*others, *joined))
    fills = tuple(
        Fill(placement.ground, side, shapely.set_precision(sheets[side].pieces[i], 0.001))
        for side in SIDES
        for i in pieces[side]
    )
    return done, fills, frozenset((pads[i].component.ref, pads[i].pad.number) for i in filled.solid)


_Joined = tuple[frozenset[int], frozenset[int]]
"""Pads that are joined all round, and pads that are not joined, by their number on a side."""


class _Sheets:
    """The pour of both sides, and the pads that it joins all round since bridges have no room.

    A plated hole that has its bridges on one side needs none on the other: joined all round, it
    would take the heat away from the wire that is soldered to it.
    """

    def __init__(self, pads: list[PlacedPad]) -> None:
        self.pads = pads
        self.solid: set[int] = set()
        self.of: dict[Side, Sheet] = {}
        self._on: dict[Side, list[int]] = {
            side: [i for i, pad in enumerate(pads) if side in pad.sides] for side in SIDES
        }
        self._rooms: dict[Side, Geometry] = {}
        self._made: dict[Side, dict[_Joined, Sheet]] = {}

    def fill(self, rooms: dict[Side, Geometry]) -> None:
        """Fill rooms; a side whose room has not changed is not filled again."""
        for side, room_ in rooms.items():
            if self._rooms.get(side) is not room_:
                self._rooms[side], self._made[side] = room_, {}
        self.solid = set()
        bare: dict[Side, set[int]] = {side: set() for side in SIDES}
        while starved := self._cut(bare):
            for side, i in starved:
                other: Side = "back" if side == "front" else "front"
                bridged = i in self._on[other] and self.of[other].reached[self._on[other].index(i)]
                if bridged and (other, i) not in starved:
                    bare[side].add(i)
                else:
                    self.solid.add(i)

    def _cut(self, bare: dict[Side, set[int]]) -> list[tuple[Side, int]]:
        """Cut both sheets; the pads that are starved."""
        for side, numbers in self._on.items():
            own = {i: k for k, i in enumerate(numbers)}
            joined, left_out = (
                frozenset(own[i] for i in chosen if i in own) for chosen in (self.solid, bare[side])
            )
            made = self._made[side]
            if (joined, left_out) not in made:
                pads = [self.pads[i] for i in numbers]
                made[joined, left_out] = sheet(self._rooms[side], pads, joined, left_out)
            self.of[side] = made[joined, left_out]
        return [(side, self._on[side][k]) for side in SIDES for k in sorted(self.of[side].starved)]


def _islands(
    sheets: dict[Side, Sheet],
    pieces: dict[Side, list[int]],
    tracks: Sequence[Track],
    vias: Sequence[Via],
) -> dict[Side, list[Geometry]]:
    """Pieces of pour that lead nowhere: joined to a single pad, and to no track or via."""
    found: dict[Side, list[Geometry]] = {}
    for side in SIDES:
        reached = [piece for each in sheets[side].reached for piece in each]
        cores: list[Geometry] = [shapely.Point(via.x_mm, via.y_mm) for via in vias]
        cores += [shapely.LineString([t.start, t.end]) for t in tracks if t.side == side]
        found[side] = [
            sheets[side].pieces[i]
            for i in pieces[side]
            if reached.count(i) < 2
            and not shapely.intersects(sheets[side].pieces[i], np.array(cores, dtype=object)).any()
        ]
    return found


def _of_ground(
    placement: Placement, routing: Routing, pads: Sequence[PlacedPad]
) -> tuple[Routing, list[Via]]:
    """Tracks and vias of ground; and the vias that the pour alone may join, since neither a track
    nor a pad does."""
    tracks = tuple(t for t in routing.tracks if t.net == placement.ground)
    vias = [v for v in routing.vias if v.net == placement.ground]
    copper = [shapely.LineString([t.start, t.end]) for t in tracks] + [pad.area for pad in pads]
    places = shapely.points(np.array([(v.x_mm, v.y_mm) for v in vias]).reshape(-1, 2))
    led = set(shapely.STRtree(places).query(copper, predicate="intersects")[1].tolist())
    joined = tuple(via for i, via in enumerate(vias) if i in led)
    loose = [via for i, via in enumerate(vias) if i not in led]
    return dataclasses.replace(routing, tracks=tracks, vias=joined), loose


def _stitched(
    sheets: dict[Side, Sheet],
    own: Routing,
    loose: list[Via],
    possible: list[Via],
    bypasses: Sequence[PlacedPad],
) -> tuple[dict[Side, list[int]], list[Via]]:
    """Join more pieces of pour to those that are ground, and all of them at many places.

    Args:
        sheets: the pour of each side.
        own: tracks and vias of ground.
        loose: vias of the routing that only the pour joins.
        possible: vias that could be added.
        bypasses: ground pads that want a via near.

    Returns:
        Pieces that are ground, of each side; vias that join them: those that were loose, without
        those that no ground reaches, and added ones.
    """
    ground = {side: _grounded(sheets[side], side, own) for side in SIDES}
    every = [*loose, *possible]
    places = [(v.x_mm, v.y_mm) for v in every]
    on_side = [sheets[side].pieces_at(places) for side in SIDES]
    on_both = [dict(zip(SIDES, on, strict=True)) for on in zip(*on_side, strict=True)]
    lands = [(n, on) for n, on in enumerate(on_both) if min(on.values()) >= 0]
    joining: list[int] = []
    grown = True
    while grown:
        grown = False
        for number, on in lands:
            joined = [on[side] in ground[side] for side in SIDES]
            if any(joined) and not all(joined):
                for side in SIDES:
                    ground[side].add(on[side])
                joining.append(number)
                grown = True
    old = len(loose)
    kept = [loose[n] for n in range(old) if any(on_both[n][s] in ground[s] for s in SIDES)]
    stitches = [*kept, *(every[n] for n in joining if n >= old)]
    whole = [n for n, on in lands if all(on[s] in ground[s] for s in SIDES)]
    used = {places[n]: every[n] for n in whole if n >= old}
    stitches += beside(bypasses, list(used.values()), [*own.vias, *stitches])
    taken = [(v.x_mm, v.y_mm) for v in (*own.vias, *stitches)]
    stitches += [used[at] for at in spread(sorted(used), taken, APART_MM)]
    return {side: sorted(found) for side, found in ground.items()}, stitches


def _grounded(sheet: Sheet, side: Side, own: Routing) -> set[int]:
    """Pieces of pour that pads of ground are bridged to, or that its tracks and vias touch."""
    copper: list[Geometry] = [shapely.Point(via.x_mm, via.y_mm) for via in own.vias]
    copper += [shapely.LineString([t.start, t.end]) for t in own.tracks if t.side == side]
    cores = np.array(copper, dtype=object)
    touched = shapely.STRtree(sheet.pieces).query(cores, predicate="intersects")[1]
    return {*touched.tolist(), *(piece for found in sheet.reached for piece in found)}
