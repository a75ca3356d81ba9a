"""Finer copper than common is for the receiver alone."""

from collections.abc import Callable
from dataclasses import replace

import pytest

from lumitip_fab.boards.placement import place
from lumitip_fab.design import Design
from lumitip_fab.design.board_rules import COMMON_EDGE_MM, COMMON_MM, rules_of

pytestmark = pytest.mark.slow
Designs = Callable[[str], Design]


def test_a_fine_design_has_common_rules_outside_its_receiver(designs: Designs) -> None:
    dense = designs("dense")
    assert dense.rules.via_drill_mm < COMMON_MM["via_drill_mm"]
    assert dense.rules.edge_gap_mm < COMMON_EDGE_MM
    assert rules_of(dense, "receiver") == dense.rules
    outside = ["emitter", *(board.name for board in dense.auxiliary_boards)]
    assert outside == ["emitter", "breakout", "flange"]
    for name in outside:
        rules = rules_of(dense, name)
        assert {of: getattr(rules, of) for of in COMMON_MM} == COMMON_MM
        assert rules == replace(dense.rules, **COMMON_MM, edge_gap_mm=COMMON_EDGE_MM)


def test_boards_are_placed_and_routed_by_them(designs: Designs) -> None:
    dense = designs("dense")
    (emitter,) = (finger for finger in dense.fingers if finger.name == "emitter")
    for board in (emitter, *dense.auxiliary_boards):
        assert place(dense, board).edge_clearance_mm == COMMON_EDGE_MM
        for kind in place(dense, board).classes:
            assert kind.via_drill_mm == COMMON_MM["via_drill_mm"]
            assert kind.clearance_mm == COMMON_MM["copper_gap_mm"]


def test_supplies_are_no_narrower_than_signals(designs: Designs) -> None:
    usual = designs("small")
    fine = replace(usual, rules=replace(usual.rules, track_mm=0.15, supply_track_mm=0.15))
    assert rules_of(fine, "flange").supply_track_mm == COMMON_MM["track_mm"]


def test_coarser_rules_of_a_file_hold_on_every_board(designs: Designs) -> None:
    usual = designs("small")
    coarse = replace(usual, rules=replace(usual.rules, track_mm=0.3, via_mm=0.8))
    rules = rules_of(coarse, "breakout")
    assert (rules.track_mm, rules.via_mm) == (0.3, 0.8)


def test_a_gap_at_the_edge_that_a_file_writes_holds_beside_common_tracks(designs: Designs) -> None:
    usual = designs("small")
    near = replace(usual, rules=replace(usual.rules, edge_gap_mm=0.3))
    assert rules_of(near, "emitter").edge_gap_mm == 0.3


def test_a_panel_has_the_rules_of_its_board(designs: Designs) -> None:
    panelled = designs("panelled")
    fine = replace(panelled, rules=replace(panelled.rules, via_drill_mm=0.2))
    drills = {panel.board: rules_of(fine, panel.name).via_drill_mm for panel in fine.panels}
    assert len(drills) >= 2
    assert drills == {name: 0.2 if name == "receiver" else 0.3 for name in drills}
