"""The ground pour: filled areas on both sides, and the vias that make them one."""

import dataclasses

import shapely

from lumitip_fab.boards.geometry import placed_pads
from lumitip_fab.boards.model import SIDES, Fill, Placement, Routing, Side, Via
from lumitip_fab.boards.pour.ground import Kept, needed
from lumitip_fab.boards.pour.room import room, via_room
from lumitip_fab.boards.pour.stitching import APART_MM, candidates, spread
from lumitip_fab.boards.pour.thermals import Sheet, sheet


def pour(placement: Placement, routing: Routing) -> tuple[Routing, tuple[Fill, ...]]:
    """Fill both sides with ground.

    Args:
        placement: the board.
        routing: tracks and vias that connect every net, ground too.

    Returns:
        The routing with only those tracks and vias of ground that the pour does not replace, and
        with stitching vias; and the pour, without pieces that nothing joins to ground. Areas are
        polygons on whole micrometres.
    """
    pads = [
        pad
        for component in placement.components
        for pad in placed_pads(component)
        if pad.net == placement.ground
    ]
    if not pads:
        return routing, ()
    sheets = {
        side: sheet(room(placement, routing, side), [p for p in pads if side in p.sides])
        for side in SIDES
    }
    others, own = _split(placement, routing)
    kind = min(placement.classes, key=lambda c: c.via_mm)
    free = via_room(placement, routing, kind.via_mm, kind.via_drill_mm)
    whole = [shapely.union_all(sheets[side].pieces) for side in SIDES]
    possible = candidates(placement, free, *whole)
    kept = needed(pads, sheets, own, possible)
    pieces, stitches = _stitched(sheets, kept, possible)
    vias = (*others.vias, *kept.vias, *stitches)
    done = Routing((*others.tracks, *kept.tracks), vias, routing.iterations)
    return done, tuple(
        Fill(placement.ground, side, shapely.set_precision(sheets[side].pieces[i], 0.001))
        for side in SIDES
        for i in pieces[side]
    )


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
