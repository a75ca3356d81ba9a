"""The note to a fab on boards beside the fingers: how parts lie, and what of it is assumed."""

import re
import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from board_damages import rezip
from damages import failing
from lumitip_fab.boards.fab.notes import assembly_note
from lumitip_fab.boards.placement import place
from lumitip_fab.design import AuxiliaryBoard, Design
from order_note_damages import Files, edit

CHECK = "CHECK BEFORE PLACING: that the mark on the part itself shows its cathode is assumed"


@pytest.fixture(scope="module")
def design(designs: Callable[[str], Design]) -> Design:
    return designs("fingertip")


def board(design: Design, name: str) -> AuxiliaryBoard:
    return next(board for board in design.auxiliary_boards if board.name == name)


def notes(design: Design, of: AuxiliaryBoard) -> Iterator[str]:
    placed = place(design, of)
    return (assembly_note(placed, fab).decode() for fab in design.fabs)


def known(design: Design, name: str) -> AuxiliaryBoard:
    """A board whose power LED had its mark measured."""
    of = board(design, name)
    parts = [
        replace(part, mark_confidence="measured" if part.mark_confidence else "")
        for part in of.components
    ]
    return replace(of, components=tuple(parts))


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    ("name", "led", "cathodes", "others"),
    [
        (
            "flange",
            "D2",
            {"D1, SMBJ24A by Liown", "D2, APT2012LZGCK by Kingbright"},
            {
                "J2 to J3: contact 1 is at the bar.",
                "Q1 and U1: lead 1 is at the dot.",
                "C1 to C4, F1, L1 and R1 to R4: either way round.",
            },
        ),
        (
            "breakout",
            "LED1",
            {
                "LED1, KT-0805YG by Hubei KENTO",
                "VD1, 1N5819HW-7-F by Diodes",
                "Z1 to Z10, H5VUD5U by Hongjiacheng",
            },
            {"C1 to C4, J1 to J2 and R1 to R9: either way round."},
        ),
    ],
)
def test_the_note_says_how_each_part_lies(
    design: Design, name: str, led: str, cathodes: set[str], others: set[str]
) -> None:
    for note in notes(design, board(design, name)):
        lines = note.splitlines()
        found = re.findall(r"^(.*): pad 1 is the cathode, pad 2 the anode\. On the", note, re.M)
        assert set(found) == cathodes
        assert others <= set(lines)
        (check,) = (line for line in lines if line.startswith(CHECK))
        assert f"shows the anode, turn {led} by 180 degrees" in check
        assert lines[lines.index(check) - 1].startswith(f"{led}, ")


@pytest.mark.slow_cases
@pytest.mark.parametrize("name", ["flange", "breakout"])
def test_a_measured_mark_is_not_to_be_checked(design: Design, name: str) -> None:
    for note in notes(design, known(design, name)):
        assert "CHECK BEFORE PLACING" not in note
        assert "The mark on the part itself shows its cathode: measured." in note


@pytest.mark.slow_cases
@pytest.mark.parametrize(("name", "assumed"), [("flange", "J2, J3"), ("breakout", "")])
def test_parts_without_polarity_are_turned_by_no_assumption(
    design: Design, name: str, assumed: str
) -> None:
    note = next(notes(design, board(design, name)))
    found = re.search(r"^ROTATION ASSUMED: (.*?)\.", note, re.MULTILINE)
    assert (found[1] if found else "") == assumed


def without_a_cathode(files: Files) -> None:
    edit(files, "assembly.txt", rb"D1, \S+ by \S+: pad 1 is the cathode.*\n", b"")


def with_an_anode(files: Files) -> None:
    edit(files, "assembly.txt", rb"(D1, \S+ by \S+: pad 1 is the )cathode", rb"\1anode")


def without_what_may_be_turned(files: Files) -> None:
    edit(files, "assembly.txt", rb".*: either way round\.\n", b"")


def with_more_that_may_be_turned(files: Files) -> None:
    edit(files, "assembly.txt", rb"(.*: either way round\.\n)", rb"D1 and \1")


def without_the_dot(files: Files) -> None:
    edit(files, "assembly.txt", rb".*: lead 1 is at the dot\.\n", b"")


def without_the_check(files: Files) -> None:
    edit(files, "assembly.txt", rb"CHECK BEFORE PLACING: .*\n", b"")


@pytest.mark.slow
@pytest.mark.parametrize(
    "damage",
    [
        without_a_cathode,
        with_an_anode,
        without_what_may_be_turned,
        with_more_that_may_be_turned,
        without_the_dot,
        without_the_check,
    ],
    ids=lambda damage: damage.__name__,
)
def test_a_damage_of_the_flange_s_note_is_seen(
    boards: Callable[[str], Path], tmp_path: Path, damage: Callable[[Files], None]
) -> None:
    hurt = Path(shutil.copytree(boards("switched"), tmp_path / "hurt"))
    rezip(hurt / "boards/flange/order/generic_flange.zip", damage)
    assert failing(hurt, "orders", "flange") == {"note"}
