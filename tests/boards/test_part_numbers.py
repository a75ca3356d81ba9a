"""Share of the lines of the bills of materials with numbers to order by, in the written files."""

import csv
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip_fab.cli.built import part_number_rows
from lumitip_fab.design.encoding import read_design

pytestmark = pytest.mark.slow

AT_LEAST = 0.95
LED = "15406085BA300"  # of the published sensor


def lines(folder: Path, pattern: str) -> list[dict[str, str]]:
    """The rows of some tables of all boards."""
    found: list[dict[str, str]] = []
    for path in sorted(folder.glob(f"boards/*/order/{pattern}_bom.csv")):
        with path.open(encoding="utf-8", newline="") as file:
            found += csv.DictReader(file)
    return found


@pytest.mark.parametrize(
    "preset",
    [
        "published",
        "asymmetric",
        "dense",
        "flex",
        "franka_hand",
        "integrated",
        "mux16",
        "robotiq_2f140",
        "wsg50",
    ],
)
def test_lines_have_numbers(built: Callable[[str], Path], preset: str) -> None:
    generic, of_lcsc = (lines(built(preset), fab) for fab in ("generic_*", "jlcpcb_*"))
    assert len(generic) == len(of_lcsc) >= 12
    named = [r for r in generic if r["Part number"] and r["Manufacturer"] not in ("", "any")]
    assert len(named) >= AT_LEAST * len(generic)
    numbered = [r for r in of_lcsc if r["JLCPCB Part #"]]
    missing = [r["Manufacturer Part"] for r in of_lcsc if not r["JLCPCB Part #"]]
    assert missing == [LED]
    assert len({r["JLCPCB Part #"] for r in numbered}) == len(
        {r["Manufacturer Part"] for r in numbered}
    )


def test_the_specification_counts_the_same_lines(built: Callable[[str], Path]) -> None:
    out = built("published")
    rows = list(part_number_rows(out, read_design(out / "design.json")))
    assert [row.quantity for row in rows][-1] == "part numbers of all boards"
    bill = lines(out, "jlcpcb_*")
    numbered = sum(bool(row["JLCPCB Part #"]) for row in bill)
    assert rows[-1].computed.startswith(f"{len(bill)} of {len(bill)} lines, {numbered} with LCSC's")
    assert LED in rows[-1].reason
