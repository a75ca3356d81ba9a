"""Where parts and print are on the boards of every preset."""

import dataclasses
import math
import shutil
from collections.abc import Callable, Iterator
from itertools import combinations, pairwise
from pathlib import Path

import pytest
import shapely
from shapely import LineString

from lumitip_fab.boards.files import auxiliary_files
from lumitip_fab.boards.model import SIDES, Placement, opening_mm
from lumitip_fab.boards.placed import courtyard, pad_at, placed_pads
from lumitip_fab.boards.placement import place
from lumitip_fab.boards.silk.page import extent
from lumitip_fab.boards.silk.strokes import silkscreen
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Box, Component, Design, Finger
from lumitip_fab.errors import BuildError

pytestmark = pytest.mark.slow

PRESETS = ("published", "asymmetric", "dense", "mux16")
FINGERS = ("emitter", "receiver")
Placed = tuple[Design, Finger, Placement]


@pytest.fixture(scope="module")
def boards(design_dir: Path) -> dict[tuple[str, str], Placed]:
    """Both boards of every preset."""
    found = {}
    for preset in PRESETS:
        design = derive(load(design_dir / "presets" / f"{preset}.toml"))
        for finger in design.fingers:
            found[preset, finger.name] = design, finger, place(design, finger)
    return found


@pytest.fixture(params=[(p, f) for p in PRESETS for f in FINGERS], ids="-".join)
def board(boards: dict[tuple[str, str], Placed], request: pytest.FixtureRequest) -> Placed:
    """Each board."""
    return boards[request.param]


def _box(box: Box) -> shapely.Polygon:
    return shapely.box(box.x_min_mm, box.y_min_mm, box.x_max_mm, box.y_max_mm)


def _parts(placement: Placement, kind: str) -> list[Component]:
    return [part for part in placement.components if part.kind == kind]


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
    rim = _box(placement.outline.grown(1e-6))
    for side in SIDES:
        yards = [(p.ref, _box(courtyard(p))) for p in placement.components if p.side == side]
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
        rim = _box(placement.outline).exterior.distance(pad.area)
        assert rim >= placement.edge_clearance_mm - 1e-6
        for hole in placement.holes:
            apart = pad.area.distance(shapely.Point(hole)) - placement.hole_mm / 2
            assert apart >= placement.hole_clearance_mm - 1e-6


def test_passives_stand_beside_their_multiplexer_at_its_leads(
    boards: dict[tuple[str, str], Placed],
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
                assert _box(zone.grown(1e-6)).contains(_box(land))


def test_arrays_of_pull_ups_stand_beside_the_multiplexer_that_they_serve(
    boards: dict[tuple[str, str], Placed],
) -> None:
    with_arrays = [p for p in PRESETS if boards[p, "receiver"][0].wiring.own_pull_ups]
    assert with_arrays
    for preset in with_arrays:
        design, finger, placement = boards[preset, "receiver"]
        zone = next(z.box for z in finger.zones if z.name == "parts")
        arrays = _parts(placement, "resistor array")
        channels = {n for u in _parts(placement, "multiplexer") for _, n in u.nets}
        assert arrays
        for array in arrays:
            cells = {net for _, net in array.nets} - {"3V3"}
            (mux,) = [
                u for u in _parts(placement, "multiplexer") if cells <= {n for _, n in u.nets}
            ]
            assert cells <= channels
            gap = _box(courtyard(array)).distance(_box(courtyard(mux)))
            assert gap < 2 * design.rules.part_gap_mm, (preset, array.ref)
            land = courtyard(array).grown(-design.rules.part_gap_mm / 2)
            assert _box(zone.grown(1e-6)).contains(_box(land))


def test_neighbours_of_a_string_face_each_other(boards: dict[tuple[str, str], Placed]) -> None:
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
    marks = _parts(placement, "fiducial")
    corners = {(part.x_mm > 0, part.y_mm > box.centre_mm[1]) for part in marks}
    assert corners == {(False, True), (True, True), (False, False)}
    assert all(part.side == "front" for part in marks)


def test_silkscreen_is_clear_of_pads_holes_and_the_edge(board: Placed) -> None:
    placement = board[2]
    openings = {side: [] for side in SIDES}
    for part in placement.components:
        for pad in placed_pads(part):
            for side in pad.sides:
                openings[side].append(pad.area.buffer(opening_mm(part)))
    holes = [shapely.Point(at).buffer(placement.hole_mm / 2) for at in placement.holes]
    rim = _box(placement.outline)
    trees = {side: shapely.STRtree([*shapes, *holes]) for side, shapes in openings.items()}
    for side, stroke in silkscreen(placement):
        ink = LineString(stroke.points).buffer(stroke.width_mm / 2)
        assert not trees[side].query(ink, predicate="dwithin", distance=0.05).size
        assert rim.contains(ink)


def test_titles_labels_and_references_are_printed(board: Placed) -> None:
    design, finger, placement = board
    told = {side: [t.text for s, t in placement.texts if s == side] for side in SIDES}
    for side in SIDES:
        words = " ".join(told[side])
        assert design.title.name in words
        assert f"rev {design.title.revision}" in words
        assert design.layout.design_hash[:8] in words
        assert "TIP" in told[side]
        assert set(finger.connector.signals) <= set(told[side])
    assert "1" in told["front"]
    named = {p.ref for p in placement.components if p.ref_text}
    assert {p.ref for p in _parts(placement, "multiplexer")} <= named


def test_references_stand_at_the_cells_of_the_published_grid(
    boards: dict[tuple[str, str], Placed],
) -> None:
    for preset in ("published", "mux16"):
        for finger, kind in (("emitter", "led"), ("receiver", "photodetector")):
            assert all(p.ref_text for p in _parts(boards[preset, finger][2], kind))


def test_references_stand_in_narrower_cells_whose_outlines_give_way(
    boards: dict[tuple[str, str], Placed],
) -> None:
    design, _, placement = boards["asymmetric", "receiver"]
    parts = _parts(placement, "photodetector")
    assert design.grid.pitch_mm == 5.0
    assert {p.ref_text.angle_deg % 180 for p in parts if p.ref_text} == {0.0}, "upright on parts"
    assert all(p.ref_text for p in parts)


def test_in_the_narrowest_cells_the_ends_of_the_columns_are_named(
    boards: dict[tuple[str, str], Placed],
) -> None:
    for finger, kind in (("emitter", "led"), ("receiver", "photodetector")):
        parts = _parts(boards["dense", finger][2], kind)
        by_column = [[p for p in parts if abs(p.x_mm - x) < 0.1] for x in {q.x_mm for q in parts}]
        ends = {p.ref for c in by_column for p in (c[0], c[-1])}
        named = {p.ref for p in parts if p.ref_text}
        assert named <= ends
        assert len(named) > 0.8 * len(ends), "but where holes are"


def test_references_stand_at_leds_nearer_each_other(design_dir: Path) -> None:
    config = load(design_dir / "presets/published.toml")
    grid = config.parameters.grid.model_copy(update={"pitch_mm": 4.5})
    parameters = config.parameters.model_copy(update={"grid": grid})
    design = derive(dataclasses.replace(config, parameters=parameters))
    assert all(p.ref_text for p in _parts(place(design, design.emitter), "led"))


def test_hexagons_surround_the_cells(board: Placed) -> None:
    design, finger, placement = board
    drawn = shapely.union_all(
        [LineString(s.points) for side, s in placement.silk if side == "front"]
    ).buffer(0.05)
    inner = min(drawn.distance(shapely.Point(at)) for at in finger.cells)
    assert inner == pytest.approx(design.grid.pitch_mm / 2 - 0.05, abs=0.02)


def test_the_same_design_gives_the_same_board(boards: dict[tuple[str, str], Placed]) -> None:
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
    boards: dict[tuple[str, str], Placed],
) -> None:
    design = boards["published", "receiver"][0]
    for finger, said in _crowded(design):
        with pytest.raises(BuildError, match=said):
            place(design, finger)


def test_a_title_without_room_is_refused_with_the_numbers(
    boards: dict[tuple[str, str], Placed],
) -> None:
    design, finger, _ = boards["asymmetric", "emitter"]
    title = dataclasses.replace(design.title, revision="W" * 80)
    with pytest.raises(
        BuildError, match=r"the title on the back, .* mm high and \d+\.\d\d mm long"
    ):
        place(dataclasses.replace(design, title=title), finger)


def test_a_long_title_is_printed_smaller(boards: dict[tuple[str, str], Placed]) -> None:
    design, finger, _ = boards["asymmetric", "emitter"]
    title = dataclasses.replace(design.title, name="Lumitip with the longest of name")
    placement = place(dataclasses.replace(design, title=title), finger)
    heights = [text.height_mm for _, text in placement.texts if title.name in text.text]
    assert heights
    assert min(heights) >= design.rules.silk_text_mm


def test_labels_of_a_row_stand_apart(board: Placed) -> None:
    """Signals at the wire pads read apart: no two of them touch."""
    _, finger, placement = board
    for side in SIDES:
        labels = [
            extent(text, side)
            for where, text in placement.texts
            if where == side and text.text in finger.connector.signals
        ]
        assert len(labels) == len(finger.connector.signals)
        assert all(a.distance(b) >= 0.15 for a, b in combinations(labels, 2))


def test_a_label_without_room_above_its_pad_moves_aside(design_dir: Path, tmp_path: Path) -> None:
    file = Path(shutil.copytree(design_dir, tmp_path / "design")) / "narrow.toml"
    file.write_text(
        'extends = "presets/published.toml"\n'
        "[grid]\ncolumns = [5, 5, 5, 5, 5]\npitch_mm = 5.7\n[stack]\npcb_mm = 1.0\n"
    )
    design = derive(load(file))
    finger = design.receiver
    (x, y), name = finger.connector.pads[0], finger.connector.signals[0]
    at = [
        (text.x_mm, text.y_mm)
        for where, text in place(design, finger).texts
        if where == "front" and text.text == name
    ]
    assert len(at) == 1
    assert 0.0 < abs(at[0][0] - x) < finger.connector.pitch_mm / 2
    assert abs(at[0][1] - y) < finger.connector.pitch_mm


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
        auxiliary_files(d, flange)
