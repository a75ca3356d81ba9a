"""Boards are routed completely, within their rules, and always the same way."""

import dataclasses
import math
from itertools import pairwise
from pathlib import Path

import pytest
import shapely

import small_boards as small
from lumitip_fab.boards.model import SIDES, BoardModel, Placement, Routing, Track
from lumitip_fab.boards.placed import BYPASS_MM, bypass_pads, placed_pads
from lumitip_fab.boards.pour import pour
from lumitip_fab.boards.route import route, router
from lumitip_fab.boards.route.obstacles import Obstacles
from lumitip_fab.boards.route.rules import Grid, Rules
from lumitip_fab.boards.verify import summary, verify
from lumitip_fab.design import Box
from lumitip_fab.errors import BuildError

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def crossing() -> tuple[Placement, Routing]:
    """A small board and its routing."""
    placement = small.crossing()
    return placement, route(placement)


def test_a_board_is_routed_within_its_rules(crossing: tuple[Placement, Routing]) -> None:
    faults = verify(BoardModel(*crossing, fills=()))
    assert not faults, summary(faults)


def test_the_same_board_gets_the_same_copper(crossing: tuple[Placement, Routing]) -> None:
    placement, routing = crossing
    assert route(placement) == routing


def test_tracks_run_at_multiples_of_45_degrees(crossing: tuple[Placement, Routing]) -> None:
    for track in crossing[1].tracks:
        dx, dy = (abs(b - a) for a, b in zip(track.start, track.end, strict=True))
        assert min(dx, dy, abs(dx - dy)) < 1e-9, track
        assert max(dx, dy) > 0, track


def test_tracks_meet_at_no_sharp_angle(crossing: tuple[Placement, Routing]) -> None:
    placement, routing = crossing
    pads = [p.area for c in placement.components for p in placed_pads(c)]
    vias = {(v.x_mm, v.y_mm) for v in routing.vias}
    ends: dict[tuple[str, str, float, float], list[float]] = {}
    for t in routing.tracks:
        for a, b in ((t.start, t.end), (t.end, t.start)):
            heading = math.degrees(math.atan2(b[1] - a[1], b[0] - a[0]))
            ends.setdefault((t.net, t.side, *a), []).append(heading)
    for (net, _, *at), headings in ends.items():
        if tuple(at) in vias or any(shapely.Point(at).within(pad) for pad in pads):
            continue
        for a, b in pairwise(sorted(headings)):
            assert min((a - b) % 360, (b - a) % 360) >= 90, (net, at, headings)


def test_vias_keep_off_pads(crossing: tuple[Placement, Routing]) -> None:
    placement, routing = crossing
    assert routing.vias
    for via in routing.vias:
        at = shapely.Point(via.x_mm, via.y_mm)
        for component in placement.components:
            for pad in placed_pads(component):
                assert pad.area.distance(at) >= via.diameter_mm / 2 + 0.1


def test_supply_tracks_are_wide_away_from_narrow_pads(
    crossing: tuple[Placement, Routing],
) -> None:
    placement, routing = crossing
    widths = {t.width_mm for t in routing.tracks if t.net == "3V3"}
    assert widths == {0.2, 0.5}
    narrow = [p for c in placement.components for p in placed_pads(c) if p.pad.width_mm < 0.5]
    for t in routing.tracks:
        if t.net == "3V3" and t.width_mm < 0.5:
            for at in (t.start, t.end):
                assert min(math.dist(at, (p.x_mm, p.y_mm)) for p in narrow) < 1.5


def test_what_cannot_be_routed_is_refused_with_nets_and_places() -> None:
    with pytest.raises(BuildError, match=r"rounds.*[A-E] at \(-?\d"):
        route(small.narrows())


def test_another_pressure_is_tried_where_nets_find_no_room(
    crossing: tuple[Placement, Routing], monkeypatch: pytest.MonkeyPatch
) -> None:
    placement, routing = crossing
    none, usual = router.Pressure(1.0, 0.0), router.TRIES[0]  # nets never become dear
    monkeypatch.setattr(router, "ATTEMPTS", ((none, False),))
    with pytest.raises(BuildError, match="still share room"):
        route(placement)
    monkeypatch.setattr(router, "ATTEMPTS", ((none, False), (usual, False)))
    second = route(placement)
    assert (second.tracks, second.vias) == (routing.tracks, routing.vias)
    assert second.iterations > routing.iterations


def test_a_board_on_which_most_nets_fight_is_refused_early(
    crossing: tuple[Placement, Routing], monkeypatch: pytest.MonkeyPatch
) -> None:
    placement, _ = crossing
    none = router.Pressure(1.0, 0.0)
    monkeypatch.setattr(
        router, "ATTEMPTS", ((none, True), (none, True), (none, False), (none, False))
    )
    with pytest.raises(BuildError, match=r"not routed after (1[89]\d|[2-9]\d\d) rounds"):
        route(placement)
    monkeypatch.setattr(router, "HOPELESS_NETS", 0)
    with pytest.raises(BuildError, match="not routed after 90 rounds: nets still share room"):
        route(placement)


def test_nets_are_routed_in_the_other_order_too(monkeypatch: pytest.MonkeyPatch) -> None:
    backwards = [attempt for attempt in router.ATTEMPTS if attempt[0].backwards]
    assert backwards
    monkeypatch.setattr(router, "ATTEMPTS", backwards)
    placement = small.crossing()
    faults = verify(BoardModel(placement, route(placement), fills=()))
    assert not faults, summary(faults)


def test_tracks_lie_side_by_side_on_the_grid(crossing: tuple[Placement, Routing]) -> None:
    rules = Rules.of(crossing[0])
    assert rules.pitch_mm == 0.2  # tracks of 0.2 mm with gaps of 0.2 mm
    fine = dataclasses.replace(rules.classes[0], track_mm=0.127, clearance_mm=0.15)
    assert dataclasses.replace(rules, classes=(*rules.classes, fine)).pitch_mm == 0.139
    wide = dataclasses.replace(rules.classes[0], track_mm=1.0)
    assert dataclasses.replace(rules, classes=(wide,)).pitch_mm == 0.2  # small pads stay in reach


def test_a_way_with_little_room_to_spare_is_found_on_a_finer_grid() -> None:
    placement = small.narrows("AE")
    faults = verify(BoardModel(placement, route(placement), ()))
    assert not [f for f in faults if {"A", "E"} & set(f.nets)], summary(faults)


def test_a_pad_that_is_walled_in_is_named() -> None:
    placement = small.crossing()
    parts = [
        dataclasses.replace(c, x_mm=-9.75) if c.ref == "J1" else c for c in placement.components
    ]
    with pytest.raises(BuildError, match=r"GND.*J1\.1"):
        route(dataclasses.replace(placement, components=tuple(parts), outline=placement.outline))


PRESETS = [
    ("asymmetric", "emitter"),
    ("asymmetric", "receiver"),
    *(
        pytest.param(preset, finger, marks=pytest.mark.slow)
        for preset in ("published", "mux16")
        for finger in ("emitter", "receiver")
    ),
]


@pytest.mark.parametrize(("preset", "finger"), PRESETS)
def test_presets_are_routed_without_fault(design_dir: Path, preset: str, finger: str) -> None:
    """But for the vias beside capacitors, which the pour joins."""
    placement = small.preset(design_dir, preset, finger)
    faults = verify(BoardModel(placement, route(placement), ()))
    others = tuple(f for f in faults if (f.rule, f.nets) != ("open", ("GND", "GND")))
    assert not others, summary(others)
    assert len(faults) - len(others) <= len(bypass_pads(placement))


def test_vias_beside_capacitors_are_given_up_where_they_have_no_room(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    placement = small.board(
        small.part("J1", small.PIN, (-8.8, 0), {"1": "GND"}),
        small.part("C1", small.CHIP, (1.3, 2.9), {"1": "A", "2": "GND"}),
        small.part("J2", small.PIN, (8.8, 0), {"1": "A"}),
    )
    (via,) = route(placement).vias
    (pad,) = bypass_pads(placement)
    assert via.net == "GND"
    assert pad.area.distance(shapely.Point(via.x_mm, via.y_mm)) <= BYPASS_MM
    monkeypatch.setattr(router, "ATTEMPTS", ((router.TRIES[0], False),))
    assert route(placement).vias == ()


def test_copper_keeps_out_of_where_none_may_be() -> None:
    area = Box(-3.0, 3.0, -4.0, 2.0)
    placement = small.board(
        small.part("R1", small.CHIP, (-6, -1), {"1": "GND", "2": "A"}),
        small.part("R2", small.CHIP, (6, -1), {"1": "A", "2": "GND"}),
        keep_outs=(area,),
    )
    routing, fills, _ = pour(placement, route(placement))
    assert not verify(BoardModel(placement, routing, fills))
    kept = shapely.box(-3.0, -4.0, 3.0, 2.0)
    assert all(fill.area.intersection(kept).area == 0 for fill in fills)
    assert {side for side in SIDES for fill in fills if fill.side == side} == set(SIDES)
    across = Track("A", "back", (-5.2, -1.0), (5.2, -1.0), 0.2)
    faults = verify(BoardModel(placement, Routing((across,), (), 1), ()))
    assert ("keep-out", ("A", "keep-out")) in {(f.rule, f.nets) for f in faults}


def test_a_track_wider_than_its_via_keeps_its_distance_where_the_via_ends() -> None:
    """The track's round end stands out of the via, on the side to which the via leads."""
    placement = small.crossing()
    classes = tuple(dataclasses.replace(c, track_mm=c.via_mm + 0.2) for c in placement.classes)
    rules = Rules.of(dataclasses.replace(placement, classes=classes))
    grid = Grid.over(placement.outline, 0.15)
    number = {n.name: i for i, n in enumerate(placement.nets, start=1)}
    pads = tuple(p for component in placement.components for p in placed_pads(component))
    owner = Obstacles(grid, rules, number).owners(placement, pads)
    for c, kind in enumerate(rules.classes):
        via = owner[c, 2]
        for side in (0, 1):
            track = owner[c, side]
            lands = (via == 0) & (track != 0)
            assert not lands.any() or kind.track_mm < kind.via_mm
