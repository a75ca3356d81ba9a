"""The gripper's cable: its maker's, or one from the flange's headers."""

from collections.abc import Callable
from dataclasses import replace

from lumitip_fab.design import Design
from mounting_text import steps

Written = Callable[..., Design]


def modest(design: Design) -> Design:
    """With a gripper whose current is not known."""
    return replace(design, mount=replace(design.mount, supply_a=0.0))


def test_a_gripper_that_draws_more_gets_its_makers_cable(written: Written) -> None:
    step = steps(written())
    assert "takes up to 1 A" in step and "board carry 0.54 A" in step
    assert "use the cable that its maker has for robots without such a coupling" in step
    assert "put a fuse of the gripper's own rating" not in step
    less = written()
    less = replace(less, mount=replace(less.mount, supply_a=0.5))
    assert "carry 0.54 A: either will do" in steps(less)


def test_the_gripper_gets_the_supply_before_the_fuse(written: Written) -> None:
    step = steps(modest(written()))
    assert "The robot's lines are on J2. Its 24 V are on J3.7 and J3.8, before the fuse" in step
    work = ["use the cable that its maker has", "Take the gripper off", "wires in the same socket"]
    work += ["Connect the gripper with its cable, and plug the socket of W3 in at J3"]
    assert sorted(work, key=step.index) == work


def test_the_gripper_s_own_cable_has_a_fuse_and_a_limit(written: Written) -> None:
    step = steps(modest(written()))
    assert "at most 0.09 mm² of copper, which at 3 A/mm² is 0.27 A, and together 0.54 A" in step
    assert "a fuse of the gripper's own rating into the wire that starts there" in step
    assert "40 mm longer than their way" in step


def test_another_supply_is_named_by_its_voltage(written: Written) -> None:
    step = steps(modest(written({"supply.voltage_v": 12.0})))
    assert "Its 12 V are on J3.7 and J3.8" in step and "Its 24 V" not in step
    asked = "entry says 24 V for the supply contact, and this flange takes 12 V."
    assert asked in step and "for the supply contact" not in steps(written())


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


def test_a_flange_without_lines_names_none(written: Written) -> None:
    step = steps(modest(written(CLOSED)))
    assert "The robot's lines" not in step and "Its 24 V are on J3.7" in step
