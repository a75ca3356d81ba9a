"""Where the pour and its vias may be, and the bridges from ground pads to it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely import Geometry, Polygon

from lumitip_fab.boards import model
from lumitip_fab.boards.placed import PlacedPad, placed_pads
from lumitip_fab.boards.verify import DRILL_WALL_MM
from lumitip_fab.design import Point, Side

MARGIN_MM = 0.003  # beyond clearances: curves become polygons, places are rounded,
DETAIL_MM = 0.001  # and corners that move an outline by less than this are left out
PAD_TO_VIA_MM = 0.1  # solder mask between a pad and a via
_ARC = 16  # chords of a quarter circle


@dataclass(frozen=True)
class Thing:
    """Copper of another net: all within a radius of its core."""

    core: Geometry
    radius_mm: float
    sides: tuple[Side, ...]
    gap_mm: float
    """To the pour."""


def room(placement: model.Placement, routing: model.Routing, side: Side) -> Geometry:
    """Where the pour may be on a side, nowhere narrower than its least width."""
    taken = [
        t.core.buffer(t.radius_mm + t.gap_mm + MARGIN_MM, quad_segs=_ARC)
        for t in _things(placement, routing)
        if side in t.sides
    ]
    free = shapely.difference(free_board(placement, MARGIN_MM), shapely.union_all(taken))
    return opened(free)


def via_room(
    placement: model.Placement, routing: model.Routing, via_mm: float, drill_mm: float
) -> Geometry:
    """Where the middle of a via may be: off all pads and holes, in the room of both sides."""
    radius = via_mm / 2 + MARGIN_MM
    taken = [
        t.core.buffer(t.radius_mm + t.gap_mm + radius, quad_segs=_ARC)
        for t in _things(placement, routing)
    ]
    taken += [
        pad.area.buffer(radius + PAD_TO_VIA_MM)
        for component in placement.components
        for pad in placed_pads(component)
    ]
    if placement.flexible:
        bend = placement.flexible.bend.grown(radius)
        taken.append(shapely.box(*bend.bounds_mm))
    apart = drill_mm + DRILL_WALL_MM + MARGIN_MM
    taken += [shapely.Point(v.x_mm, v.y_mm).buffer(apart) for v in routing.vias]
    board = free_board(placement, radius)
    return shapely.difference(board, shapely.union_all(taken))


def opened(area: Geometry) -> Geometry:
    """An area without the parts that are narrower than the pour's minimum width.

    It stays within the area: the outline that is grown back with chords lies within the circle,
    and so it is first shrunk as if the circle lay within the chords.
    """
    half = model.MIN_WIDTH_MM / 2
    around = half / np.cos(np.pi / (4 * _ARC))
    shrunk = area.buffer(-around, quad_segs=_ARC)
    return shrunk.buffer(half, quad_segs=_ARC).simplify(DETAIL_MM)


def _things(placement: model.Placement, routing: model.Routing) -> Iterator[Thing]:
    classes = {c.name: c.clearance_mm for c in placement.classes}
    of_net = {n.name: classes[n.net_class] for n in placement.nets}
    least = max(model.CLEARANCE_MM, of_net.get(placement.ground, 0.0))
    for component in placement.components:
        for pad in placed_pads(component):
            if pad.net != placement.ground:
                round_ = pad.pad.round
                core = shapely.Point(pad.x_mm, pad.y_mm) if round_ else pad.area
                radius = pad.pad.width_mm / 2 if round_ else 0.0
                gap = max(least, of_net.get(pad.net, 0.0), model.fiducial_margin_mm(component))
                yield Thing(core, radius, pad.sides, gap)
    for track in routing.tracks:
        if track.net != placement.ground:
            line = shapely.LineString([track.start, track.end])
            gap = max(least, of_net[track.net])
            yield Thing(line, track.width_mm / 2, (track.side,), gap)
    for via in routing.vias:
        if via.net != placement.ground:
            at = shapely.Point(via.x_mm, via.y_mm)
            yield Thing(at, via.diameter_mm / 2, model.SIDES, max(least, of_net[via.net]))


def free_board(placement: model.Placement, radius_mm: float) -> Geometry:
    """Where the middle of something round may be: away from edge, holes and keep-outs."""
    box, corner = placement.outline, placement.corner_mm
    edge_mm = placement.edge_clearance_mm + radius_mm
    from_hole_mm = placement.hole_clearance_mm + radius_mm
    inner = shapely.box(
        box.x_min_mm + corner, box.y_min_mm + corner, box.x_max_mm - corner, box.y_max_mm - corner
    )
    whole = inner.buffer(corner - edge_mm, quad_segs=_ARC)
    left_out = [
        shapely.Point(at).buffer(diameter_mm / 2 + from_hole_mm, quad_segs=2 * _ARC)
        for at, diameter_mm in placement.unplated
    ]
    left_out += [
        shapely.box(*box.bounds_mm).buffer(radius_mm, join_style="mitre")
        for box in placement.keep_outs
    ]
    return shapely.difference(whole, shapely.union_all(left_out))


LEAST_AREA_MM2 = 0.04  # smaller pieces of pour are left out
_INTO_MM = 0.1  # how far a spoke reaches into pad and pour


@dataclass(frozen=True)
class Sheet:
    """The pour of one side: pieces, and the pads that each of them reaches."""

    pieces: tuple[Polygon, ...]
    reached: tuple[tuple[int, ...], ...]
    """Pieces that each pad is joined to."""
    starved: frozenset[int]
    """Pads with a bridge, but fewer than they ought to have."""

    def pieces_at(self, places: Sequence[Point]) -> list[int]:
        """The piece of pour at each place, or -1."""
        found = np.full(len(places), -1)
        x, y = np.array(places).reshape(-1, 2).T
        for i, piece in enumerate(self.pieces):
            shapely.prepare(piece)
            found[shapely.contains_xy(piece, x, y)] = i
        return [int(i) for i in found]


def sheet(
    room: Geometry, pads: list[PlacedPad], solid: frozenset[int], bare: frozenset[int]
) -> Sheet:
    """Cut the pads out of the room for the pour, and bridge the gaps.

    Args:
        room: where the pour may be.
        pads: pads of the ground net on this side.
        solid: pads that are joined all round instead.
        bare: pads that are not joined on this side.
    """
    gaps = [
        pad.area.buffer(model.THERMAL_GAP_MM, join_style="round")
        for number, pad in enumerate(pads)
        if number not in solid
    ]
    body = opened(shapely.difference(room, shapely.union_all(gaps)))
    pieces = [p for p in shapely.get_parts(body) if p.area >= LEAST_AREA_MM2]
    shapely.prepare(pieces)
    shapely.prepare(room)
    tree = shapely.STRtree(pieces)
    added: list[list[Geometry]] = [[] for _ in pieces]
    reached: list[tuple[int, ...]] = []
    starved: list[int] = []
    for number, pad in enumerate(pads):
        if number in bare:
            reached.append(())
            continue
        if number in solid:
            reached.append(tuple(sorted(tree.query(pad.area, predicate="intersects").tolist())))
            continue
        found = [
            (int(piece), spoke)
            for spoke, end in _spokes(pad)
            if room.covers(spoke)
            for piece in tree.query(end)
            if pieces[piece].covers(end)
        ]
        for piece, spoke in found:
            added[piece].append(spoke)
        reached.append(tuple(sorted({piece for piece, _ in found})))
        if 0 < len(found) < model.LEAST_SPOKES:
            starved.append(number)
    whole = [shapely.union_all([p, *more]) for p, more in zip(pieces, added, strict=True)]
    return Sheet(tuple(whole), tuple(reached), frozenset(starved))


def _spokes(pad: PlacedPad) -> list[tuple[Polygon, Polygon]]:
    """The four spokes of a pad, each with its outer end: along its axes, of round pads between."""
    size = pad.pad
    start = 45.0 if size.round else 0.0
    half = model.THERMAL_SPOKE_MM / 2
    spokes = []
    for turn, reach in zip(
        (0.0, 90.0, 180.0, 270.0), (size.width_mm, size.height_mm) * 2, strict=True
    ):
        inner, outer = reach / 2 - _INTO_MM, reach / 2 + model.THERMAL_GAP_MM + _INTO_MM
        angle = np.radians(start + turn + pad.component.angle_deg)
        matrix = [np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle), pad.x_mm, pad.y_mm]
        spoke = shapely.box(inner, -half, outer, half)
        end = shapely.box(
            outer - _INTO_MM / 2, -model.MIN_WIDTH_MM / 2, outer, model.MIN_WIDTH_MM / 2
        )
        spokes.append(tuple(shapely.affinity.affine_transform(p, matrix) for p in (spoke, end)))
    return spokes
