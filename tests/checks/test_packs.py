"""The list to order for the bill: whole packs, shared by the lines that need them; damages."""

import csv
from dataclasses import replace
from pathlib import Path

import pytest

from damages import edit, excerpt
from damages import failing as failing_of
from lumitip_fab.design import Bought
from lumitip_fab.design.encoding import read_design
from lumitip_fab.docs.orders import orders

Rows = list[dict[str, str]]


@pytest.fixture
def copied(outputs: Path, tmp_path: Path) -> Path:
    """The bill of the published design and its list to order, to damage."""
    return excerpt(outputs, tmp_path / "ordered", "bom.csv", "order.csv")


def rows(folder: Path, name: str) -> Rows:
    with (folder / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


EDITS = [
    ("M2 nut,,ISO 4032,4,piece", "M2 nut,,ISO 4032,3,piece", {"amounts", "needed"}),
    ('5 m each",assumed,1,15,15.00', '5 m each",assumed,2,15,30.00', {"enough", "total"}),
    ("spool of 1 kg,assumed,1,25,25.00", "spool of 1 kg,assumed,1,25,20.00", {"enough", "total"}),
    ("5 boards,inferred,1,12.1,12.10", "4 boards,inferred,1,12.1,12.10", {"enough", "units"}),
    ("wooden stick,,", "resistor 1K1,,", {"amounts", "lines"}),
    ("DOWSIL PR-1200,Dow,", "DOWSIL PR-1200,Dow Inc,", {"amounts", "lines"}),
    ("pack_price,price", "price", {"readable"}),
    ("needed,unit,", "needed,each,", {"readable"}),
    (",sheet,ream", ",piece,ream", {"units"}),
    (",m,spool of 170 m", ",mm,spool of 170 m", {"units"}),
    (",32,piece,,", ",32,pair,,", {"units"}),
    ("spool of 170 m,assumed", "spool of 170 m,quoted", {"units"}),
]


def test_nothing_fails_as_it_is_written(copied: Path) -> None:
    assert failing_of(copied, "packs") == set()


@pytest.mark.parametrize(("old", "new", "expected"), EDITS)
def test_a_damage_fails_its_check(copied: Path, old: str, new: str, expected: set[str]) -> None:
    edit(copied / "order.csv", old, new)
    assert failing_of(copied, "packs") == expected


def rewritten(folder: Path, changed: Rows) -> None:
    with (folder / "order.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, changed[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(changed)


def of_parts(folder: Path) -> tuple[Rows, dict[str, str], dict[str, str]]:
    """All rows, and two resistors of one price that are bought singly."""
    every = rows(folder, "order.csv")
    singly = [r for r in every if r["item"].startswith("resistor ") and not r["pack"]]
    one = next(r for r in singly if r["needed"] != "1")
    other = next(r for r in singly if r is not one and r["pack_price"] == one["pack_price"])
    return every, one, other


def test_an_amount_shifted_from_line_to_line_is_seen(copied: Path) -> None:
    every, one, other = of_parts(copied)
    for row, by in ((one, -1), (other, 1)):
        row["needed"] = row["packs"] = str(int(row["needed"]) + by)
        row["price"] = f"{float(row['pack_price']) * int(row['packs']):.2f}"
    rewritten(copied, every)
    assert failing_of(copied, "packs") == {"amounts"}


def test_products_exchanged_are_seen(copied: Path) -> None:
    every, one, other = of_parts(copied)
    one["part"], other["part"] = other["part"], one["part"]
    rewritten(copied, every)
    assert failing_of(copied, "packs") == {"amounts"}


def test_both_totals_say_what_they_are(copied: Path) -> None:
    used, bought = rows(copied, "bom.csv")[-1], rows(copied, "order.csv")[-1]
    assert used["item"] == "used by one pair of fingers"
    assert bought["item"] == "to buy for one pair of fingers"
    (cable,) = (row for row in rows(copied, "order.csv") if row["item"] == "cable of the gripper")
    assert (cable["confidence"], cable["packs"], cable["price"]) == ("assumed", "1", "25.00")
    assert not [row for row in rows(copied, "bom.csv") if row["price"] == ""]
    assert float(used["price"]) < float(bought["price"])


def test_what_is_sold_in_packs_names_pack_and_confidence(copied: Path) -> None:
    packed = [row for row in rows(copied, "order.csv") if row["pack"]]
    assert {"PETG", "Solaris", "TPU 100 µm", "waxed thread"} <= {row["item"] for row in packed}
    assert all(row["confidence"] in ("inferred", "assumed") for row in packed)
    plug = next(row for row in packed if row["item"].startswith("IDC socket"))
    assert (plug["needed"], plug["unit"]) == ("2", "piece")
    wire = next(row for row in packed if "AWG 28" in row["item"])
    lengths = sum(float(r["quantity"]) for r in rows(copied, "bom.csv") if r["group"] == "wiring")
    assert float(wire["needed"]) == pytest.approx(lengths)


def test_glue_and_adhesive_name_a_maker_and_a_product(copied: Path) -> None:
    named = {row["item"]: (row["manufacturer"], row["part"]) for row in rows(copied, "order.csv")}
    assert named["slow two-part epoxy"] == ("Huntsman", "Araldite 2011")
    assert named["silicone adhesive"] == ("Dow", "DOWSIL 748 Non-Corrosive Sealant")


def test_lines_that_share_a_spool_need_it_once_until_it_is_empty(outputs: Path) -> None:
    purchase = read_design(outputs / "design.json").purchase
    line = Bought("prints", "a.stl", "", "PETG", "", 600.0, 0.025, "g", "PETG")
    (order,) = orders(purchase, [line, replace(line, item="b.stl")])
    assert (order.needed, order.packs, order.price) == (1200.0, 2, 50.0)
    screw = Bought("fasteners", "M2 x 6", "", "", "", 2.0, 0.08, pack="M2 screw")
    assert len(orders(purchase, [screw, replace(screw, item="M2 x 8")])) == 2
