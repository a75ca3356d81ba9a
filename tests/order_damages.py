"""Damages of a board's order folder, each with the checks that must fail."""

import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from damages import cut_short, edit, swap

FIRST, SECOND = "generic", "jlcpcb"
BOM = "bom.csv"


def table_beside(order: Path) -> None:
    path = order / f"{SECOND}_receiver_{BOM}"
    path.write_bytes(path.read_bytes().replace(b"Q1,", b""))


def table_gone(order: Path) -> None:
    (order / f"{SECOND}_receiver_{BOM}").unlink()


def zip_short(order: Path) -> None:
    cut_short(order / f"{SECOND}_receiver.zip")


def zip_spoilt(order: Path) -> None:
    """A file's packed bytes are others than were packed."""
    path = order / f"{SECOND}_receiver.zip"
    data = path.read_bytes()
    with zipfile.ZipFile(path) as package:
        at = package.infolist()[0].header_offset + 80
    path.write_bytes(data[:at] + b"\xff" * 20 + data[at + 20 :])


def file_twice_in_a_zip(order: Path) -> None:
    """Another drill file of the same name before the right one, which is read as the last."""
    path = order / f"{SECOND}_receiver.zip"
    with zipfile.ZipFile(path) as package:
        files = [(name, package.read(name)) for name in package.namelist()]
    (drills,) = (name for name, _ in files if name.upper().endswith("-NPTH.DRL"))
    with zipfile.ZipFile(path, "w") as package, pytest.warns(UserWarning, match="Duplicate"):
        for name, data in [(drills, b"no drill file"), *files]:
            package.writestr(name, data)


def zip_with_a_password(order: Path) -> None:
    path = order / f"{SECOND}_receiver.zip"
    data = path.read_bytes()
    at = data.index(b"PK\x01\x02") + 8  # flags of its first file in the list at the end
    path.write_bytes(data[:at] + b"\x01" + data[at + 1 :])


def zips_swapped(order: Path) -> None:
    swap(order / f"{SECOND}_receiver.zip", order / f"{FIRST}_receiver.zip")


def board_gone(order: Path) -> None:
    (order.parent / "receiver.kicad_pcb").unlink()


def edge_on_another_layer(order: Path) -> None:
    path = order.parent / "receiver.kicad_pcb"
    text = path.read_text(encoding="utf-8")
    assert '(layer "Edge.Cuts")' in text
    path.write_text(text.replace('(layer "Edge.Cuts")', '(layer "Dwgs.User")'), encoding="utf-8")


def part_out_of_kicads_lists(order: Path) -> None:
    path = order.parent / "receiver.kicad_pcb"
    edit(path, "(attr smd)", "(attr smd exclude_from_bom exclude_from_pos_files)")


FOLDER_DAMAGES: dict[Callable[[Path], None], set[str]] = {
    table_beside: {"tables"},
    part_out_of_kicads_lists: {"excluded"},
    table_gone: {"readable"},
    zip_short: {"readable"},
    zip_spoilt: {"readable"},
    file_twice_in_a_zip: {"readable"},
    zip_with_a_password: {"readable"},
    zips_swapped: {"readable"},
    board_gone: {"board"},
    edge_on_another_layer: {"board"},
}
