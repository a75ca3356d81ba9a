"""A panel as a model: places of tabs, routed openings, and copies with names of their own."""

from collections.abc import Callable
from dataclasses import replace

import pytest
import shapely
from shapely import affinity

from lumitip_fab.boards.model import BoardModel, PlacedComponent, Placement, Routing, Track, Via
from lumitip_fab.boards.outline import corners, outline_area, slot_area, straight_edges
from lumitip_fab.boards.panel.model import panel_model
from lumitip_fab.boards.panel.tabs import bites, tab_places
from lumitip_fab.boards.silk.strokes import silkscreen
from lumitip_fab.design import Box, Design, Panel, Point, Rules
from lumitip_fab.errors import BuildError
from small_boards import CHIP, board, crossing, part


@pytest.fixture(scope="module")
def rules(designs: Callable[[str], Design]) -> Rules:
    return designs("small").rules


@pytest.fixture(scope="module")
def panel(designs: Callable[[str], Design]) -> Panel:
    """Two by two boards of 20 x 30 mm, 2 mm apart, in a frame of 6 mm."""
    limits = designs("panelled").panels[0].rules
    outline = Box(-29.0, 29.0, -39.0, 39.0)
    at = (-11.0, -16.0)
    return Panel("receiver", 2, 2, outline, outline.grown(-6.0), at, (22.0, 32.0), 6.0, 2, limits)


def model_of(placement: Placement) -> BoardModel:
    tracks = (Track("GND", "front", (-6.0, 0.0), (6.0, 0.0), 0.2),)
    return BoardModel(placement, Routing(tracks, (Via("GND", 6.0, 0.0, 0.6, 0.3),), 1), ())


def tall(*parts: PlacedComponent) -> Placement:
    return replace(board(*parts), outline=Box(-10.0, 10.0, -15.0, 15.0))


def mounted(ref: str, at: Point) -> PlacedComponent:
    return replace(part(ref, CHIP, at, {}), part="1")


def test_tabs_stand_in_the_middle_of_their_share(panel: Panel) -> None:
    assert tab_places(panel, model_of(tall())) == (-7.5, 7.5)


def test_a_tab_makes_way_for_a_part_at_either_edge(panel: Panel) -> None:
    for x in (-8.0, 8.0):
        low, high = tab_places(panel, model_of(tall(mounted("R1", (x, 3.0)))))
        assert low == -7.5
        tab = shapely.LineString([(x * 10 / 8, high + sign * 3.442) for sign in (-1, 1)])
        body = shapely.box(x - 1.2, 2.5, x + 1.2, 3.5)
        assert 2.0 <= tab.distance(body) < 2.2


def test_no_room_for_a_tab_is_said_with_the_numbers(panel: Panel) -> None:
    parts = [mounted(f"R{i}", (-8.5, 2.0 * i)) for i in range(8)]
    with pytest.raises(
        BuildError, match=r"no room for a tab of 6\.88 mm between y 0\.00 and 15\.00"
    ):
        tab_places(panel, model_of(tall(*parts)))


def test_the_row_of_a_mouse_bite_reaches_a_third_over_the_edge(panel: Panel) -> None:
    holes = bites(panel.rules, Box(-10.0, 10.0, -15.0, 15.0), 7.5)
    assert len(holes) == 2 * panel.rules.bites
    assert {round(abs(x), 6) for x, _ in holes} == {10.1}
    assert min(y for _, y in holes) == 5.5
    assert max(y for _, y in holes) == 9.5


def test_openings_leave_copies_tabs_and_frame(panel: Panel, rules: Rules) -> None:
    placement = tall()
    made = panel_model(panel, model_of(placement), rules).placement
    whole = outline_area(replace(made, slots=()))
    openings = shapely.union_all([slot_area(slot) for slot in made.slots])
    assert (whole - outline_area(made)).symmetric_difference(openings).area < 1e-9
    alone = outline_area(placement)
    for by in panel.copies:
        assert openings.intersection(affinity.translate(alone, *by)).area < 1e-3
    inside = panel.inside
    rest = shapely.box(inside.x_min_mm, inside.y_min_mm, inside.x_max_mm, inside.y_max_mm)
    left = (
        rest - openings - shapely.union_all([affinity.translate(alone, *b) for b in panel.copies])
    )
    tabs = [piece for piece in shapely.get_parts(left.buffer(-0.2)) if piece.area > 1.0]
    assert len(tabs) == 3 * 4


def test_the_outline_is_closed_by_lines_and_arcs(panel: Panel, rules: Rules) -> None:
    made = panel_model(panel, model_of(tall()), rules).placement
    ends = [end for edge in straight_edges(made) for end in edge]
    ends += [end for bow in corners(made) for end in (bow.start, bow.end)]
    counts = {end: ends.count(end) for end in ends}
    assert set(counts.values()) == {2}
    for bow in corners(made):
        assert shapely.Point(bow.middle).distance(shapely.Point(bow.centre)) == pytest.approx(
            shapely.Point(bow.start).distance(shapely.Point(bow.centre))
        )


def test_names_of_parts_and_nets_differ_and_print_stays(panel: Panel, rules: Rules) -> None:
    alone = crossing()
    alone = replace(alone, outline=Box(-10.0, 10.0, -15.0, 15.0), holes=())
    limits = replace(panel.rules, part_mm=0.5, pad_mm=0.1, copper_mm=0.1)
    made = panel_model(replace(panel, rules=limits), model_of(alone), rules)
    refs = [part.ref for part in made.placement.components]
    assert len(set(refs)) == len(refs) == 4 * len(alone.components) + 3
    nets = [net.name for net in made.placement.nets]
    assert len(set(nets)) == len(nets) == 4 * len(alone.nets)
    used = {net for part in made.placement.components for _, net in part.nets}
    used |= {track.net for track in made.routing.tracks} | {via.net for via in made.routing.vias}
    assert used <= set(nets)
    printed = sum(1 for _ in silkscreen(alone))
    label = made.placement.texts[-1][1].text
    assert label == "receiver A: 2 x 2"
    assert sum(1 for _ in silkscreen(made.placement)) >= 4 * printed
