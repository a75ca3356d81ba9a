"""The gripper's cable: its maker's, or one from the flange's headers."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from lumitip_fab.config.load import Input
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.warming import MOST_K, bearable_a, warming_k
from lumitip_fab.docs.gripper_cable import own_cable
from mounting_text import steps

Written = Callable[..., Design]


def drawing(design: Design, supply_a: float) -> Design:
    """With a gripper that draws so much; 0 is not known."""
    return replace(design, mount=replace(design.mount, supply_a=supply_a))


def test_a_gripper_that_draws_more_gets_its_makers_cable(written: Written) -> None:
    step = steps(drawing(written(), 2.5))
    assert "takes up to 2.5 A" in step and "board carry 1.7 A" in step
    assert "use the cable that its maker has for robots without such a coupling" in step
    assert "a fuse of the gripper's own rating" not in step and "the gripper's |" not in step
    assert "has its wires in the same socket" not in step
    assert "takes up to 1 A by its entry in `grippers.toml`, and the contacts here carry 1.7 A" in (
        steps(written())
    )


def test_contacts_of_ground_limit_what_the_headers_carry(written: Written) -> None:
    supplies = ("REGULATED", "SUPPLY", *("SUPPLY_IN",) * 4, "GND")
    own = own_cable(written({"flange.headers": (("CASING", *LINES[1:]), supplies)}))
    assert len(own.fed_from) == 8 and own.most_a == 1, "a wire of the fingers has the other GND"


def test_what_a_gripper_s_cable_needs_is_bought(inputs: dict[str, Input]) -> None:
    def bought(supply_a: float | None) -> dict[str, float]:
        config = inputs["published"]
        name, catalogue = config.parameters.coupling.gripper, config.catalogue
        gripper = catalogue.grippers[name].model_copy(update={"supply_a": supply_a})
        grippers = {**catalogue.grippers, name: gripper}
        changed = catalogue.model_copy(update={"grippers": grippers})
        pieces = derive(replace(config, catalogue=changed)).purchase.pieces
        return {
            p.pack: p.quantity for p in pieces if "gripper" in p.pack or p.pack.endswith("mate")
        }

    mate = "box header 2x7 mate"
    assert bought(None) == bought(1.7) == {mate: 2, "gripper cable": 1, "gripper fuse": 1}
    assert bought(1.8) == {mate: 1, "gripper cable by maker": 1}


def test_the_gripper_gets_the_supply_before_the_fuse(written: Written) -> None:
    step = steps(written())
    assert "Its 24 V, before the fuse and open to reversed polarity, are on J3.7 and J3.8" in step
    work = ["use the one that its maker has", "Take the gripper off", "wires in the same socket"]
    work += ["Connect the gripper with its cable, and plug the socket of W3 in at J3"]
    assert sorted(work, key=step.index) == work


def test_the_gripper_s_own_cable_has_a_fuse_and_a_limit(written: Written) -> None:
    step = steps(written())
    assert "takes 0.09 mm² (AWG 28) and 1 A, all together, with GND and tracks, 1.7 A" in step
    assert "join the wires of them all to one, with a fuse of the gripper's own rating" in step


def test_another_supply_is_named_by_its_voltage(written: Written) -> None:
    step = steps(written({"supply.voltage_v": 12.0}))
    assert "Its 12 V, before the fuse and" in step and "Its 24 V" not in step
    asked = "entry says 24 V for the supply contact, and this flange takes 12 V."
    assert asked in step and "for the supply contact" not in steps(written())


@pytest.mark.parametrize(("width_mm", "by_maker"), [(0.25, True), (0.26, False)])
def test_tracks_limit_what_the_headers_carry(
    width_mm: float, by_maker: bool, written: Written
) -> None:
    """By IPC-2221 1 A warms a track of 0.3 mm and 35 µm by 10 K."""
    assert bearable_a(0.3, 35.0, 10.0) == pytest.approx(1.0, rel=0.002)
    assert warming_k(1.0, 0.3, 35.0) == pytest.approx(10.0, rel=0.005)
    own = own_cable(written({"board.supply_track_mm": width_mm}))
    assert own.by_maker == by_maker and own.supply_a == 1
    assert own.most_a <= bearable_a(width_mm, 35.0, MOST_K) - 0.19 < own.most_a + 0.1


LINES = ("GND", "CASING", "Von", "485+", "485-", "3V3_out", "485GND")
SUPPLIES = ("REGULATED", "REGULATED", "SUPPLY", "SUPPLY_IN", "GND", "GND", "GND")
BEHIND = {"flange.headers": (LINES, (*SUPPLIES[:3], "SUPPLY", *SUPPLIES[4:]))}
CLOSED = {
    "flange.signals": ("GND", "GND", "SUPPLY", *["NC"] * 7),
    "flange.headers": (("GND",) * 7, SUPPLIES),
}


def test_a_supply_behind_the_fuse_is_not_offered(written: Written) -> None:
    step = steps(written(BEHIND))
    assert "do not feed the gripper from it" in step and "before the fuse" not in step


def test_headers_that_offer_nothing_leave_the_maker_s_cable(
    written: Written, inputs: dict[str, Input], vary: Any
) -> None:
    assert "A cable of your own for the gripper starts here" in steps(written(CLOSED))
    behind = (("GND",) * 7, (*SUPPLIES[:3], "SUPPLY", *SUPPLIES[4:]))
    changes = CLOSED | {"flange.headers": behind}
    step = steps(written(changes))
    assert "have neither a supply nor lines for it. So use the cable that its maker has" in step
    assert "A cable of your own" not in step and "the gripper's |" not in step
    pieces = [p.pack for p in derive(vary(inputs["published"], changes)).purchase.pieces]
    assert "gripper cable by maker" in pieces and "gripper cable" not in pieces


def test_a_current_that_is_not_known_is_asked_for(written: Written) -> None:
    step = steps(drawing(written(), 0.0))
    assert "carry 1.7 A: if the gripper draws more by its manual, or more than the robot's" in step


def test_spring_contacts_of_the_robot_limit_what_the_headers_carry(written: Written) -> None:
    design = written()
    (flange,) = design.flanges
    for contact_a, most_a in ((2.0, 1.7), (1.0, 0.7), (0.0, 0.0)):
        own = own_cable(replace(design, flanges=(replace(flange, contact_a=contact_a),)))
        assert (own.most_a, own.by_maker) == (most_a, most_a < 1)
