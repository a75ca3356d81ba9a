"""Where parts are on the boards of every preset."""

import dataclasses
import math
from collections.abc import Callable, Iterator
from itertools import combinations, pairwise
from pathlib import Path

import pytest
import shapely

from lumitip_fab.boards.files import board_files
from lumitip_fab.boards.model import SIDES
from lumitip_fab.boards.placed import courtyard, pad_at, placed_pads
from lumitip_fab.boards.placement import place
from lumitip_fab.design import Box, Design, Finger
from lumitip_fab.errors import BuildError
from placed_boards import (
    FINGERS,
    PRESETS,
    Boards,
    Placed,
    parts_of,
    placed_boards,
    polygon,
)

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def boards(design_dir: Path) -> Boards:
    """Both boards of every preset."""
    return placed_boards(design_dir)


@pytest.fixture(params=[(p, f) for p in PRESETS for f in FINGERS], ids="-".join)
def board(boards: Boards, request: pytest.FixtureRequest) -> Placed:
    """Each board."""
    return boards[request.param]


def test_parts_are_where_the_design_says(board: Placed) -> None:
    _, finger, placement = board
    parts = {part.ref: part for part in placement.components}
    for given in finger.parts:
        part = parts[given.name]
        assert part.side == given.side
        assert (part.x_mm, part.y_mm) == pytest.approx((given.x_mm, given.y_mm), abs=1e-6)
        land = courtyard(part).grown(-board[0].rules.part_gap_mm / 2)
        for side in ("x_min_mm", "x_max_mm", "y_min_mm", "y_max_mm"):
            assert getattr(land, side) == pytest.approx(getattr(given.box, side), abs=0.03)
    for pad, at in zip(parts["J1"].footprint.pads, finger.connector.pads, strict=True):
        assert pad_at(parts["J1"], pad.number) == pytest.approx(at)
    assert placement.holes == finger.holes


def test_no_courtyards_overlap_and_all_are_on_the_board(board: Placed) -> None:
    placement = board[2]
    rim = polygon(placement.outline.grown(1e-6))
    for side in SIDES:
        yards = [(p.ref, polygon(courtyard(p))) for p in placement.components if p.side == side]
        for (one, here), (other, there) in combinations(yards, 2):
            assert shapely.intersection(here, there).area < 1e-6, (one, other)
        assert all(rim.contains(yard) for _, yard in yards)


def test_pads_keep_their_gap_to_each_other_the_edge_and_the_holes(board: Placed) -> None:
    design, _, placement = board
    gap = design.rules.copper_gap_mm - 1e-6
    pads = [pad for part in placement.components for pad in placed_pads(part)]
    tree = shapely.STRtree([pad.area for pad in pads])
    for pad in pads:
        for j in tree.query(pad.area, predicate="dwithin", distance=gap).tolist():
            other = pads[j]
            if other is not pad and set(pad.sides) & set(other.sides):
                assert pad.net == other.net != "", (pad.component.ref, other.component.ref)
        rim = polygon(placement.outline).exterior.distance(pad.area)
        assert rim >= placement.edge_clearance_mm - 1e-6
        for hole in placement.holes:
            apart = pad.area.distance(shapely.Point(hole)) - placement.hole_mm / 2
            assert apart >= placement.hole_clearance_mm - 1e-6


def test_passives_stand_beside_their_multiplexer_at_its_leads(
    boards: Boards,
) -> None:
    for preset in PRESETS:
        design, finger, placement = boards[preset, "receiver"]
        parts = {part.ref: part for part in placement.components}
        zone = next(z.box for z in finger.zones if z.name == "parts")
        mux = design.packages.multiplexer
        own = design.wiring.own_pull_ups
        served = [("C", "1", mux.supply)] + ([] if own else [("R", "2", mux.output)])
        farthest_mm = 3.6 + (design.packages.array.over_pads_mm[1] if own else 0.0)
        for i in range(1, design.wiring.muxes + 1):
            for letter, pad, lead in served:
                part = parts[f"{letter}{i}"]
                near = math.dist(pad_at(part, pad), pad_at(parts[f"U{i}"], str(lead)))
                assert near < farthest_mm, (preset, part.ref)
                land = courtyard(part).grown(-design.rules.part_gap_mm / 2)
                assert polygon(zone.grown(1e-6)).contains(polygon(land))


def test_arrays_of_pull_ups_stand_beside_the_multiplexer_that_they_serve(
    boards: Boards,
) -> None:
    with_arrays = [p for p in PRESETS if boards[p, "receiver"][0].wiring.own_pull_ups]
    assert with_arrays
    for preset in with_arrays:
        design, finger, placement = boards[preset, "receiver"]
        zone = next(z.box for z in finger.zones if z.name == "parts")
        arrays = parts_of(placement, "resistor array")
        channels = {n for u in parts_of(placement, "multiplexer") for _, n in u.nets}
        assert arrays
        for array in arrays:
            cells = {net for _, net in array.nets} - {"3V3"}
            (mux,) = [
                u for u in parts_of(placement, "multiplexer") if cells <= {n for _, n in u.nets}
            ]
            assert cells <= channels
            gap = polygon(courtyard(array)).distance(polygon(courtyard(mux)))
            assert gap < 2 * design.rules.part_gap_mm, (preset, array.ref)
            land = courtyard(array).grown(-design.rules.part_gap_mm / 2)
            assert polygon(zone.grown(1e-6)).contains(polygon(land))


def test_neighbours_of_a_string_face_each_other(boards: Boards) -> None:
    for preset in PRESETS:
        design, _, placement = boards[preset, "emitter"]
        parts = {part.ref: part for part in placement.components}
        for string in design.wiring.strings:
            for one, other in pairwise(string):
                link = math.dist(
                    pad_at(parts[f"D{one + 1}"], "1"), pad_at(parts[f"D{other + 1}"], "2")
                )
                assert link <= 1.3 * design.grid.pitch_mm, (preset, one, other)


def test_three_fiducials_are_near_three_corners(board: Placed) -> None:
    placement = board[2]
    box = placement.outline
    marks = parts_of(placement, "fiducial")
    corners = {(part.x_mm > 0, part.y_mm > box.centre_mm[1]) for part in marks}
    assert corners == {(False, True), (True, True), (False, False)}
    assert all(part.side == "front" for part in marks)


def test_the_same_design_gives_the_same_board(boards: Boards) -> None:
    design, finger, placement = boards["asymmetric", "receiver"]
    assert place(design, finger) == placement


def _crowded(design: Design) -> Iterator[tuple[Finger, str]]:
    emitter, receiver = design.fingers
    first, *others = emitter.parts
    moved = dataclasses.replace(first, x_mm=others[0].x_mm + 0.5, y_mm=others[0].y_mm)
    yield dataclasses.replace(emitter, parts=(moved, *others)), r"D1 at .* and D2 at .* overlap"
    shifted = tuple(
        dataclasses.replace(p, x_mm=p.x_mm - 4.5) if p.name == "U1" else p for p in receiver.parts
    )
    yield dataclasses.replace(receiver, parts=shifted), r"C1 needs 1\.45 mm beside U1"
    wires = dataclasses.replace(
        receiver.connector, pads=tuple((x, y - 1.5) for x, y in receiver.connector.pads)
    )
    yield dataclasses.replace(receiver, connector=wires), r"J1 at .* leaves the board"


def test_what_has_no_room_is_refused_with_the_numbers(
    boards: Boards,
) -> None:
    design = boards["published", "receiver"][0]
    for finger, said in _crowded(design):
        with pytest.raises(BuildError, match=said):
            place(design, finger)


def test_parts_of_a_auxiliary_that_overlap_are_refused(designs: Callable[[str], Design]) -> None:
    d = designs("small")
    flange = next(auxiliary for auxiliary in d.auxiliary_boards if auxiliary.name == "flange")
    (coil,) = (device for device in flange.components if device.ref == "L1")
    wide = dataclasses.replace(coil.footprint, body=Box(-4.0, 4.0, -4.0, 4.0))
    devices = [
        dataclasses.replace(device, footprint=wide) if device is coil else device
        for device in flange.components
    ]
    flange = dataclasses.replace(flange, components=tuple(devices))
    with pytest.raises(BuildError, match=r"flange: .*\bL1\b.* overlap: choose smaller"):
        board_files(d, flange)
