"""With the controller on the flange's board: damage its cables or its bill, and exactly the right
checks fail."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import in_part
from damages import failing

Edit = Callable[[str], str]
FLANGE, LIST = "boards/flange/flange.kicad_pcb", "wiring/cables.csv"
HEADER, BILL = "firmware/layout.h", "bom.csv"
BOUGHT_TOO = "electronics,Raytac MDBT50Q,,Raytac MDBT50Q,,1,piece,,"
pytestmark = pytest.mark.slow


@pytest.fixture
def copied(built: Callable[[str], Path], tmp_path: Path) -> Path:
    """A copy of what wiring and bill are read from, to damage."""
    return Path(shutil.copytree(built("integrated"), tmp_path / "copied"))


def replaced(old: str, new: str) -> Edit:
    def edit(text: str) -> str:
        assert old in text
        return text.replace(old, new, 1)

    return edit


def pads_exchanged(text: str) -> str:
    """The module's pads of the pins A2 and A3 on each other's net."""
    text = in_part(text, "U2", r'(pad "14"[^\n]*)"A2_PIN"', r'\g<1>"A?"')
    text = in_part(text, "U2", r'(pad "10"[^\n]*)"A3_PIN"', r'\g<1>"A2_PIN"')
    return in_part(text, "U2", r'(pad "14"[^\n]*)"A\?"', r'\g<1>"A3_PIN"')


DAMAGES: list[tuple[str, Edit, str, set[str]]] = [
    (HEADER, replaced("A2, A3", "A3, A2"), "wiring", {"pins"}),
    (HEADER, replaced("SELECT_PINS 2, 3", "SELECT_PINS 3, 2"), "wiring", {"pins"}),
    (FLANGE, pads_exchanged, "wiring", {"pins"}),
    (LIST, replaced("flange,J4.3,", "flange,J4.9,"), "wiring", {"ends", "pins", "note", "diagram"}),
    (LIST, replaced("flange,J5.2,", "supply,1,"), "wiring", {"ends", "note", "diagram"}),
    (BILL, replaced("MDBT50Q-1MV2", "MDBT50Q-P1MV2"), "bom", {"parts", "prices", "uses"}),
    (BILL, replaced("\nboards,", f"\n{BOUGHT_TOO}\nboards,"), "bom", {"parts", "pieces"}),
]


@pytest.mark.parametrize(("file", "edit", "module", "expected"), DAMAGES)
def test_a_damage_fails_its_check(
    copied: Path, file: str, edit: Edit, module: str, expected: set[str]
) -> None:
    path = copied / file
    path.write_text(edit(path.read_text(encoding="utf-8")), encoding="utf-8")
    assert failing(copied, module) == expected


def test_nothing_is_made_for_a_controller_elsewhere(copied: Path) -> None:
    assert not (copied / "holder").exists()
    assert not (copied / "boards/breakout").exists()
    assert "arduino" not in (copied / BILL).read_text(encoding="utf-8").lower()
