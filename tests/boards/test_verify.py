"""The board's own check finds each kind of damage to its copper, and where it is."""

import dataclasses
import math
from collections.abc import Iterable

import pytest
import shapely

import small_boards as small
from lumitip_fab.boards.model import BoardModel, Fill, Placement, Routing, Track, Via
from lumitip_fab.boards.route import route
from lumitip_fab.boards.verify import Fault, require_clean_drc, summary, verify
from lumitip_fab.errors import BuildError


@pytest.fixture(scope="module")
def placement() -> Placement:
    """A small board."""
    return small.crossing()


@pytest.fixture(scope="module")
def routing(placement: Placement) -> Routing:
    """Its copper, without fault."""
    return route(placement)


@pytest.fixture(scope="module")
def bare() -> Placement:
    """A resistor alone."""
    return small.board(small.part("R1", small.CHIP, (-6, 3), {"1": "A", "2": "GND"}))


def _faults(
    placement: Placement,
    routing: Routing,
    *,
    tracks: Iterable[Track] | None = None,
    vias: Iterable[Via] | None = None,
    fills: tuple[Fill, ...] = (),
) -> tuple[Fault, ...]:
    tracks = routing.tracks if tracks is None else tuple(tracks)
    vias = routing.vias if vias is None else tuple(vias)
    return verify(BoardModel(placement, Routing(tracks, vias, 1), fills))


def test_a_sound_board_has_no_fault(placement: Placement, routing: Routing) -> None:
    assert summary(_faults(placement, routing)) == ""


@pytest.mark.parametrize("gap_mm", [0.199, 0.1, 0.0])
def test_a_track_too_near_to_a_pad(bare: Placement, gap_mm: float) -> None:
    x = -7.2 - gap_mm - 0.05  # the left end of pad R1.1 is at -7.2
    stray = Track("S0", "front", (x, 3.0), (x, 3.1), 0.1)
    (fault,) = _faults(bare, Routing((stray,), (), 1))
    assert set(fault.nets) == {"A", "S0"}
    assert fault.rule == ("clearance" if gap_mm else "short")
    assert fault.distance_mm == pytest.approx(gap_mm, abs=1e-9)
    assert fault.needed_mm == 0.2
    assert math.dist((fault.x_mm, fault.y_mm), (-7.2, 3.05)) < 0.2


def test_a_clearance_that_is_kept_is_no_fault(bare: Placement) -> None:
    stray = Track("S0", "front", (-7.45, 3.0), (-7.45, 3.1), 0.1)
    assert not _faults(bare, Routing((stray,), (), 1))
    behind = Track("S0", "back", (-7.0, 3.0), (-7.0, 3.1), 0.1)
    assert not _faults(bare, Routing((behind,), (), 1))


def test_a_track_moved_by_its_clearance(placement: Placement, routing: Routing) -> None:
    found = 0
    for i, track in enumerate(routing.tracks):
        for dx, dy in ((0.2, 0), (-0.2, 0), (0, 0.2), (0, -0.2)):
            moved = dataclasses.replace(
                track,
                start=(track.start[0] + dx, track.start[1] + dy),
                end=(track.end[0] + dx, track.end[1] + dy),
            )
            tracks = (*routing.tracks[:i], moved, *routing.tracks[i + 1 :])
            faults = _faults(placement, routing, tracks=tracks)
            found += any(f.rule == "clearance" and track.net in f.nets for f in faults)
    assert found > len(routing.tracks) / 4


def test_every_via_is_needed(placement: Placement, routing: Routing) -> None:
    assert routing.vias
    for via in routing.vias:
        faults = _faults(placement, routing, vias=(v for v in routing.vias if v != via))
        assert {(f.rule, f.nets) for f in faults} == {("open", (via.net, via.net))}


def test_every_track_is_needed(placement: Placement, routing: Routing) -> None:
    for track in routing.tracks:
        if math.dist(track.start, track.end) < 1.0 or track.width_mm > 0.2:
            continue  # may lie within a pad, or a wide one within its neighbours
        faults = _faults(placement, routing, tracks=(t for t in routing.tracks if t != track))
        assert ("open", (track.net, track.net)) in {(f.rule, f.nets) for f in faults}


def test_a_via_on_another_net(placement: Placement, routing: Routing) -> None:
    via = routing.vias[0]
    wrong = dataclasses.replace(via, net="GND" if via.net != "GND" else "A")
    faults = _faults(placement, routing, vias=(wrong, *routing.vias[1:]))
    assert any(f.rule == "short" and set(f.nets) == {via.net, wrong.net} for f in faults)


def test_copper_over_the_edge_and_at_a_hole(placement: Placement, routing: Routing) -> None:
    for at, what in (((9.65, 0.0), "edge"), ((1.35, 0.0), "hole"), ((9.6, 4.6), "edge")):
        stray = Track("A", "back", at, (at[0], at[1] + 0.01), 0.2)
        faults = _faults(placement, routing, tracks=(*routing.tracks, stray))
        assert [f.nets for f in faults if f.rule == "edge"] == [("A", what)]


def test_drills_too_near(placement: Placement, routing: Routing) -> None:
    via = routing.vias[0]
    near = dataclasses.replace(via, x_mm=via.x_mm + 0.5)
    faults = _faults(placement, routing, vias=(*routing.vias, near))
    drills = [f for f in faults if f.rule == "drill"]
    assert pytest.approx(0.2) in [f.distance_mm for f in drills]


def test_a_fill_too_near_and_one_that_floats(bare: Placement) -> None:
    nothing = Routing((), (), 1)
    island = Fill("GND", "back", shapely.box(-0.5, 4.0, 0.5, 4.6))
    (fault,) = _faults(bare, nothing, fills=(island,))
    assert (fault.rule, fault.nets) == ("open", ("GND", "GND"))
    near = Fill("GND", "front", shapely.box(-6.25, 2.5, -5.5, 3.5))
    (fault,) = _faults(bare, nothing, fills=(near,))
    assert fault.distance_mm == pytest.approx(0.15)
    flood = Fill("GND", "front", shapely.box(-9, 2, -5, 4))
    (fault,) = _faults(bare, nothing, fills=(flood,))
    assert (fault.rule, set(fault.nets)) == ("short", {"A", "GND"})


def test_only_a_sound_board_passes(placement: Placement, routing: Routing) -> None:
    good = BoardModel(placement, routing, ())
    assert require_clean_drc(good) is good
    bad = dataclasses.replace(good, routing=dataclasses.replace(routing, vias=()))
    with pytest.raises(BuildError, match=r"receiver board breaks its rules:\nnet .* in pieces"):
        require_clean_drc(bad)
