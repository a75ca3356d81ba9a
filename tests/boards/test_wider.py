"""Tracks are 0.25 mm wide wherever they have room, and nowhere else."""

import dataclasses
import math
from pathlib import Path

import pytest

import small_boards as small
from lumitip_fab.boards.model import BoardModel, Placement, Routing, Track, Via
from lumitip_fab.boards.placement import place
from lumitip_fab.boards.pour import pour
from lumitip_fab.boards.route import route
from lumitip_fab.boards.route.spread import WIDE_MM
from lumitip_fab.boards.route.wider import LEAST_MM, with_wider_tracks
from lumitip_fab.boards.verify import summary, verify
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive

ALONG = Track("A", "front", (-8.0, 3.0), (8.0, 3.0), 0.2)


def length_mm(track: Track) -> float:
    return math.dist(track.start, track.end)


def widened(*others: Via | Track, pad_mm: float = 0.9) -> list[Track]:
    """A long track with other copper on the board."""
    shape = dataclasses.replace(
        small.CHIP, pads=tuple(dataclasses.replace(p, width_mm=pad_mm) for p in small.CHIP.pads)
    )
    placement = small.board(
        small.part("R1", shape, (-8.8, 3), {"2": "A", "1": "B"}),
        small.part("R2", shape, (8.8, 3), {"1": "A", "2": "B"}),
    )
    vias = tuple(o for o in others if isinstance(o, Via))
    tracks = tuple(o for o in others if isinstance(o, Track))
    return [
        track
        for track in with_wider_tracks(placement, Routing((ALONG, *tracks), vias, 1)).tracks
        if track.net == "A"
    ]


def test_a_track_with_room_is_wide() -> None:
    assert widened() == [dataclasses.replace(ALONG, width_mm=WIDE_MM)]


def test_a_track_is_narrow_only_where_it_must_be() -> None:
    first, neck, last = widened(Via("B", 0.0, 3.51, 0.6, 0.3))
    assert [t.width_mm for t in (first, neck, last)] == [WIDE_MM, 0.2, WIDE_MM]
    assert (first.start, first.end, neck.end, last.end) == (
        ALONG.start,
        neck.start,
        last.start,
        ALONG.end,
    )
    assert 0.72 < length_mm(neck) < 0.76
    assert widened(Via("B", 0.0, 3.63, 0.6, 0.3)) == widened()


def test_a_track_without_length_stays() -> None:
    dot = Track("A", "front", (0.0, 3.0), (0.0, 3.0), 0.2)
    assert widened(dot) == [dataclasses.replace(ALONG, width_mm=WIDE_MM), dot]


def test_a_wide_track_leaves_its_neighbour_narrow() -> None:
    """Between them is room for one of the two."""
    beside = Track("B", "front", (-4.0, 3.43), (4.0, 3.43), 0.2)
    (track,) = widened(beside)
    assert track.width_mm == WIDE_MM


def test_a_neck_at_a_narrow_pad_stays() -> None:
    pieces = widened(pad_mm=0.22)
    assert [t.width_mm for t in pieces] == [0.2, WIDE_MM, 0.2]


def test_the_edge_and_holes_keep_their_distance() -> None:
    placement = small.board(small.part("R1", small.CHIP, (-8, 3), {"2": "A", "1": "B"}))
    edge = placement.outline.y_max_mm - placement.edge_clearance_mm
    near, far = (Track("A", "front", (-5.0, y), (5.0, y), 0.2) for y in (edge - 0.11, edge - 0.13))
    found = (
        with_wider_tracks(placement, Routing((near,), (), 1)),
        with_wider_tracks(placement, Routing((far,), (), 1)),
    )
    assert [r.tracks[0].width_mm for r in found] == [0.2, WIDE_MM]


def receiver(design_dir: Path, name: str) -> Placement:
    if name != "default":
        return small.preset(design_dir, name, "receiver")
    design = derive(load(design_dir / "fingertip.toml"))
    return place(design, next(f for f in design.fingers if f.name == "receiver"))


@pytest.mark.slow
@pytest.mark.parametrize(("name", "least"), [("published", 0.8), ("default", 0.8)])
def test_most_of_a_board_is_wide_and_the_rest_has_no_room(
    design_dir: Path, name: str, least: float
) -> None:
    placement = receiver(design_dir, name)
    routing = with_wider_tracks(placement, route(placement))
    signals = [t for t in routing.tracks if t.net != placement.ground]
    wide_mm = sum(length_mm(t) for t in signals if t.width_mm >= WIDE_MM)
    assert wide_mm >= least * sum(map(length_mm, signals))
    model = BoardModel(placement, *pour(placement, routing))
    assert not verify(model), summary(verify(model))
    narrow = [t for t in signals if t.width_mm < WIDE_MM and length_mm(t) >= LEAST_MM]
    assert narrow
    for track in narrow[:: 1 + len(narrow) // 30]:
        wide = dataclasses.replace(track, width_mm=WIDE_MM + 0.01)
        tracks = tuple(wide if t is track else t for t in routing.tracks)
        faults = verify(BoardModel(placement, dataclasses.replace(routing, tracks=tracks), ()))
        assert any(track.net in f.nets and f.rule != "open" for f in faults), track
