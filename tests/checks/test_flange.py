"""Damage the flange's files, and exactly the right checks fail."""

from pathlib import Path

import pytest

from board_damages import in_part, moved_part
from damages import carve, failing, flip_a_triangle
from flange_damages import LOWERS, UPPERS, Damage
from lumitip_fab.checks import flange as checks
from lumitip_fab.design.encoding import read_design
from lumitip_fab.design.frames import flange_beds

pytestmark = pytest.mark.slow

LOWER, UPPER = "flange/flange_lower.stl", "flange/flange_upper.stl"
WIDE_BOARD = {"board_gap", "board_play", "bolt_board", "interference"}


def _hurt(folder: Path, file: str, part: str, damage: Damage) -> set[str]:
    (flange,) = read_design(folder / "design.json").flanges
    carve(folder / file, damage, flange_beds(flange)[part])
    return failing(folder, "flange")


@pytest.mark.parametrize("damage", LOWERS, ids=lambda d: d.__name__)
def test_a_damage_of_the_lower_part(damage: Damage, damaged: Path) -> None:
    assert _hurt(damaged, LOWER, "lower", damage) == LOWERS[damage]


@pytest.mark.parametrize("damage", UPPERS, ids=lambda d: d.__name__)
def test_a_damage_of_the_upper_part(damage: Damage, damaged: Path) -> None:
    assert _hurt(damaged, UPPER, "upper", damage) == UPPERS[damage]


def test_the_boards_own_file_is_what_counts(damaged: Path) -> None:
    """One of its screw holes elsewhere does not meet that in the floor."""
    path = damaged / "boards/flange/flange.kicad_pcb"
    path.write_text(moved_part(path.read_text(), "H2", 0.4, 0.0))
    assert failing(damaged, "flange") == {"screws", "screw_clearance", "head_clearance"}


def test_contacts_that_stand_elsewhere_do_not_come_through(damaged: Path) -> None:
    path = damaged / "boards/flange/flange.kicad_pcb"
    path.write_text(moved_part(path.read_text(), "J1", 0.0, 2.0))
    assert failing(damaged, "flange") == {"window", "window_gap", "interference"}


def test_contacts_on_the_front_press_nothing(damaged: Path) -> None:
    path = damaged / "boards/flange/flange.kicad_pcb"
    path.write_text(in_part(path.read_text(), "J1", r'\(layer "B.Cu"\)', '(layer "F.Cu")'))
    assert failing(damaged, "flange") == {"contact_press"}


def test_a_board_that_is_too_wide_reaches_the_bolts(damaged: Path) -> None:
    path = damaged / "boards/flange/flange.kicad_pcb"
    path.write_text(path.read_text().replace("165.4 ", "169.0 "))
    assert failing(damaged, "flange") == WIDE_BOARD


def test_an_open_surface_is_told(damaged: Path) -> None:
    flip_a_triangle(damaged / LOWER)
    assert "watertight" in failing(damaged, "flange")


def test_a_missing_file_is_seen(damaged: Path) -> None:
    (damaged / UPPER).unlink()
    assert failing(damaged, "flange") == {"readable"}


def test_every_check_fails_for_some_damage(outputs: Path) -> None:
    found = list(checks.measure(outputs, read_design(outputs / "design.json")))
    assert [m for m in found if not m.passed] == []
    names = {m.check.removeprefix("flange.") for m in found}
    named = set().union(*LOWERS.values(), *UPPERS.values(), WIDE_BOARD)
    assert names - named == {"readable", "watertight"}
