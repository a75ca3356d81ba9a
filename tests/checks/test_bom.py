"""Damage the bill of materials or what it is counted from, and exactly the right checks fail."""

import csv
import shutil
from pathlib import Path

import pytest

from damages import cut_short, edit, excerpt
from damages import failing as failing_of
from lumitip_fab.checks.bom import measure
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design.encoding import read_design

_NEEDED = ("boards", "backing", "mould", "holder", "flange", "fit", "gauge", "wiring")


@pytest.fixture
def copied(outputs: Path, tmp_path: Path) -> Path:
    """The bill of the published design and what it is counted from, to damage."""
    return excerpt(outputs, tmp_path / "billed", "bom.csv", *_NEEDED)


def failing(folder: Path) -> set[str]:
    return failing_of(folder, "bom")


# File, what is replaced in it, by what, and the checks that then fail.
EDITS = [
    (
        "bom.csv",
        "32 on emitter,32,piece,0.3,9.60",
        "31 on emitter,31,piece,0.3,9.30",
        {"parts", "total", "uses"},
    ),
    ("bom.csv", "32,piece,0.3,9.60", "32,piece,0.2,6.40", {"prices", "total"}),
    ("bom.csv", "32,piece,0.3,9.60", "32,piece,0.3,6.90", {"prices", "total"}),
    (
        "bom.csv",
        "Elektronik,15406085BA300,32",
        "Elektronik,15406085BA200,32",
        {"parts", "prices", "uses"},
    ),
    (
        "bom.csv",
        "photodetector SML-H10TBT86,ROHM",
        "photodetector SML-H10TBT86,Rohm",
        {"parts", "uses"},
    ),
    ("bom.csv", "emitter board", "emitting board", {"boards"}),
    ("bom.csv", "backing/emitter_backing.stl", "backing/emitter_back.stl", {"prints"}),
    (
        "bom.csv",
        "a sheet of A4 for each finger,2,sheet,2,4.00",
        "a sheet of A4 for each finger,1,sheet,2,2.00",
        {"film", "total"},
    ),
    ("bom.csv", 'deep that is",2,piece', 'deep that is",4,piece', {"bolts", "pieces", "prices"}),
    ("bom.csv", "M5 x 12 socket", "M5 x 20 socket", {"bolt_length", "pieces", "prices"}),
    ("bom.csv", "EUR, 2026-11", "EUR", {"total"}),
    ("bom.csv", "32,piece,0.3,9.60", "32,pair,0.3,9.60", {"units"}),
    ("bom.csv", ",m,0.3,", ",mm,0.3,", {"units"}),
    ("bom.csv", "quantity,unit,", "quantity,each,", {"readable"}),
    ("bom.csv", "\ntotal,", "\nsum,", {"readable"}),
    ("bom.csv", "32,piece,0.3,9.60", "nan,piece,0.3,9.60", {"readable"}),
    ("bom.csv", "32,piece,0.3,9.60", "32", {"readable"}),
    (
        "boards/receiver/receiver.kicad_pcb",
        '"74HC4051PW,118"',
        '"74HC4067PW,118"',
        {"parts", "uses"},
    ),
    ("boards/flange/flange.kicad_pcb", '"827-22-010-10-001101"', '"827-22-010"', {"parts", "uses"}),
    ("bom.csv", "Mill-Max,827-22-010-10", "Mill-Max,827-22-006-10", {"parts", "prices", "uses"}),
    ("bom.csv", "32 on emitter", "32 on receiver", {"uses"}),
    ("bom.csv", "2 times, each", "3 times, each", {"uses"}),
    ("bom.csv", " colours: wiring", "1 colours: wiring", {"uses"}),
    (
        "bom.csv",
        "clamps of both moulds,8,piece,0.05,0.40",
        "clamps of both moulds,2,piece,0.05,0.10",
        {"fasteners", "pieces", "total"},
    ),
    (
        "bom.csv",
        "bare,1,piece,2.42,2.42",
        "bare,3,piece,2.42,7.26",
        {"boards", "total"},
    ),
    ("bom.csv", "14.3 mm longer", "4.3 mm shorter", {"fasteners", "pieces"}),
    ("bom.csv", "M2 x 10 screw", "M3 x 10 screw", {"fasteners", "pieces", "prices"}),
    ("bom.csv", "boards in their backings", "boards in their moulds", {"pieces"}),
    ("bom.csv", "\nsupplies,", "\nsupply,", {"readable"}),
    ("mould/emitter_casting.md", "part A | **", "part A | **2.5.", {"readable"}),
    ("boards/receiver/order/generic_receiver_bom.csv", ",Nexperia,", ",,", {"numbered"}),
    ("boards/receiver/order/generic_receiver_bom.csv", ",Nexperia,", ",any,", {"numbered"}),
    ("mould/emitter_casting.md", "part A | **", "part A | **1", {"silicone"}),
    ("wiring/cables.csv", "BK,0.08,270", "BK,0.08,970", {"wire"}),
]


@pytest.mark.slow
def test_nothing_fails_as_it_is_written(copied: Path) -> None:
    assert failing(copied) == set()


def test_parts_say_what_they_are(outputs: Path) -> None:
    with (outputs / "bom.csv").open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["group"] == "electronics"]
    items = {row["item"] for row in rows}
    assert {"resistor 150R", "capacitor 100nF", "LED 15406085BA300"} <= items
    assert {"photodetector SML-H10TBT86", "transistor Si2309CDS"} <= items


@pytest.mark.parametrize(("file", "old", "new", "expected"), EDITS)
def test_a_damage_fails_its_check(
    copied: Path, file: str, old: str, new: str, expected: set[str]
) -> None:
    edit(copied / file, old, new)
    assert failing(copied) == expected


def test_a_number_at_lcsc_that_is_lost_lowers_the_share(copied: Path) -> None:
    def share() -> tuple[float, str]:
        found = measure(copied, read_design(copied / "design.json"))
        return next((m.measured, m.note) for m in found if m.check == "bom.lcsc")

    before, note = share()
    assert note == "17 of 18 lines of the boards; not 15406085BA300"
    edit(copied / "boards/receiver/order/jlcpcb_receiver_bom.csv", "C5645,", ",")
    after, note = share()
    assert (before, after) == pytest.approx((100 * 17 / 18, 100 * 16 / 18))
    assert "74HC4051PW,118" in note


def test_a_part_that_is_soldered_on_by_hand_is_in_the_bill(outputs: Path) -> None:
    with (outputs / "bom.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["part"]: row for row in csv.DictReader(file)}
    contacts = rows["827-22-010-10-001101"]
    assert (contacts["manufacturer"], contacts["quantity"]) == ("Mill-Max", "1")
    assert contacts["for"] == "1 on flange, soldered on by hand" and contacts["price"] == "12.00"


def test_a_part_of_another_size_is_seen(copied: Path) -> None:
    shutil.copy(copied / "mould/emitter_mould.stl", copied / "backing/emitter_backing.stl")
    assert failing(copied) == {"prints"}


def test_a_list_for_a_board_house_that_is_cut_short_is_seen(copied: Path) -> None:
    cut_short(copied / "boards/emitter/order/generic_emitter_bom.csv", 130)
    assert failing(copied) == {"numbered"}


def test_lost_files_are_told(copied: Path) -> None:
    (copied / "mould/emitter_casting.md").unlink()
    assert failing(copied) == {"readable"}


def test_a_users_own_prices_replace_those_of_the_package(design_dir: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    prices = folder / "parts" / "prices.toml"
    text = prices.read_text(encoding="utf-8")
    dearer = text.replace('"15406085BA300" = 0.30', '"15406085BA300" = 0.45')
    prices.write_text(dearer.replace('"Solaris" = 54.0\n', ""), encoding="utf-8")
    before, after = (derive(load(at / "fingertip.toml")).purchase for at in (design_dir, folder))
    told = {part.part: part.each for part in after.parts}
    assert told["15406085BA300"] == 0.45
    assert after.unit_price(after.silicone) is None
    assert before.unit_price(before.silicone) == 54.0 / 900.0
    assert {p.part: p.each for p in before.parts}["15406085BA300"] == 0.3
