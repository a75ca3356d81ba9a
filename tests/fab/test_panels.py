"""Which boards get a panel, and how large it is."""

import dataclasses
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.boards.fab.notes import assembly_note
from lumitip_fab.boards.placement import place
from lumitip_fab.config.load import Input
from lumitip_fab.derive import derive
from lumitip_fab.design import Design, Panel
from lumitip_fab.design.least_size import is_too_small
from lumitip_fab.docs.bill import electronics
from lumitip_fab.docs.boards import ordering
from lumitip_fab.docs.spec import outside
from lumitip_fab.errors import InputError
from lumitip_fab.pipeline.artefact import Files

RAILS = {"board.panel": "rails"}


@pytest.fixture(scope="module")
def panels(inputs: dict[str, Input], vary: Any) -> dict[str, Panel]:
    """The panels of the published design, by board."""
    return {panel.board: panel for panel in derive(vary(inputs["published"], RAILS)).panels}


def with_limits(config: Input, **limits: Any) -> Input:
    """A file whose PCB fabs have other figures of panels, or none."""
    fabs = {
        name: fab.model_copy(
            update={"panel": fab.panel.model_copy(update=limits) if limits and fab.panel else None}
        )
        for name, fab in config.catalogue.fabs.items()
    }
    return dataclasses.replace(config, catalogue=config.catalogue.model_copy(update={"fabs": fabs}))


@pytest.mark.slow_cases
@pytest.mark.parametrize("preset", ["published", "dense", "flex", "integrated"])
def test_no_preset_has_panels(inputs: dict[str, Input], preset: str) -> None:
    assert derive(inputs[preset]).panels == ()


def test_each_small_board_has_the_smallest_panel_that_all_fabs_assemble(
    panels: dict[str, Panel],
) -> None:
    assert {name: (p.columns, p.rows) for name, p in panels.items()} == {
        "emitter": (2, 2),
        "receiver": (2, 2),
        "breakout": (2, 2),
        "flange": (2, 1),
    }
    for panel in panels.values():
        assert panel.box.width_mm >= panel.rules.least_mm[0] == 70.0
        assert panel.box.length_mm >= panel.rules.least_mm[1] == 70.0
        assert panel.rail_mm == 6.0
        assert panel.tabs == 2


def test_copies_stand_in_the_middle_of_the_frame(panels: dict[str, Panel]) -> None:
    for panel in (panels["receiver"], panels["breakout"]):
        places = sorted(panel.copies)
        assert places[0][0] + places[-1][0] == pytest.approx(2 * _middle(panel)[0])
        assert len(places) == panel.columns * panel.rows


def _middle(panel: Panel) -> tuple[float, float]:
    xs, ys = zip(*panel.copies, strict=True)
    return sum(xs) / len(xs), sum(ys) / len(ys)


def test_gaps_are_wider_where_a_plug_reaches_over_the_edge(panels: dict[str, Panel]) -> None:
    flange, gap = panels["flange"], panels["flange"].rules.gap_mm
    frame = (flange.box.length_mm - 54.0 - 2 * flange.rail_mm) / 2
    assert frame == pytest.approx(4.1 + gap)  # the box header reaches 4.06 mm over
    assert flange.pitch[0] - 30.8 == pytest.approx(0.9 + gap)  # its shroud 0.82 mm


def test_a_tab_leaves_a_whole_web_beside_the_last_hole(panels: dict[str, Panel]) -> None:
    rules = panels["receiver"].rules
    radius = rules.gap_mm / 2
    across = radius - (rules.bite_mm / 2 - rules.bite_inset_mm)
    along = rules.tab_mm / 2 + radius - rules.bite_row_mm / 2
    web = (across**2 + along**2) ** 0.5 - radius - rules.bite_mm / 2
    assert web == pytest.approx(rules.bite_web_mm)


def test_boards_of_polyimide_have_none(inputs: dict[str, Input], vary: Any) -> None:
    found = derive(vary(inputs["flex"], RAILS)).panels
    assert {panel.board for panel in found} == {"breakout", "flange"}


def test_fabs_that_take_every_board_need_none(inputs: dict[str, Input], vary: Any) -> None:
    config = vary(inputs["published"], RAILS)
    assert derive(with_limits(config)).panels == ()
    assert derive(with_limits(config, least_mm=(20.0, 20.0))).panels == ()


SMALL = "emitter, receiver, breakout and flange"


def said(design: Design) -> dict[str, list[str]]:
    """Lines of spec and manual on boards that are too small for a fab."""
    ordered = ordering(design, Files(Path(), {}))
    return {
        "spec": [
            f"{row.quantity}: {row.computed}; {row.reason}"
            for row in outside(design)
            if row.quantity.startswith("least size for assembly")
        ],
        "manual": [line for line in ordered.splitlines() if line.startswith("Too small to")],
    }


def test_spec_and_manual_name_the_boards_that_a_fab_does_not_assemble(
    inputs: dict[str, Input], vary: Any
) -> None:
    design = derive(vary(inputs["published"], {"board.panel": "none"}))
    (line,) = said(design)["manual"]
    assert "all boards at jlcpcb (at least 70 x 70 mm);" in line
    assert "all boards at generic and pcbway (at least 50 x 50 mm)." in line
    rows = said(design)["spec"]
    assert [row.partition(", bare")[0].partition("; bare")[0] for row in rows] == [
        f"least size for assembly, {fabs}: {least}; by parts/fabs.toml; smaller: {SMALL}. "
        'board.panel = "rails" makes a panel of each'
        for fabs, least in (("jlcpcb", "70 x 70 mm"), ("generic and pcbway", "50 x 50 mm"))
    ]


def test_a_board_with_a_panel_or_of_the_least_size_is_not_named(
    inputs: dict[str, Input], vary: Any
) -> None:
    config, nothing = inputs["published"], {"spec": [], "manual": []}
    assert said(derive(vary(config, RAILS))) == nothing
    assert said(derive(with_limits(config, least_mm=(20.0, 20.0)))) == nothing
    assert said(derive(with_limits(config))) == nothing
    flexible = derive(inputs["flex"])
    (line,) = said(flexible)["manual"]
    assert "breakout and flange at jlcpcb (at least 70 x 70 mm)" in line


@pytest.mark.slow_cases
@pytest.mark.parametrize(("values", "small"), [({}, True), (RAILS, False)])
def test_the_note_in_the_zip_says_that_the_board_is_too_small(
    inputs: dict[str, Input], vary: Any, values: dict[str, str], small: bool
) -> None:
    design = derive(vary(inputs["published"], values))
    placed = place(design, design.emitter)
    for fab in design.fabs:
        note = assembly_note(placed, fab, is_too_small(design, "emitter", fab)).decode()
        least = "70 x 70" if fab.name == "jlcpcb" else "50 x 50"
        assert (f"\nSMALL BOARD: less than {least} mm" in note) == small


def test_longer_edges_have_more_tabs(inputs: dict[str, Input], vary: Any) -> None:
    config = with_limits(vary(inputs["published"], RAILS), tab_every_mm=15.0)
    tabs = {panel.board: panel.tabs for panel in derive(config).panels}
    assert tabs == {"emitter": 3, "receiver": 3, "breakout": 3, "flange": 4}


def test_copper_at_the_edge_is_refused(inputs: dict[str, Input], vary: Any) -> None:
    config = vary(inputs["published"], {**RAILS, "board.edge_gap_mm": 0.4})
    with pytest.raises(InputError, match=r"edge_gap_mm is 0\.4; a panel needs at least 0\.5"):
        derive(config)


def test_a_panel_that_no_fab_assembles_is_refused(inputs: dict[str, Input], vary: Any) -> None:
    config = with_limits(vary(inputs["published"], RAILS), most_mm=(90.0, 90.0))
    with pytest.raises(InputError, match=r"the panel of the receiver board would be 103\.6 x"):
        derive(config)


@pytest.mark.parametrize(("panel", "said"), [("none", True), ("rails", False)])
def test_the_bill_says_where_placing_takes_panels(
    panel: str, said: bool, inputs: dict[str, Input], vary: Any
) -> None:
    design = derive(vary(inputs["published"], {"board.panel": panel}))
    lines = electronics(design, Files(Path(), {}))
    (placing,) = [line for line in lines if line.item == "placing and soldering"]
    assert ("on panels alone: board.panel" in placing.where) == said
