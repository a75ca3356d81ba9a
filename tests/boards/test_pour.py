"""The ground pour reaches every ground pad, keeps clear of the rest, and leaves all tracks."""

import dataclasses
import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import shapely

import small_boards as small
from lumitip_fab.boards.model import (
    MIN_WIDTH_MM,
    SIDES,
    THERMAL_GAP_MM,
    THERMAL_SPOKE_MM,
    BoardModel,
    Fill,
    Placement,
    Routing,
    Track,
    Via,
)
from lumitip_fab.boards.placed import BYPASS_MM, bypass_pads, placed_pads
from lumitip_fab.boards.pour import pour
from lumitip_fab.boards.pour.flood import spread
from lumitip_fab.boards.route import route
from lumitip_fab.boards.verify import require_clean_drc, summary, verify
from lumitip_fab.errors import BuildError

Poured = tuple[Placement, Routing, tuple[Fill, ...], frozenset[tuple[str, str]]]
PRESETS = [("published", "emitter"), ("published", "receiver"), ("asymmetric", "receiver")]


@pytest.fixture(scope="module")
def routed() -> tuple[Placement, Routing]:
    """A small board with tracks."""
    placement = small.crossing()
    return placement, route(placement)


@pytest.fixture(scope="module")
def poured(routed: tuple[Placement, Routing]) -> Poured:
    """A small board with its pour."""
    return routed[0], *pour(*routed)


def test_a_poured_board_has_no_fault(poured: Poured) -> None:
    faults = verify(BoardModel(*poured))
    assert not faults, summary(faults)


def test_a_via_that_no_ground_reaches_is_left_out() -> None:
    """A track that passes between a capacitor and its via leaves a piece of pour at the via that
    nothing else reaches; it counted as ground, because the via did."""
    placement = small.board(
        small.part("J1", small.PIN, (-8.8, 0), {"1": "GND"}),
        small.part("J2", small.PIN, (8.8, 0), {"1": "A"}),
    )
    routing = route(placement)
    kind = placement.classes[0]
    reached, lost = (Via("GND", x_mm, 3.0, kind.via_mm, kind.via_drill_mm) for x_mm in (-5.0, 3.0))
    ring = [(1.8, 1.8), (4.2, 1.8), (4.2, 4.2), (1.8, 4.2), (1.8, 1.8)]
    fence = [Track("A", side, *ends, 0.25) for side in SIDES for ends in pairwise(ring)]
    lead = Track("A", "front", (4.2, 1.8), (8.8, 0.0), 0.25)
    hooked = dataclasses.replace(
        routing, tracks=(*routing.tracks, *fence, lead), vias=(*routing.vias, reached, lost)
    )
    poured, fills, _ = pour(placement, hooked)
    assert reached in poured.vias and lost not in poured.vias
    inside = shapely.Point(3.0, 3.0)
    assert not any(fill.area.intersects(inside) for fill in fills)


@pytest.mark.parametrize("ref", ["C1", "R1"])
def test_a_capacitor_has_a_ground_via_beside_it(ref: str) -> None:
    """Elsewhere a via every few millimetres is enough."""
    placement = small.board(
        small.part("J1", small.PIN, (-8.8, 0), {"1": "GND"}),
        small.part("J2", small.PIN, (8.8, 0), {"1": "A"}),
        small.part(ref, small.CHIP, (1.3, 2.9), {"1": "A", "2": "GND"}),
    )
    routing, fills, solid = pour(placement, route(placement))
    assert not verify(BoardModel(placement, routing, fills, solid))
    part = next(c for c in placement.components if c.ref == ref)
    pad = next(p for p in placed_pads(part) if p.net == "GND")
    away = [pad.area.distance(shapely.Point(v.x_mm, v.y_mm)) for v in routing.vias]
    assert (min(away) <= BYPASS_MM) is (ref == "C1")


@pytest.mark.slow
@pytest.mark.parametrize(("preset", "finger"), PRESETS)
def test_presets_have_no_fault(design_dir: Path, preset: str, finger: str) -> None:
    placement = small.preset(design_dir, preset, finger)
    routing, fills, _ = pour(placement, route(placement))
    faults = verify(BoardModel(placement, routing, fills))
    assert not faults, summary(faults)
    ground = [shapely.Point(v.x_mm, v.y_mm) for v in routing.vias if v.net == placement.ground]
    for pad in bypass_pads(placement):
        away = [pad.area.distance(via) for via in ground]
        assert min(away) <= BYPASS_MM, pad.component.ref
    box = placement.outline
    for side in SIDES:
        share = sum(f.area.area for f in fills if f.side == side) / (box.width_mm * box.length_mm)
        assert 0.3 < share < 0.97, side


def test_the_same_board_gets_the_same_pour(
    routed: tuple[Placement, Routing], poured: Poured
) -> None:
    routing, fills, _ = pour(*routed)
    assert routing == poured[1]
    assert [f.area.wkb for f in fills] == [f.area.wkb for f in poured[2]]


def test_the_pour_leaves_all_tracks(routed: tuple[Placement, Routing], poured: Poured) -> None:
    """Those of ground, too: they are the short ways where the pour goes round."""
    assert poured[1].tracks == routed[1].tracks
    assert poured[1].vias[: len(routed[1].vias)] == routed[1].vias


def test_ground_pads_are_bridged_by_spokes(poured: Poured) -> None:
    placement, _, fills, solid = poured
    bridged = 0
    for component in placement.components:
        for pad in placed_pads(component):
            if pad.net != "GND" or (component.ref, pad.pad.number) in solid:
                continue
            for side in pad.sides:
                copper = shapely.union_all([f.area for f in fills if f.side == side])
                ring = pad.area.buffer(THERMAL_GAP_MM / 2).exterior
                crossed = shapely.intersection(copper, ring).length
                assert not 0 < crossed < 1.9 * THERMAL_SPOKE_MM, "KiCad's least is two spokes"
                assert crossed < 4.2 * THERMAL_SPOKE_MM, "the pad cannot be soldered"
                bridged += crossed > 1.9 * THERMAL_SPOKE_MM
    assert bridged >= 3


def test_no_sliver_is_left(poured: Poured) -> None:
    for fill in poured[2]:
        half = 0.97 * MIN_WIDTH_MM / 2
        thin = fill.area.difference(fill.area.buffer(-half).buffer(half + 0.02))
        corners = 2e-3  # of the spokes' square ends
        assert all(part.area < corners for part in shapely.get_parts(thin))


def test_every_piece_is_joined_to_ground(poured: Poured) -> None:
    """Without its stitching vias the pour falls apart, or loses nothing but a spare way."""
    placement, routing, fills, _ = poured
    stitches = [v for v in routing.vias if v.net == "GND"]
    assert stitches
    bare = dataclasses.replace(routing, vias=tuple(v for v in routing.vias if v.net != "GND"))
    faults = verify(BoardModel(placement, bare, fills))
    assert {(f.rule, f.nets) for f in faults} <= {("open", ("GND", "GND"))}


def test_curves_are_on_whole_micrometres(poured: Poured) -> None:
    for fill in poured[2]:
        assert fill.area.is_valid
        for x, y in shapely.get_coordinates(fill.area).tolist():
            assert (round(x, 3), round(y, 3)) == (
                pytest.approx(x, abs=1e-9),
                pytest.approx(y, abs=1e-9),
            )


def test_a_board_that_is_not_routed_is_refused() -> None:
    wall = small.board(
        small.part("R1", small.CHIP, (-6, 0), {"2": "GND"}),
        small.part("R2", small.CHIP, (6, 0), {"2": "GND"}, side="back"),
        *(
            small.part(f"W{k}{s}", small.CHIP, (0, y), {"1": "A", "2": "A"}, side=s)
            for s in SIDES
            for k, y in enumerate((-4, -3, -2, 2, 3, 4))
        ),
    )
    tracks = tuple(Track("A", s, (-0.8, -4.9), (-0.8, 4.9), 2.0) for s in SIDES)
    poured = pour(wall, Routing(tracks, (), 1))
    with pytest.raises(BuildError, match=r"net GND is in pieces: .* \(5\.20"):
        require_clean_drc(BoardModel(wall, *poured))


def test_places_are_spread_in_their_order() -> None:
    """As by comparing each one with all that stay."""
    chance = np.random.default_rng(5)
    places, taken = (
        [(float(x), float(y)) for x, y in chance.uniform(-9.0, 9.0, (n, 2)).round(1)]
        for n in (300, 20)
    )
    for apart_mm in (0.53, 2.0, 6.0):
        kept: list[tuple[float, float]] = []
        for at in places:
            if all(math.dist(at, other) >= apart_mm for other in [*taken, *kept]):
                kept.append(at)
        assert spread(places, taken, apart_mm) == kept
    assert spread([], [], 1.0) == []
