"""The spring contacts of the written board against the published map, by number and place."""

import cmath
import math
import re
import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import sexpdata

from board_damages import in_part
from damages import failing
from lumitip_fab.checks import board
from lumitip_fab.design.encoding import read_design

pytestmark = pytest.mark.slow

Point = tuple[float, float]
FLANGE = "boards/flange/flange.kicad_pcb"
# Published board files of arXiv 2306.05902: the board from its front, y down, from the middle of
# the flange (mm).
PUBLISHED_MM = {
    1: (7.62, -1.27),
    2: (7.62, 1.27),
    3: (10.16, -1.27),
    4: (10.16, 1.27),
    5: (12.70, -1.27),
    6: (12.70, 1.27),
    7: (15.24, -1.27),
    8: (15.24, 1.27),
    9: (17.78, -1.27),
    10: (17.78, 1.27),
}
PUBLISHED_NETS = {
    1: "GND",
    2: "GND",
    3: "12V_IN",
    4: "",
    5: "CASING",
    6: "Von",
    7: "485+",
    8: "485-",
    9: "3V3_out",
    10: "485GND",
}


def contacts(text: str) -> tuple[dict[int, Point], dict[int, str]]:
    """Place on the page and net of each pad of J1, read without the checks' reader."""
    board = sexpdata.loads(text)
    part = next(
        part
        for part in _all(board, "footprint")
        if any(
            words[1:3] == [sexpdata.Symbol("reference"), "J1"] for words in _all(part, "fp_text")
        )
    )
    x, y, *turned = next(_all(part, "at"))[1:]
    turn = cmath.rect(1, -math.radians(turned[0] if turned else 0))  # the page's y points down
    places, nets = {}, {}
    for pad in _all(part, "pad"):
        number = int(pad[1])
        moved = complex(*next(_all(pad, "at"))[1:3]) * turn
        places[number] = (x + moved.real, y + moved.imag)
        nets[number] = next((net[2] for net in _all(pad, "net")), "")
    return places, nets


def _all(node: Any, name: str) -> Iterator[Any]:
    return (n for n in node if isinstance(n, list) and n and n[0] == sexpdata.Symbol(name))


def off_mm(places: dict[int, Point]) -> float:
    """Farthest that a contact is from the published pattern, moved but not turned or mirrored."""
    x, y = (places[1][i] - PUBLISHED_MM[1][i] for i in (0, 1))
    assert places.keys() == PUBLISHED_MM.keys()
    return max(
        abs(complex(px - x - PUBLISHED_MM[n][0], py - y - PUBLISHED_MM[n][1]))
        for n, (px, py) in places.items()
    )


def mirrored(text: str) -> str:
    """The contacts of J1 as they would lie if the board were seen from behind."""
    at = text.index('(fp_text reference "J1"')
    end = text.index("\n  (", at)
    pads = re.sub(
        r'(\(pad "\d+" thru_hole \w+\s+\(at )(\S+)',
        lambda m: f"{m[1]}{-float(m[2]):g}",
        text[at:end],
    )
    return text[:at] + pads + text[end:]


def test_contacts_lie_where_the_published_board_has_them(boards: Callable[[str], Path]) -> None:
    text = (boards("small") / FLANGE).read_text()
    places, nets = contacts(text)
    assert off_mm(places) < 1e-6
    assert nets == PUBLISHED_NETS
    assert off_mm(contacts(mirrored(text))[0]) > 2, "a mirrored map is another"


def bridge(one: int, other: int) -> Callable[[str], str]:
    """A track on the front from one contact to another."""

    def change(text: str) -> str:
        places, _ = contacts(text)
        (ax, ay), (bx, by) = places[one], places[other]
        track = (
            f'  (segment (start {ax} {ay}) (end {bx} {by}) (width 0.3) (layer "F.Cu") '
            "(net 0) (tstamp 00000000-0000-4000-8000-000000000000))\n"
        )
        end = text.rstrip().rfind(")")
        return text[:end] + track + text[end:]

    return change


def renamed(number: int, net: str) -> Callable[[str], str]:
    """A pad of J1 on another net of the file."""

    def change(text: str) -> str:
        index = re.search(rf'\(net (\d+) "{re.escape(net)}"\)', text)
        assert index
        new = f'(net {index[1]} "{net}")'
        return in_part(
            text, "J1", rf'(?s)(\(pad "{number}" .*?)\(net \d+ "[^"]*"\)', lambda m: m[1] + new
        )

    return change


@pytest.mark.parametrize(
    ("damage", "expected"),
    [
        (mirrored, {"contact_places", "contact_signals"}),
        (bridge(7, 8), {"contact_signals"}),
        (bridge(3, 4), {"contact_signals"}),
        (bridge(2, 4), {"contact_signals"}),
        (renamed(8, "485+"), {"contact_signals"}),
        (renamed(5, "GND"), {"contact_signals"}),
    ],
)
def test_a_damaged_map_is_seen(
    damaged_boards: Path, damage: Callable[[str], str], expected: set[str]
) -> None:
    path = damaged_boards / FLANGE
    before = path.read_text()
    path.write_text(damage(before))
    assert path.read_text() != before
    found = {
        name for name in failing(damaged_boards, "board", "flange") if name.startswith("contact_")
    }
    assert found == expected


def without_tracks(net: str) -> Callable[[str], str]:
    """The tracks of a net taken away."""

    def change(text: str) -> str:
        index = re.search(rf'\(net (\d+) "{re.escape(net)}"\)', text)
        assert index
        return re.sub(rf"\n  \(segment [^\n]*\(net {index[1]}\)[^\n]*", "", text)

    return change


@pytest.mark.parametrize(
    ("net", "lost"),
    [("485-", "8 (485-)"), ("CASING", "5 (CASING)"), ("12V_IN", "3 (24V)")],
)
def test_a_contact_that_leads_to_no_header_is_seen(
    damaged_boards: Path, net: str, lost: str
) -> None:
    path = damaged_boards / FLANGE
    before = path.read_text()
    path.write_text(without_tracks(net)(before))
    assert path.read_text() != before
    design = read_design(damaged_boards / "design.json")
    found = {m.check: m for m in board.measure_board(damaged_boards, design, "flange")}
    assert not found["board.passed_on"].passed
    assert found["board.passed_on"].note == lost


def test_contacts_that_the_design_leaves_open_are_not_missed(
    boards: Callable[[str], Path], tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(boards("small"), tmp_path / "open"))
    path = folder / FLANGE
    path.write_text(without_tracks("485-")(path.read_text()))
    design = read_design(folder / "design.json")
    (flange,) = (each for each in design.auxiliary_boards if each.name == "flange")
    parts = tuple(
        replace(p, nets=tuple(net for net in p.nets if net[1] != "485-")) if p.ref == "J1" else p
        for p in flange.components
    )
    others = tuple(b for b in design.auxiliary_boards if b.name != "flange")
    changed = replace(design, auxiliary_boards=(*others, replace(flange, components=parts)))
    found = {m.check: m for m in board.measure_board(folder, changed, "flange")}
    assert found["board.passed_on"].passed


def test_the_gripper_s_supply_is_on_both_contacts_of_a_column(
    boards: Callable[[str], Path],
) -> None:
    design = read_design(boards("small") / "design.json")
    (flange,) = (each for each in design.auxiliary_boards if each.name == "flange")
    raw = dict(next(part for part in flange.components if part.ref == "J1").nets)["3"]
    (header,) = (p for p in flange.components if p.ref == "J3")
    assert [number for number, net in header.nets if net == raw] == ["7", "8"]


def test_the_map_passes_as_it_is_written(boards: Callable[[str], Path]) -> None:
    assert not {
        name for name in failing(boards("small"), "board", "flange") if name.startswith("contact_")
    }
