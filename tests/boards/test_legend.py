"""Print on the boards of every preset: texts, their places and their gaps."""

import dataclasses
import math
import shutil
from itertools import combinations
from pathlib import Path

import pytest
import shapely
from shapely import LineString

from lumitip_fab.boards.model import SIDES, opening_mm
from lumitip_fab.boards.placed import placed_pads
from lumitip_fab.boards.placement import place
from lumitip_fab.boards.silk.page import extent
from lumitip_fab.boards.silk.strokes import silkscreen
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
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


def test_silkscreen_is_clear_of_pads_holes_and_the_edge(board: Placed) -> None:
    placement = board[2]
    openings = {side: [] for side in SIDES}
    for part in placement.components:
        for pad in placed_pads(part):
            for side in pad.sides:
                openings[side].append(pad.area.buffer(opening_mm(part)))
    holes = [shapely.Point(at).buffer(placement.hole_mm / 2) for at in placement.holes]
    rim = polygon(placement.outline)
    trees = {side: shapely.STRtree([*shapes, *holes]) for side, shapes in openings.items()}
    for side, stroke in silkscreen(placement):
        ink = LineString(stroke.points).buffer(stroke.width_mm / 2)
        assert not trees[side].query(ink, predicate="dwithin", distance=0.05).size
        assert rim.contains(ink)


def test_titles_labels_and_references_are_printed(board: Placed) -> None:
    design, finger, placement = board
    printed = {side: [t.text for s, t in placement.texts if s == side] for side in SIDES}
    for side in SIDES:
        words = " ".join(printed[side])
        assert design.title.name in words
        assert f"rev {design.title.revision}" in words
        assert design.layout.design_hash[:8] in words
        assert "TIP" in printed[side]
        assert set(finger.connector.signals) <= set(printed[side])
    assert "1" in printed["front"]
    named = {p.ref for p in placement.components if p.ref_text}
    assert {p.ref for p in parts_of(placement, "multiplexer")} <= named


def test_references_stand_at_the_cells_of_the_published_grid(
    boards: Boards,
) -> None:
    for preset in ("published", "mux16"):
        for finger, kind in (("emitter", "led"), ("receiver", "photodetector")):
            assert all(p.ref_text for p in parts_of(boards[preset, finger][2], kind))


def test_references_stand_in_narrower_cells_whose_outlines_give_way(
    boards: Boards,
) -> None:
    design, _, placement = boards["asymmetric", "receiver"]
    parts = parts_of(placement, "photodetector")
    assert design.grid.pitch_mm == 5.0
    assert {p.ref_text.angle_deg % 180 for p in parts if p.ref_text} == {0.0}, "upright on parts"
    assert all(p.ref_text for p in parts)


def test_in_the_narrowest_cells_the_ends_of_the_columns_are_named(
    boards: Boards,
) -> None:
    for finger, kind in (("emitter", "led"), ("receiver", "photodetector")):
        parts = parts_of(boards["dense", finger][2], kind)
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
    assert all(p.ref_text for p in parts_of(place(design, design.emitter), "led"))


def test_hexagons_surround_the_cells(board: Placed) -> None:
    design, finger, placement = board
    drawn = shapely.union_all(
        [LineString(s.points) for side, s in placement.silk if side == "front"]
    ).buffer(0.05)
    inner = min(drawn.distance(shapely.Point(at)) for at in finger.cells)
    assert inner == pytest.approx(design.grid.pitch_mm / 2 - 0.05, abs=0.02)


def test_a_title_without_room_is_refused_with_the_numbers(
    boards: Boards,
) -> None:
    design, finger, _ = boards["asymmetric", "emitter"]
    title = dataclasses.replace(design.title, revision="W" * 80)
    with pytest.raises(
        BuildError, match=r"the title on the back, .* mm high and \d+\.\d\d mm long"
    ):
        place(dataclasses.replace(design, title=title), finger)


def test_a_long_title_is_printed_smaller(boards: Boards) -> None:
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


def test_the_number_of_the_first_wire_pad_is_beside_it(design_dir: Path, tmp_path: Path) -> None:
    """Where a tie's hole and a capacitor are to the left of the row, too."""
    file = Path(shutil.copytree(design_dir, tmp_path / "design")) / "wide.toml"
    file.write_text('extends = "fingertip.toml"\n[grid]\npitch_mm = 8\n', encoding="utf-8")
    design = derive(load(file))
    board = place(design, design.receiver)
    (one,) = [text for side, text in board.texts if (side, text.text) == ("front", "1")]
    (row,) = [part for part in board.components if part.pins and part.contacts]
    parts = [part for part in board.components if part.side == "front"]
    ends = [(pad.x_mm, pad.y_mm, part.ref) for part in parts for pad in placed_pads(part)]
    nearest = min(ends, key=lambda end: math.hypot(end[0] - one.x_mm, end[1] - one.y_mm))
    first = placed_pads(row)[0]
    assert nearest == (first.x_mm, first.y_mm, row.ref)
    assert math.hypot(first.x_mm - one.x_mm, first.y_mm - one.y_mm) < 4.5
