"""Share of the lines of the bills of materials with numbers to order by, in the written files."""

import csv
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip_fab.cli.part_numbers import part_number_rows
from lumitip_fab.design.encoding import read_design

pytestmark = pytest.mark.slow

AT_LEAST = 0.95
NOT_AT_LCSC = {
    "15406085BA300",  # LED of the published sensor
    "827-22-010-10-001101",  # spring contacts of the published flange
    "61201421721",  # angled box header of the published flange
    "MDBT50Q-1MV2",
    "RC1206FR-07143RL",
    "YC164-FR-0718KL",
}


def lines(folder: Path, pattern: str) -> list[dict[str, str]]:
    """The rows of some tables of all boards."""
    found: list[dict[str, str]] = []
    for path in sorted(folder.glob(f"boards/*/order/{pattern}_bom.csv")):
        with path.open(encoding="utf-8", newline="") as file:
            found += csv.DictReader(file)
    return found


@pytest.mark.parametrize(
    ("preset", "at_lcsc"),
    [
        ("published", 0.82),
        ("asymmetric", 0.72),
        ("dense", 0.83),
        ("flex", 0.76),
        ("franka_hand", 0.76),
        ("integrated", 0.75),
        ("mux16", 0.76),
        ("robotiq_2f140", 0.76),
        ("wsg50", 0.76),
    ],
)
def test_lines_have_numbers(built: Callable[[str], Path], preset: str, at_lcsc: float) -> None:
    generic, of_lcsc = (lines(built(preset), fab) for fab in ("generic_*", "jlcpcb_*"))
    assert len(generic) == len(of_lcsc) >= 12
    named = [r for r in generic if r["Part number"] and r["Manufacturer"] not in ("", "any")]
    assert len(named) >= AT_LEAST * len(generic)
    numbered = [r for r in of_lcsc if r["JLCPCB Part #"]]
    assert len(numbered) >= at_lcsc * len(of_lcsc)
    missing = {r["Manufacturer Part"] for r in of_lcsc if not r["JLCPCB Part #"]}
    assert missing <= NOT_AT_LCSC
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
    assert "827-22-010-10-001101" in rows[-1].reason
