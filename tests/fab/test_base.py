"""A flange follows from the gripper: where its base is that of the coupling, and nowhere else."""

import dataclasses
from typing import Any

import pytest

from lumitip_fab.config.load import Input, load
from lumitip_fab.derive import derive
from lumitip_fab.derive.auto.resolve import RuleError
from lumitip_fab.docs.spec import choice_rows

MODULE = '[controller]\nboard = "nrf52840_module"\n[breakout]\nenabled = false\n'


def _on(gripper: str, more: str = "") -> str:
    return f'[coupling]\ngripper = "{gripper}"\n{more}'


@pytest.mark.parametrize(
    ("gripper", "made"), [("robotiq_2f85", 1), ("robotiq_2f140", 1), ("wsg50", 0)]
)
def test_a_file_that_names_a_gripper_alone_has_the_flange_that_fits_it(
    file: Any, gripper: str, made: int
) -> None:
    design = derive(load(file(_on(gripper))))
    assert len(design.flanges) == made
    assert [b.name for b in design.auxiliary_boards].count("flange") == made
    (row,) = [row for row in choice_rows(design) if row.quantity == "flange.enabled"]
    assert row.computed == str(bool(made)).lower()
    assert gripper in row.reason
    others = [row for row in choice_rows(design) if row.quantity.startswith("flange.")]
    assert len(others) == 1 or made, "parts of a flange that is not made are no choice"


def test_only_the_grippers_whose_entry_says_so_stand_on_the_coupling(
    inputs: dict[str, Input],
) -> None:
    catalogue = inputs["published"].catalogue
    bases = {coupling.base for coupling in catalogue.couplings.values()}
    standing = {name for name, gripper in catalogue.grippers.items() if gripper.base in bases}
    assert standing == {"robotiq_2f85", "robotiq_2f140"}


def test_a_gripper_of_ones_own_with_that_base_has_a_flange(inputs: dict[str, Input]) -> None:
    config = inputs["wsg50"]
    own = config.catalogue.grippers["wsg50"].model_copy(update={"base": "Robotiq 2F"})
    catalogue = config.catalogue.model_copy(
        update={"grippers": {**config.catalogue.grippers, "wsg50": own}}
    )
    open_field = frozenset({"flange.enabled"})
    assert derive(dataclasses.replace(config, catalogue=catalogue, automatic=open_field)).flanges
    assert not derive(dataclasses.replace(config, automatic=open_field)).flanges


def test_a_wish_counts_where_it_can_be_met(file: Any) -> None:
    off = "[flange]\nenabled = false\n"
    assert not derive(load(file(_on("robotiq_2f85", off)))).flanges
    with pytest.raises(RuleError) as caught:
        derive(load(file(_on("wsg50", "[flange]\nenabled = true\n"))))
    (problem,) = caught.value.problems
    assert problem.field == "flange.enabled"
    for part in ("is true", "wsg50 has no base", "'Robotiq I/O'", '"auto" or false', "base = "):
        assert part in problem.message


def test_a_module_needs_a_gripper_that_has_a_flange(file: Any) -> None:
    assert derive(load(file(_on("robotiq_2f140", MODULE)))).flanges
    with pytest.raises(RuleError) as caught:
        derive(load(file(_on("wsg50", MODULE))))
    (problem,) = caught.value.problems
    assert problem.field == "controller.board"
    assert "there can be no flange: wsg50 has no base" in problem.message
    assert "flange.enabled = true" not in problem.message
