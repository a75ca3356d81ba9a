"""STEP files that may be read in several ways: what they do not show beyond doubt stays open."""

from typing import Any

import pytest
from build123d import Axis, Shape

from fingertip_shapes import (
    across,
    block,
    bolts,
    bore,
    box,
    face_at,
    figures_of,
    from_pad,
    plain,
    proposal_of,
)
from lumitip_fab.config.load import Input
from lumitip_fab.errors import InputError

PAD = {"pad_w_mm", "bolt_w_mm", "block_back_w_mm"}
BLOCK = {"block_width_mm", *PAD}
BOLTS = {"bolt", "bolt_hole_mm", "bolt_spacing_mm", "counterbore_mm", "land_mm"}


def noted(shape: Shape, config: Input, **named: Any) -> str:
    return "\n".join(proposal_of(shape, config, **named).notes)


def numbers_of(shape: Shape, config: Input, diameter_mm: float) -> tuple[int, ...]:
    found = proposal_of(shape, config).holes
    return tuple(k + 1 for k, hole in enumerate(found) if abs(hole.narrow_mm - diameter_mm) < 0.01)


PADS = {
    "block in front": (box((-10, 10), (-12, -8), (35, 50)), -12.0, (14.0, 20.0)),
    "lip": (box((-12, 12), (-10, -8), (48, 50)), -8.0, (10.0, 16.0)),
}


@pytest.mark.parametrize("name", PADS)
def test_of_the_faces_that_may_grip_the_user_names_one(name: str, config: Input) -> None:
    more, y, expected = PADS[name]
    tip = block(*bolts(-7, 7)) + more
    found = proposal_of(tip, config)
    assert not PAD & set(found.figures)
    assert found.open >= PAD
    assert "Which face grips is not certain" in "\n".join(found.notes)
    assert len(found.pads) == 3
    named = proposal_of(tip, config, pad=face_at(tip, y))
    assert (named.figures["pad_w_mm"].value, named.figures["block_back_w_mm"].value) == expected
    assert not named.notes


def test_a_groove_in_the_pad_does_not_make_the_back_the_pad(config: Input) -> None:
    tip = block(*bolts(-7, 7)) - box((-2.85, 2.85), (-9, -5), (-1, 51))
    assert not {"pad_w_mm", "bolt_w_mm"} & set(figures_of(tip, config))
    values = figures_of(tip, config, pad=face_at(tip, -8.0))
    assert (values["pad_w_mm"], values["block_back_w_mm"]) == (10.0, 16.0)


def flanged(*cut: Shape) -> Shape:
    """An L-shaped tip with a flange of 8 mm."""
    return box((-12, 12), (-8, 8), (0, 8)) + box((-12, 12), (-8, -2), (0, 50)) - list(cut)


def test_recesses_for_sleeves_do_not_turn_the_part_over(config: Input) -> None:
    sleeves = [bore(x, 4, 8.0, -1, 2.6) for x in (-7, 7)]
    values = figures_of(flanged(*plain(-7, 7, y=4.0), *sleeves), config)
    assert not {"counterbore_mm", "land_mm"} & set(values)
    assert [values[f"pins.{n}_mm"] for n in ("hole", "spacing", "depth")] == [8.0, 14.0, 2.6]
    assert values["pad_w_mm"] == 12.0


def test_the_user_names_the_mount_face_where_both_ends_may_be_it(config: Input) -> None:
    shallow = [bore(x, 2, 8.0, 48, 51) for x in (-7, 7)]
    tip = block(*plain(-7, 7), *shallow) - box((-13, 13), (5, 9), (40, 51))
    found = proposal_of(tip, config, pad=face_at(tip, -8.0))
    assert "Which face stands on the gripper is not certain" in "\n".join(found.notes)
    assert not {"counterbore_mm", "land_mm", "block_back_w_mm"} & set(found.figures)
    assert found.figures["pad_w_mm"].value == 10.0
    mount = face_at(tip, 0.0, axis=2)
    values = figures_of(tip, config, pad=face_at(tip, -8.0), mount=mount)
    assert (values["counterbore_mm"], values["land_mm"]) == (8.0, 48.0)


def test_pins_off_the_row_of_bolts_stay_open(config: Input) -> None:
    for places in ([(-7, -5), (7, -5)], [(-10, 2), (9, 2)], [(-10, 2)]):
        found = proposal_of(block(*bolts(-6, 6), *(bore(*at, 2.5, -1, 4) for at in places)), config)
        assert {"pins.hole_mm", "pins.spacing_mm", "pins.depth_mm"} <= found.open
        assert not any(name.startswith("pins.") for name in found.figures)
        assert "no pair of pins in line with the bolts" in "\n".join(found.notes)


def test_pins_that_go_through_have_no_depth(config: Input) -> None:
    tip = block(*bolts(-5, 5), *plain(-10.5, 10.5, hole=2.5))
    values = figures_of(tip, config, bolts=numbers_of(tip, config, 4.5))
    assert (values["pins.hole_mm"], values["pins.spacing_mm"]) == (2.5, 21.0)
    assert "pins.depth_mm" not in values


SETS = {
    "dowels": block(*plain(-7, 7), *plain(-3, 3, y=-4.0, hole=5.0)),
    "cross holes": block(*plain(-7, 7), *(across(-4, z, 3.0) for z in (20, 30, 40))),
    "screws of the pad": block(
        *plain(-7, 7),
        *(from_pad(x, 35, 3.4, -9, 9) for x in (-2, 2)),
        *(from_pad(x, 35, 6.5, -9, -4) for x in (-2, 2)),
    ),
}


@pytest.mark.parametrize("name", SETS)
def test_of_several_sets_of_through_holes_the_user_names_the_bolts(
    name: str, config: Input
) -> None:
    tip = SETS[name]
    found = proposal_of(tip, config)
    assert not BOLTS & set(found.figures)
    assert "Which holes are for the bolts is not certain" in found.notes[0]
    values = figures_of(tip, config, bolts=numbers_of(tip, config, 4.5))
    assert (values["bolt"], values["bolt_hole_mm"], values["bolt_spacing_mm"]) == ("M4", 4.5, 14.0)
    assert values["block_width_mm"] == 24.0


def test_a_row_of_bolts_towards_the_pad_is_doubted(config: Input) -> None:
    tip = block(bore(0, -4, 4.5, -1, 51), bore(0, 4.5, 4.5, -1, 51))
    found = proposal_of(tip, config)
    assert not BLOCK & set(found.figures)
    assert "square to the row of bolts" in "\n".join(found.notes)
    named = proposal_of(tip, config, pad=face_at(tip, -8.0))
    assert not BLOCK & set(named.figures)
    assert "square to the row of bolts" in "\n".join(named.notes)


def test_bolts_across_the_finger_are_doubted(config: Input) -> None:
    for tip in (
        box((-10, 10), (-6, 6), (0, 50)) - [across(0, z, 4.5) for z in (6, 16)],
        box((-10, 10), (-30, 30), (-4, 4)) - [bore(x, 20, 4.5, -9, 9) for x in (-6, 6)],
    ):
        found = proposal_of(tip, config)
        assert not BLOCK & set(found.figures)
        assert "If its bolts do not run along the finger" in "\n".join(found.notes)


SLOT = [bore(6, 2, 4.5, -1, 51), bore(8, 2, 4.5, -1, 51), box((6, 8), (-0.25, 4.25), (-1, 51))]


def test_four_bolts_or_a_slot_leave_the_block_open(config: Input) -> None:
    four = proposal_of(block(*(b for y in (-4, 4) for b in plain(-7, 7, y=y, hole=3.4))), config)
    assert not {"bolt_spacing_mm", *BLOCK} & set(four.figures)
    assert "4 equal holes are taken for bolts" in "\n".join(four.notes)
    slotted = proposal_of(block(*plain(-7), *SLOT), config)
    assert not {"bolt_spacing_mm", *BLOCK} & set(slotted.figures)
    assert {"bolt_spacing_mm", *BLOCK} <= slotted.open
    assert "There are slots of 4.5 mm along the bolts" in "\n".join(slotted.notes)


def test_a_block_beside_its_bolts_is_not_made_wider_than_it_is(config: Input) -> None:
    tip = block(*bolts(-9, 3))
    assert figures_of(tip, config)["block_width_mm"] == 18.0
    assert "which reaches" in noted(tip, config)


def test_a_groove_and_bosses_do_not_make_the_block_smaller(config: Input) -> None:
    between = block(*bolts(-7, 7), box((-3, 3), (-9, 9), (-1, 2)))
    assert figures_of(between, config)["block_width_mm"] == 24.0
    around = box((-13, 13), (-9, 9), (-1, 1)) - [bore(x, 0, 9.5, -2, 2) for x in (-7, 7)]
    behind = box((-13, 13), (5, 6), (-1, 1))
    for tip in (block(*bolts(-7, 7, y=0.0), around), block(*bolts(-7, 7, y=0.0, head=7.5), behind)):
        found = proposal_of(tip, config, pad=face_at(tip, -8.0))
        assert found.figures["block_width_mm"].value == 24.0
        assert "block_back_w_mm" in found.open
        assert "The block reaches beyond the mount face round the bolts" in found.notes[0]


@pytest.mark.parametrize(("hole", "thread"), [(3.3, "M4"), (6.8, "M8"), (4.2, "M5")])
def test_a_tap_drill_is_no_clearance_hole(hole: float, thread: str, config: Input) -> None:
    tip = block(*plain(-7, 7, hole=hole))
    assert not {"bolt", "bolt_hole_mm"} & set(figures_of(tip, config))
    assert f"A hole of {hole:g} mm may be tapped for {thread}" in noted(tip, config)


def test_the_lean_of_a_pad_is_noted_and_is_no_tilt(config: Input) -> None:
    before = box((-13, 13), (-18, -6), (-1, 51)).rotate(Axis.X, 1.5)
    tip = block(*bolts(-7, 7)) - before
    found = proposal_of(tip, config, pad=face_at(tip, 8.0) % 2 + 1)
    assert "tilt_deg" not in found.figures
    assert "The pad leans 1.50 degrees against the bolts" in "\n".join(found.notes)


def test_a_number_that_is_none_of_the_part_is_one_error(config: Input) -> None:
    tip = SETS["dowels"]
    for option, value, allowed in (
        ("bolts", (1, 9), r"1,9; equal .* allowed: 3,4; 1,2"),
        ("mount", 40, "40; a face that the bolts' holes open into is allowed: "),
        ("pad", 3, "3; a face that may be the pad is allowed: 1,2"),
    ):
        with pytest.raises(InputError, match=f"--{option} is {allowed}"):
            proposal_of(tip, config, **{option: value})
