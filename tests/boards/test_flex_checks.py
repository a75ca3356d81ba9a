"""Damage the files of a flexible board, and exactly the right checks fail."""

import re
import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import once
from damages import failing

pytestmark = pytest.mark.slow
FILE = "boards/receiver/receiver.kicad_pcb"
ZIP = "boards/receiver/order/generic_receiver.zip"


@pytest.fixture
def hurt(built: Callable[[str], Path], tmp_path: Path) -> Path:
    """The boards of the preset, to damage."""
    folder = tmp_path / "flex"
    shutil.copytree(built("flex") / "boards", folder / "boards")
    shutil.copy(built("flex") / "design.json", folder)
    return folder


def via_in_the_bend(text: str) -> str:
    """One more via of ground, in the pour between the cells."""
    number = re.search(r'\(net (\d+) "GND"\)', text)
    assert number
    via = (
        f'(via (at 163.2 96.4) (size 0.6) (drill 0.3) (layers "F.Cu" "B.Cu") (net {number[1]})'
        " (tstamp 00000000-0000-0000-0000-000000000001))"
    )
    return once(text, r"\n  \(zone\n", lambda m: f"\n  {via}{m[0]}")


def without_teardrops(text: str) -> str:
    """Every piece of a signal's track as wide as signals are; supplies are wider."""
    hurt, count = re.subn(r"(\(segment .*\(width )0\.[2-4]\d*\)", r"\g<1>0.2)", text)
    assert count > 100
    return hurt


def multiplexer_in_the_bend(text: str) -> str:
    """The line from which the board bends, and with it the drawn zone, down to a multiplexer."""
    return once(
        text,
        r'(\(gr_rect \(start \S+ \S+\) \(end \S+ )(\S+)\)(.* \(layer "User.2"\))',
        lambda m: f"{m[1]}{float(m[2]) + 9:g}){m[3]}",
    )


TEXTS: dict[str, tuple[Callable[[str], str], set[str]]] = {
    "thick core": (lambda t: once(t, r"\(thickness 0.109\)", "(thickness 0.2)"), {"stack_up"}),
    "FR-4": (
        lambda t: once(
            t,
            r"\(thickness 0.109\) \(material \"Polyimide\"\)",
            '(thickness 0.109) (material "FR4")',
        ),
        {"stack_up"},
    ),
    "no stack-up": (lambda t: once(t, r"\(stackup", "(other"), {"stack_up"}),
    "bend moved": (
        lambda t: once(
            t,
            r'(\(gr_rect \(start \S+ )(\S+\))(.* \(layer "User.2"\))',
            lambda m: f"{m[1]}90){m[3]}",
        ),
        {"regions"},
    ),
    "multiplexer in the bend": (multiplexer_in_the_bend, {"regions", "held"}),
    "stiffener too wide": (
        lambda t: once(
            t,
            r'\(gr_rect \(start \S+( \S+\).* \(layer "User.1"\))',
            lambda m: f"(gr_rect (start 138.3{m[1]}",
        ),
        {"regions", "stiffener_room"},
    ),
    "no stiffener": (
        lambda t: once(t, r'\(layer "User.1"\)', '(layer "User.3")'),
        {"regions", "stiffener_room"},
    ),
    "via in the bend": (via_in_the_bend, {"bend"}),
    "no teardrops": (without_teardrops, {"teardrops"}),
}
NOTES = {
    "thickness": ("0.2 mm thick", "1.6 mm thick"),
    "stiffener": ("x -11.503", "x -12.503"),
    "its thickness": ("Stiffener of polyimide, 0.2", "Stiffener of polyimide, 0.3"),
    "bend": ("where y is above -7.950", "where y is above 6.850"),
    "its drawing": ("receiver-User_1.gbr", "receiver-Edge_Cuts.gbr"),
}


@pytest.mark.parametrize("name", TEXTS)
def test_a_damaged_board_file(name: str, hurt: Path) -> None:
    damage, wanted = TEXTS[name]
    file = hurt / FILE
    file.write_text(damage(file.read_text(encoding="utf-8")), encoding="utf-8")
    assert failing(hurt, "board", "receiver") == wanted


def edited(folder: Path, name: str, edit: Callable[[str], str]) -> None:
    """Change one file of the zip."""
    with zipfile.ZipFile(folder / ZIP) as package:
        files = {entry: package.read(entry) for entry in package.namelist()}
    files[name] = edit(files[name].decode()).encode()
    with zipfile.ZipFile(folder / ZIP, "w") as package:
        for entry, data in files.items():
            package.writestr(entry, data)


@pytest.mark.parametrize("name", NOTES)
def test_a_note_that_orders_another_board(name: str, hurt: Path) -> None:
    before, after = NOTES[name]
    edited(hurt, "receiver_assembly.txt", lambda note: once(note, re.escape(before), after))
    assert failing(hurt, "orders", "receiver") == {"flexible", "note"}


STIFFENERS: dict[str, tuple[Callable[[str], str], set[str]]] = {
    "moved": (lambda t: re.sub(r"X-0011503000", "X-0011403000", t), {"stiffener", "same"}),
    "open": (lambda t: once(t, r"X[-\d]+Y[-\d]+D01\*\n(?=M02)", ""), {"stiffener", "same"}),
    "not a drawing": (lambda _: "", {"readable"}),
}


@pytest.mark.parametrize("name", STIFFENERS)
def test_another_outline_of_the_stiffener(name: str, hurt: Path) -> None:
    damage, wanted = STIFFENERS[name]
    edited(hurt, "receiver-User_1.gbr", damage)
    assert failing(hurt, "orders", "receiver") == wanted
