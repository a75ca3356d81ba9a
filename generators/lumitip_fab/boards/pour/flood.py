"""The ground pour: filled areas on both sides, and the vias that make them one."""

import dataclasses
import math
from collections.abc import Iterable, Sequence

import numpy as np
import shapely
from shapely import Geometry

from lumitip_fab.boards.model import SIDES, Fill, NetClass, Placement, Routing, Track, Via
from lumitip_fab.boards.placed import PlacedPad, placed_pads
from lumitip_fab.boards.pour.ground import Kept, needed
from lumitip_fab.boards.pour.room import MARGIN_MM, Sheet, room, sheet, via_room
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


def spread(places: Iterable[Point], taken: Iterable[Point], apart_mm: float) -> list[Point]:
    """Places in their order, without those too near to one before them or to a taken one."""
    grid: dict[tuple[int, int], list[Point]] = {}

    def cell(at: Point) -> tuple[int, int]:
        return math.floor(at[0] / apart_mm), math.floor(at[1] / apart_mm)

    for at in taken:
        grid.setdefault(cell(at), []).append(at)
    found = []
    for at in places:
        column, row = cell(at)
        near = (
            other
            for u in (column - 1, column, column + 1)
            for v in (row - 1, row, row + 1)
            for other in grid.get((u, v), ())
        )
        if all(math.dist(at, other) >= apart_mm for other in near):
            grid.setdefault((column, row), []).append(at)
            found.append(at)
    return found


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
        The routing with only those tracks and vias of ground that the pour does not replace, and
        with stitching vias; the pour, without pieces that nothing joins to ground; and the pads
        that it joins all round. Areas are polygons on whole micrometres.
    """
    pads = [
        pad
        for component in placement.components
        for pad in placed_pads(component)
        if pad.net == placement.ground
    ]
    if not pads:
        return routing, (), frozenset()
    rooms = {side: room(placement, routing, side) for side in SIDES}
    others, own = _split(placement, routing)
    kind = _kind(placement)
    free = via_room(placement, routing, kind.via_mm, kind.via_drill_mm)
    while True:
        sheets, solid = _sheets(rooms, pads)
        whole = [shapely.union_all(sheets[side].pieces) for side in SIDES]
        possible = candidates(placement, free, *whole)
        kept = needed(pads, sheets, own, possible)
        pieces, stitches = _stitched(sheets, kept, possible)
        vias = (*kept.vias, *stitches)
        islands = _islands(sheets, pieces, kept.tracks, vias)
        if not any(islands.values()):
            break
        for side, found in islands.items():
            rooms[side] = shapely.difference(
                rooms[side], shapely.union_all(found).buffer(_APART_MM)
            )
    done = Routing((*others.tracks, *kept.tracks), (*others.vias, *vias), routing.iterations)
    fills = tuple(
        Fill(placement.ground, side, shapely.set_precision(sheets[side].pieces[i], 0.001))
        for side in SIDES
        for i in pieces[side]
    )
    return done, fills, frozenset((pads[i].component.ref, pads[i].pad.number) for i in solid)


def _sheets(
    rooms: dict[Side, Geometry], pads: list[PlacedPad]
) -> tuple[dict[Side, Sheet], frozenset[int]]:
    """The pour of both sides, and the pads that it joins all round since bridges have no room.

    A plated hole that has its bridges on one side needs none on the other: joined all round, it
    would take the heat away from the wire that is soldered to it.
    """
    on_side = {side: [i for i, pad in enumerate(pads) if side in pad.sides] for side in SIDES}
    solid: set[int] = set()
    bare: dict[Side, set[int]] = {side: set() for side in SIDES}
    while True:
        sheets = {}
        for side, numbers in on_side.items():
            own = {i: k for k, i in enumerate(numbers)}
            joined, left_out = (
                frozenset(own[i] for i in chosen if i in own) for chosen in (solid, bare[side])
            )
            sheets[side] = sheet(rooms[side], [pads[i] for i in numbers], joined, left_out)
        starved = [(side, on_side[side][k]) for side in SIDES for k in sorted(sheets[side].starved)]
        if not starved:
            return sheets, frozenset(solid)
        for side, i in starved:
            other: Side = "back" if side == "front" else "front"
            bridged = i in on_side[other] and sheets[other].reached[on_side[other].index(i)]
            if bridged and (other, i) not in starved:
                bare[side].add(i)
            else:
                solid.add(i)


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


def _split(placement: Placement, routing: Routing) -> tuple[Routing, Routing]:
    """Copper of all other nets, and copper of ground."""
    others, own = (
        dataclasses.replace(
            routing,
            tracks=tuple(t for t in routing.tracks if (t.net == placement.ground) is ground),
            vias=tuple(v for v in routing.vias if (v.net == placement.ground) is ground),
        )
        for ground in (False, True)
    )
    return others, own


def _stitched(
    sheets: dict[Side, Sheet], kept: Kept, possible: list[Via]
) -> tuple[dict[Side, list[int]], list[Via]]:
    """Join more pieces of pour to those that are ground, and all of them at many places.

    Returns:
        Pieces that are ground, of each side; vias beyond those kept.
    """
    ground = {side: set(kept.pieces[side]) for side in SIDES}
    places = [(v.x_mm, v.y_mm) for v in possible]
    on_side = [sheets[side].pieces_at(places) for side in SIDES]
    lands = [
        (via, dict(zip(SIDES, on, strict=True)))
        for via, *on in zip(possible, *on_side, strict=True)
        if min(on) >= 0
    ]
    taken = [(v.x_mm, v.y_mm) for v in kept.vias]
    stitches: list[Via] = []
    grown = True
    while grown:
        grown = False
        for via, on in lands:
            joined = [on[side] in ground[side] for side in SIDES]
            if any(joined) and not all(joined):
                for side in SIDES:
                    ground[side].add(on[side])
                stitches.append(via)
                grown = True
    used = {(v.x_mm, v.y_mm): v for v, on in lands if all(on[s] in ground[s] for s in SIDES)}
    taken += [(v.x_mm, v.y_mm) for v in stitches]
    stitches += [used[at] for at in spread(sorted(used), taken, APART_MM)]
    return {side: sorted(found) for side, found in ground.items()}, stitches
