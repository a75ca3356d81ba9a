"""Damage what is sent to PCB fabs, and exactly the right checks fail."""

import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import rezip
from damages import failing
from lumitip_fab.checks import orders
from lumitip_fab.design.encoding import read_design
from order_copper_damages import COPPER_DAMAGES
from order_damages import BOM, FIRST, FOLDER_DAMAGES, SECOND
from order_note_damages import NOTE_DAMAGES, Damage, Files, edit

pytestmark = pytest.mark.slow


def folder_of(boards: Path) -> Path:
    return boards / "boards" / "receiver" / "order"


def pour_missing(files: Files) -> None:
    edit(files, "F_Cu.gbr", rb"G36\*(?s:.)*?G37\*", b"")


def tracks_thin(files: Files) -> None:
    edit(files, "B_Cu.gbr", rb"(%ADD\d+C,)0\.25?\*", rb"\g<1>0.1*")


def opening_missing(files: Files) -> None:
    edit(files, "F_Mask.gbr", rb"X[-\d]+Y[-\d]+D03\*\n", b"")


def mask_open_on_copper(files: Files) -> None:
    edit(files, "F_Mask.gbr", rb"(X[-\d]+Y[-\d]+D03\*\n)", rb"\g<1>X0Y0D03*\n")


def paste_missing(files: Files) -> None:
    edit(files, "F_Paste.gbr", rb"X[-\d]+Y[-\d]+D03\*\n", b"")


def paste_on_bare_copper(files: Files) -> None:
    edit(files, "F_Paste.gbr", rb"(X[-\d]+Y[-\d]+D03\*\n)", rb"\g<1>X0Y0D03*\n")


def edge_farther(files: Files) -> None:
    edit(files, "Edge_Cuts.gbr", rb"X-0016200000", b"X-0016300000")


def drill_missing(files: Files) -> None:
    edit(files, "-PTH.drl", rb"\nX[-\d.]+Y[-\d.]+", b"")


def drill_larger(files: Files) -> None:
    edit(files, "-NPTH.drl", rb"C002\.1000", b"C002.2000")


def layer_missing(files: Files) -> None:
    del files["receiver-B_Mask.gbr"]


def not_gerber(files: Files) -> None:
    files["receiver-F_Cu.gbr"] = b"nothing"


def another_layer(files: Files) -> None:
    edit(files, ".GBO", rb"D01\*", b"D02*")


def silk_on_a_pad(files: Files) -> None:
    edit(files, "F_Silkscreen.gbr", rb"(X[-\d]+Y[-\d]+D01\*\n)", rb"\g<1>X0Y0D01*\n")


def silk_lines_thin(files: Files) -> None:
    edit(files, "F_Silkscreen.gbr", rb"(%ADD\d+C,)0\.15\*", rb"\g<1>0.1*")


def silk_lines_thick(files: Files) -> None:
    edit(files, "F_Silkscreen.gbr", rb"(%ADD\d+C,)0\.15\*", rb"\g<1>0.6*")


def silk_lost(files: Files) -> None:
    (name,) = (n for n in files if n.endswith("B_Silkscreen.gbr"))
    files[name] = files[name].replace(b"D01*", b"D02*")


def layer_nobody_asked_for(files: Files) -> None:
    files["receiver-In1_Cu.gbr"] = files["receiver-F_Cu.gbr"]


FIRST_DAMAGES: dict[Damage, set[str]] = {
    pour_missing: {"copper", "same"},
    tracks_thin: {"copper", "same"},
    opening_missing: {"mask", "same"},
    mask_open_on_copper: {"exposed", "same"},
    paste_missing: {"paste", "same"},
    paste_on_bare_copper: {"paste", "same"},
    edge_farther: {"outline", "routed", "same"},
    drill_missing: {"drills", "same"},
    drill_larger: {"drills", "same"},
    silk_on_a_pad: {"letters", "silk", "silk_clear", "same"},
    silk_lines_thin: {"letters", "silk", "same"},
    silk_lines_thick: {"letters", "silk", "silk_clear", "white", "same"},
    silk_lost: {"letters", "silk", "words", "same"},
    layer_nobody_asked_for: {"files"},
    layer_missing: {"readable"},
    not_gerber: {"readable"},
    **NOTE_DAMAGES,
}


@pytest.mark.parametrize("damage", FIRST_DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_the_layers(damage: Damage, damaged_boards: Path) -> None:
    rezip(folder_of(damaged_boards) / f"{FIRST}_receiver.zip", damage)
    assert failing(damaged_boards, "orders", "receiver") == FIRST_DAMAGES[damage]


@pytest.mark.parametrize("name", COPPER_DAMAGES)
def test_a_damage_of_copper_edge_or_attributes(name: str, damaged_boards: Path) -> None:
    ending, change, expected = COPPER_DAMAGES[name]
    board = damaged_boards / "boards/receiver/receiver.kicad_pcb"

    def damage(files: Files) -> None:
        (file,) = (n for n in files if n.endswith(ending))
        text = files[file].decode()
        files[file] = change(text, board).encode()
        assert files[file] != text.encode()

    rezip(folder_of(damaged_boards) / f"{FIRST}_receiver.zip", damage)
    # Only the first zip has it, and so the others differ from it.
    same = set() if expected == {"readable"} else {"same"}
    assert failing(damaged_boards, "orders", "receiver") == expected | same


def test_another_layer_in_another_zip(damaged_boards: Path) -> None:
    rezip(folder_of(damaged_boards) / f"{SECOND}_receiver.zip", another_layer)
    assert failing(damaged_boards, "orders", "receiver") == {"silk", "same"}


def test_the_layers_of_every_zip_are_held_against_the_board(damaged_boards: Path) -> None:
    def thin(files: Files) -> None:
        edit(files, ".GBL", rb"(%ADD\d+C,)0\.25?\*", rb"\g<1>0.1*")

    for house in (FIRST, SECOND, "pcbway"):
        package = folder_of(damaged_boards) / f"{house}_receiver.zip"
        rezip(package, tracks_thin if house == FIRST else thin)
    assert failing(damaged_boards, "orders", "receiver") == {"copper"}


# Damages of a table are made in the zip and beside it alike: pattern, what is put, what fails.

PLACES = "positions.csv"
TABLES = {
    "reference lost": (BOM, rb"Q1,Q2,", b"Q2,", {"bom"}),
    "reference twice": (BOM, rb"Q1,Q2,", b"Q1,Q1,Q2,", {"bom"}),
    "quantity": (BOM, rb",13\r", b",12\r", {"bom"}),
    "number lost": (BOM, rb"SML-H10TBT86,13", b",13", {"bom"}),
    "another number at LCSC": (BOM, rb"C5645,", b"C5646,", {"bom"}),
    "number at LCSC lost": (BOM, rb"C114636,", b",", {"bom"}),
    "another resistor": (BOM, rb"RC0603FR-0775KL", b"RC0603FR-077K5L", {"bom"}),
    "another value": (BOM, rb"75K,", b"76K,", {"bom"}),
    "stop line lost": (BOM, rb" \(STOP: confirm polarity first\)", b"", {"bom"}),
    "stop line of another part": (BOM, rb"74HC4051PW,", b"74HC4051PW (STOP),", {"bom"}),
    "another footprint": (BOM, rb"RESC1608", b"RESC2012", {"bom"}),
    "row lost": (PLACES, rb"Q5,[^\n]*\n", b"", {"placed"}),
    "row twice": (PLACES, rb"(Q5,[^\n]*\n)", rb"\g<1>\g<1>", {"placed"}),
    "row cut short": (PLACES, rb"(Q5,[-\d.]+),[^\n]*\n", rb"\g<1>\r\n", {"readable"}),
    "place": (PLACES, rb"(Q5,[-\d]+\.\d)", rb"\g<1>7", {"positions"}),
    "side": (PLACES, rb"(Q5,.*?)Top", rb"\g<1>Bottom", {"sides"}),
    "turn": (PLACES, rb"(Q5,.*?,Top,)\d+", rb"\g<1>45", {"turns"}),
    "turn by no figure": (PLACES, rb"(Q5,.*?,Top,)\d+", rb"\g<1>nan", {"turns"}),
}


@pytest.mark.parametrize("name", TABLES)
def test_a_damage_of_a_table(name: str, damaged_boards: Path) -> None:
    table, pattern, put, wanted = TABLES[name]
    order = folder_of(damaged_boards)
    rezip(order / f"{SECOND}_receiver.zip", lambda files: edit(files, table, pattern, put))
    with zipfile.ZipFile(order / f"{SECOND}_receiver.zip") as package:
        changed = package.read(f"receiver_{table}")
    (order / f"{SECOND}_receiver_{table}").write_bytes(changed)
    assert failing(damaged_boards, "orders", "receiver") == wanted


def test_a_placement_list_without_a_stop_line(damaged_boards: Path) -> None:
    order = folder_of(damaged_boards)
    rezip(
        order / f"{FIRST}_receiver.zip",
        lambda files: edit(files, PLACES, rb"(Q5,[^,(]*) \(STOP[^)]*\)", rb"\1"),
    )
    with zipfile.ZipFile(order / f"{FIRST}_receiver.zip") as package:
        unstopped = package.read(f"receiver_{PLACES}")
    (order / f"{FIRST}_receiver_{PLACES}").write_bytes(unstopped)
    assert failing(damaged_boards, "orders", "receiver") == {"placed"}


@pytest.mark.parametrize("damage", FOLDER_DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_the_folder(damage: Callable[[Path], None], damaged_boards: Path) -> None:
    damage(folder_of(damaged_boards))
    assert failing(damaged_boards, "orders", "receiver") == FOLDER_DAMAGES[damage]


def test_every_check_fails_for_some_damage(boards: Callable[[str], Path]) -> None:
    folder = boards("small")
    found = list(orders.measure(folder, read_design(folder / "design.json")))
    assert [m for m in found if not m.passed] == []
    names = {m.check.removeprefix("orders.") for m in found}
    copper = [expected for _, _, expected in COPPER_DAMAGES.values()]
    tables = [
        *copper,
        *FIRST_DAMAGES.values(),
        *FOLDER_DAMAGES.values(),
        *(t[3] for t in TABLES.values()),
    ]
    assert names <= set().union(*tables)
