"""Courtyards in KiCad's file: the usual widths, less where parts are near; they never overlap."""

from collections.abc import Callable
from dataclasses import replace
from itertools import combinations

import pytest

from lumitip_fab.boards.courtyards import CONTACTS_MM, PART_MM, land, with_courtyards
from lumitip_fab.boards.model import Placement
from lumitip_fab.boards.placed import placed_box
from lumitip_fab.boards.placement import place
from lumitip_fab.boards.spots import refuse_misplaced
from lumitip_fab.design import Box, Design
from lumitip_fab.errors import BuildError


def boards_of(design: Design) -> dict[str, Placement]:
    boards = (*design.fingers, *design.auxiliary_boards)
    return {board.name: place(design, board) for board in boards}


def around_mm(outer: Box, inner: Box) -> float:
    return min(
        inner.x_min_mm - outer.x_min_mm,
        outer.x_max_mm - inner.x_max_mm,
        inner.y_min_mm - outer.y_min_mm,
        outer.y_max_mm - inner.y_max_mm,
    )


def overlap(a: Box, b: Box) -> bool:
    beside = max(b.x_min_mm - a.x_max_mm, a.x_min_mm - b.x_max_mm)
    return max(beside, b.y_min_mm - a.y_max_mm, a.y_min_mm - b.y_max_mm) <= 0


@pytest.mark.slow_cases
@pytest.mark.parametrize("preset", ["published", "dense", "integrated", "mux16"])
def test_courtyards_are_apart_and_never_less_than_placement_had(
    designs: Callable[[str], Design], preset: str
) -> None:
    for name, board in boards_of(designs(preset)).items():
        drawn = with_courtyards(board).components
        for before, after in zip(board.components, drawn, strict=True):
            assert around_mm(after.courtyard, before.courtyard) > -0.002, (name, after.ref)
        yards = [
            (part.side, part.ref, placed_box(part, yard))
            for part in drawn
            for yard in (part.courtyard, part.shroud_yard)
            if yard
        ]
        for (side, one, here), (other_side, other, there) in combinations(yards, 2):
            apart = side != other_side or one == other or not overlap(here, there)
            assert apart, (name, one, other)


@pytest.mark.slow
def test_courtyards_have_the_usual_width_where_there_is_room(
    designs: Callable[[str], Design],
) -> None:
    boards = boards_of(designs("published"))
    flange = {part.ref: part for part in with_courtyards(boards["flange"]).components}
    header, resistor = flange["J3"], flange["R2"]
    assert around_mm(header.shroud_yard, header.footprint.shroud.box) == pytest.approx(CONTACTS_MM)
    assert around_mm(header.courtyard, land(header.footprint)) == pytest.approx(CONTACTS_MM)
    assert around_mm(resistor.courtyard, land(resistor.footprint)) == pytest.approx(PART_MM)


@pytest.mark.slow
def test_a_part_under_a_shroud_is_refused(designs: Callable[[str], Design]) -> None:
    board = boards_of(designs("published"))["flange"]
    parts = {part.ref: part for part in board.components}
    header = parts["J3"]
    parts["R2"] = replace(parts["R2"], x_mm=header.x_mm, y_mm=header.y_mm + 5.0)
    with pytest.raises(BuildError, match=r"J3 .* and R2 .* overlap|R2 .* and J3 .* overlap"):
        refuse_misplaced("flange", tuple(parts.values()), inside=None)
