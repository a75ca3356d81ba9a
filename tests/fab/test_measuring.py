"""The manual's step of measuring: figures without a sure source, before long prints."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from lumitip_fab.catalogue.grippers import ToolCoupling
from lumitip_fab.config.load import Input
from lumitip_fab.design import Design
from lumitip_fab.design.boards import thickness_off_mm
from lumitip_fab.design.encoding import read_design
from lumitip_fab.docs.front import front
from lumitip_fab.docs.measuring import measuring
from lumitip_fab.text import table_of

HTML = "manual/manual.html"
Written = Callable[..., Design]


def rows(design: Design) -> dict[str, tuple[str, ...]]:
    """Value with its source, way to measure and file of each figure."""
    row = r"^" + 4 * r"\| (.*?) " + r"\|$"
    found = re.findall(row, measuring(design), re.MULTILINE)
    return {name.strip("`"): tuple(cells) for name, *cells in found[1:]}


def test_figures_without_a_sure_source_are_measured(written: Written) -> None:
    design = written()
    shown = rows(design)
    into_mm = design.mount.bolt_length_mm - design.mount.land_mm
    assert shown["depth of the gripper's thread"][0] == f"M5 x 12, {into_mm:.1f} mm into it"
    assert shown["bolt"][0] == "M5, inferred"
    assert shown["seat_back_w_mm"][0] == "19.1 mm, assumed"
    assert shown["holder.body_mm"][0] == "75 mm, inferred"
    assert shown["contacts_depth_mm"][0] == "6.4 mm, inferred"
    assert not {"bolt_w_mm", "recess_mm", "stroke_mm"} & shown.keys(), "measured, or not printed"
    files = {name: cells[-1].strip("`") for name, cells in shown.items()}
    assert files == {
        "depth of the gripper's thread": "no file",
        "bolt": "grippers.toml",
        "seat_back_w_mm": "grippers.toml",
        "holder.body_mm": "the parameter file",
        "contacts_depth_mm": "couplings.toml",
    }
    text = " ".join(measuring(design).split())
    assert "`grippers.toml` below `[robotiq_2f85]`" in text
    assert '`couplings.toml` below `["Robotiq I/O"]`' in text


def test_a_measured_figure_leaves_the_list(written: Written, inputs: dict[str, Input]) -> None:
    assert "holder.body_mm" not in rows(written({"holder.body_mm": 75.0}))
    assert "contacts_depth_mm" not in rows(written({"flange.enabled": False}))
    config = inputs["published"]
    gripper = config.parts.coupling.gripper
    mine = gripper.origin["bolt"].model_copy(update={"confidence": "measured"})
    own = gripper.model_copy(update={"origin": {**gripper.origin, "bolt": mine}})
    assert "bolt" not in own.unsure
    assert set(own.unsure) == {"force_n", "seat_back_w_mm", "supply_a"}
    sure = replace(written(), mount=replace(written().mount, unsure=()), flanges=())
    assert "grippers.toml" not in measuring(sure)


def test_figures_of_pins_and_nose_have_rows_of_their_own(written: Written) -> None:
    shown = rows(written({}, "robotiq_2f140"))
    assert shown["pins.hole_mm"][0] == "2.4 mm, assumed"
    assert shown["nose.half_angle_deg"][0] == "30°, assumed"
    assert "land_mm" not in shown, "chosen"


def test_every_figure_of_a_coupling_has_a_way_to_measure_it() -> None:
    ways = set(table_of("docs/measuring.toml")["coupling"])
    assert ways == set(ToolCoupling.figures()) - {"bolts_mm", "pin_at_mm", "contacts"}


def test_an_origin_of_an_unknown_figure_is_rejected(inputs: dict[str, Input]) -> None:
    coupling = inputs["published"].parts.flange.coupling
    values = coupling.model_dump()
    values["origin"]["depth_mm"] = values["origin"]["contacts_depth_mm"]
    with pytest.raises(ValueError, match="depth_mm, which is not a figure of a coupling"):
        ToolCoupling.model_validate(values)


@pytest.mark.parametrize("pcb_mm", [1.45, 1.75, 1.86])
def test_a_pocket_follows_the_board_that_is_measured(written: Written, pcb_mm: float) -> None:
    force = {"finger.rated_force_n": 35.0}
    drawn, own = written(force), written({**force, "stack.pcb_mm": pcb_mm})
    assert own.layout.design_hash == drawn.layout.design_hash
    for measured, other in ((own, drawn), (drawn, own)):
        stack = measured.stack
        assert stack.rim_z_mm - stack.pocket_z_mm == pytest.approx(stack.pcb_mm)
        assert (stack.silicone_mm, stack.floor_mm) == (
            other.stack.silicone_mm,
            other.stack.floor_mm,
        )
    assert own.mount.block_back_w_mm == drawn.mount.block_back_w_mm


def test_boards_are_sold_thicker_and_thinner_than_drawn() -> None:
    assert thickness_off_mm(1.6) == pytest.approx(0.16)
    assert thickness_off_mm(0.8) == pytest.approx(0.1)


def test_what_waits_has_the_adhesive_of_the_flaps_and_the_pin(written: Written) -> None:
    begin = " ".join(front(written()).split())
    waiting = begin.partition("Waiting takes longest: ")[2].partition(". Both")[0]
    assert waiting.endswith("for the flaps' adhesive; meanwhile 24 h for the flange's pin")
    assert waiting.count("24 h") == 4
    assert "flange's pin" not in front(written({"flange.enabled": False}))


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["published", "flex", "wsg50"])
def test_the_slice_is_tried_on_the_gripper_before_the_backings_are_printed(
    built: Callable[[str], Path], preset: str
) -> None:
    folder = built(preset)
    text = re.sub(r"<[^>]*>", "", (folder / HTML).read_text(encoding="utf-8"))
    words = " ".join(text.split())
    work = ["Measure your gripper", "for each PCB fab", "on the gripper: try its", "print the rest"]
    measured = "as sold, 1.6 mm is 1.44 to 1.76 mm. If one is thicker than 1.65 mm" in words
    assert measured == ("must not stand above it" in words) == (preset != "flex")
    assert sorted(work, key=words.index) == work
    seat = "pins and seat" if read_design(folder / "design.json").mount.pin_u_mm else "seat"
    assert f"try its {seat}." in words
