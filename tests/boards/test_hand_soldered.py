"""The spring contacts of the flange are soldered on by hand: no fab's tables have them."""

import csv
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import in_part, rezip
from damages import edit, failing

pytestmark = pytest.mark.slow

Boards = Callable[[str], Path]
Files = dict[str, bytes]
ORDER = "boards/flange/order"
BOARD = "boards/flange/flange.kicad_pcb"
SCHEMATIC = "boards/flange/flange.kicad_sch"
NOTE, BOM, PLACES = "flange_assembly.txt", "flange_bom.csv", "flange_positions.csv"


def test_no_table_has_them_and_the_board_is_mounted_on_one_side(boards: Boards) -> None:
    for path in (boards("small") / ORDER).glob("*_positions.csv"):
        with path.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        assert len({row.get("Side") or row["Layer"] for row in rows}) == 1, path.name
    for path in (boards("small") / ORDER).glob("*.csv"):
        assert "J1," not in path.read_text(encoding="utf-8"), path.name


ROWS = {
    BOM: b"pogo 2x5,J1,SpringContacts_2x05_P2.54mm_D0.85mm,,827-22-010-10-001101,1\r\n",
    PLACES: b"J1,7.4600,0.0000,Bottom,180\r\n",
}
"""Rows of the contacts, as the tables would have them."""


@pytest.mark.parametrize(("name", "check"), [(BOM, "bom"), (PLACES, "placed")])
def test_a_table_that_has_them_is_seen(damaged_boards: Path, name: str, check: str) -> None:
    def damage(files: Files) -> None:
        files[name] += ROWS[name]

    package = damaged_boards / ORDER / "jlcpcb_flange.zip"
    rezip(package, damage)
    with zipfile.ZipFile(package) as opened:
        (package.parent / f"jlcpcb_{name}").write_bytes(opened.read(name))
    assert check in failing(damaged_boards, "orders", "flange")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b"NOT MOUNTED BY YOU", b"MOUNTED BY YOU"),
        (b"YOU: J1 (", b"YOU: J1 (), J2 ("),
        (b"\n\nPad 1", b"\n\nON THE BACK: J2. The rest\n\nPad 1"),
    ],
)
def test_a_note_of_other_parts_is_seen(damaged_boards: Path, old: bytes, new: bytes) -> None:
    def damage(files: Files) -> None:
        files[NOTE] = files[NOTE].replace(old, new, 1)

    rezip(damaged_boards / ORDER / "generic_flange.zip", damage)
    assert failing(damaged_boards, "orders", "flange") == {"note"}


@pytest.mark.parametrize("attribute", ["exclude_from_bom", "exclude_from_pos_files"])
def test_a_board_whose_own_outputs_would_have_them_is_seen(
    damaged_boards: Path, attribute: str
) -> None:
    path = damaged_boards / BOARD
    text = path.read_text(encoding="utf-8")
    path.write_text(in_part(text, "J1", f" {attribute}", ""), encoding="utf-8")
    assert failing(damaged_boards, "orders", "flange") == {"excluded"}


def test_a_schematic_whose_own_outputs_would_have_them_is_seen(damaged_boards: Path) -> None:
    edit(damaged_boards / SCHEMATIC, "(in_bom no)", "(in_bom yes)")
    assert failing(damaged_boards, "schematic") == {"fields"}


def test_a_note_without_the_parts_of_assumed_rotation_is_seen(damaged_boards: Path) -> None:
    def damage(files: Files) -> None:
        files[NOTE] = files[NOTE].replace(b"ROTATION ASSUMED: J2, ", b"ROTATION ASSUMED: ")

    rezip(damaged_boards / ORDER / "generic_flange.zip", damage)
    assert failing(damaged_boards, "orders", "flange") == {"assumed"}
