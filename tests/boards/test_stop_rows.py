"""Tables of an order stop whoever reads no more than them, while the polarity is not known."""

import csv
import io
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from lumitip_fab.boards.fab.order import bill_of_materials, placement_list
from lumitip_fab.boards.placement import place
from lumitip_fab.design import Design
from lumitip_fab.docs.boards import ordering
from lumitip_fab.pipeline.artefact import Files

STOP = " (STOP: confirm polarity first)"
VALUES = {"generic": "Value", "jlcpcb": "Comment", "pcbway": "Description / Value"}


@pytest.fixture(scope="module")
def small(designs: Callable[[str], Design]) -> Design:
    return designs("switched")  # whose emitter has a Q1 that is not at a cell


def measured(design: Design) -> Design:
    """The same with parts whose marked terminal was measured."""
    packages, known = design.packages, {"marked_confidence": "measured"}
    led = packages.led.model_copy(update=known)
    detector = packages.photodetector.model_copy(update=known)
    return replace(design, packages=replace(packages, led=led, photodetector=detector))


def stopped(design: Design) -> Iterator[tuple[str, str, str]]:
    """Board, fab and reference of each row that stops, in both tables."""
    for of in (*design.fingers, *design.auxiliary_boards):
        board = place(design, of)
        for fab in design.fabs:
            heading = VALUES[fab.name]
            for row in rows(bill_of_materials(board, fab)):
                if row[heading].endswith(STOP):
                    refs = next(text for head, text in row.items() if head in REFS)
                    yield from ((of.name, f"{fab.name} bom", ref) for ref in refs.split(","))
            for row in rows(placement_list(board, fab)):
                if row.get("Value", "").endswith(STOP):
                    yield of.name, f"{fab.name} positions", row["Reference"]


REFS = ("References", "Designator", "Ref Des")


def rows(table: bytes) -> list[dict[str, str]]:
    return [*csv.DictReader(io.StringIO(table.decode()))]


def test_parts_of_unknown_polarity_are_stopped_in_each_table(small: Design) -> None:
    cells = len(small.layout)
    tables = [*(f"{name} bom" for name in VALUES), "generic positions"]
    wanted = {
        (board, table, f"{letter}{number}")
        for board, letter in (("emitter", "D"), ("receiver", "Q"))
        for table in tables
        for number in range(1, cells + 1)
    }
    assert set(stopped(small)) == wanted


def test_no_part_is_stopped_whose_polarity_was_measured(small: Design) -> None:
    assert [*stopped(measured(small))] == []


def test_the_manual_says_what_to_write_into_the_remarks(small: Design) -> None:
    text, known = (ordering(design, Files(Path(), {})) for design in (small, measured(small)))
    row = next(line for line in text.splitlines() if line.startswith("| the marks are not"))
    assert "paste line 1 of `STOP_READ_FIRST.txt` into the order's remarks" in row
    assert "STOP" not in known
