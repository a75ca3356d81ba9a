"""Damage the board files, and exactly the right checks fail."""

import math
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import (
    in_part,
    moved_part,
    once,
    spokes_cut,
    swapped_pads,
)
from damages import cut_short, failing, swap
from emitter_damages import EMITTER, EMITTER_DAMAGES, Damage
from lumitip_fab.checks import board
from lumitip_fab.design.encoding import read_design

pytestmark = pytest.mark.slow

RECEIVER = "boards/receiver/receiver.kicad_pcb"


def net_names_swapped(text: str) -> str:
    """Two detectors whose pads say each other's net; their copper is as before."""
    first = re.search(r'\(net (\d+) "Q1"\)', text)
    second = re.search(r'\(net (\d+) "Q2"\)', text)
    assert first and second
    text = in_part(text, "Q1", re.escape(first[0]), second[0])
    return in_part(text, "Q2", re.escape(second[0]), first[0])


def inputs_swapped(text: str) -> str:
    """Two leads of a multiplexer exchanged: copper and names agree, but not with the layout."""
    return swapped_pads(text, "U1", "13", "14")


def detector_reversed(text: str) -> str:
    return swapped_pads(text, "Q3", "1", "2")


def track_narrow(text: str) -> str:
    return once(text, r"(\(segment .*?\(width )0\.2\)", r"\g<1>0.15)")


def via_dropped(text: str) -> str:
    net = re.search(r'\(net (\d+) "S0"\)', text)
    assert net
    return once(text, rf"\n  \(via [^\n]*\(net {net[1]}\)[^\n]*", "")


def vias_beside_dropped(text: str) -> str:
    """No ground via within 2.4 mm of the middle of C2."""
    part = text[: text.index('(fp_text reference "C2"')].rpartition("\n  (footprint")[2]
    at, ground = re.search(r"\(at (\S+) (\S+?)[ )]", part), re.search(r'\(net (\d+) "GND"\)', text)
    assert at and ground
    middle = float(at[1]), float(at[2])

    def kept(via: re.Match[str]) -> str:
        return "" if math.dist(middle, (float(via[1]), float(via[2]))) < 2.4 else via[0]

    via = rf"\n  \(via \(at (\S+) (\S+)\)[^\n]*\(net {ground[1]}\)[^\n]*"
    return re.sub(via, kept, text)


def via_ring_thin(text: str) -> str:
    return once(text, r"(\(via .*?\(size )0\.6\)", r"\g<1>0.5)")


def hole_moved(text: str) -> str:
    return moved_part(text, "H1", 0.05, 0.0)


def hole_narrow(text: str) -> str:
    return in_part(text, "H1", r"\(drill 2\.1\)", "(drill 2)")


def hole_missing(text: str) -> str:
    return in_part(text, "H1", r"np_thru_hole", "connect")


def edge_moved(text: str) -> str:
    """The edge towards the gripper 0.1 mm farther out, with its corners."""
    low = max(float(y) for y in re.findall(r"\(gr_line \(start \S+ (\S+)\)[^\n]*Edge", text))

    def farther(m: re.Match[str]) -> str:
        y = float(m[3])
        return f"({m[1]} {m[2]} {y + 0.1 if y > low - 0.6 else y:g})"

    return "\n".join(
        re.sub(r"\((start|mid|end) (\S+) (\S+)\)", farther, line) if "Edge.Cuts" in line else line
        for line in text.split("\n")
    )


def pull_up_wrong(text: str) -> str:
    return in_part(text, "R2", r'value "75K"', 'value "7K5"')


def capacitor_missing(text: str) -> str:
    return in_part(text, "C1", r'\(fp_text reference "C1"', '(fp_text reference "X1"')


def capacitor_far(text: str) -> str:
    return moved_part(text, "C1", 0.0, -6.0)


def dot_lost(text: str) -> str:
    """The dot is the last line of a multiplexer's drawing."""
    return in_part(text, "U1", r'\n[^\n]*\(fp_line [^\n]*"F.SilkS"\) \(width 0\.3\)[^\n]*', "")


def select_lines_swapped(text: str) -> str:
    return swapped_pads(text, "U2", "10", "11")


def connector_reversed(text: str) -> str:
    return swapped_pads(text, "J1", "3", "4")


def track_added_near_another(text: str) -> str:
    """A short piece with its edge 0.15 mm from the longest upright one that there is."""
    upright = r"\(segment \(start (\S+) (\S+)\) \(end \1 (\S+)\) \(width 0.2\)(.*?)\)\n"
    found = max(re.finditer(upright, text), key=lambda f: abs(float(f[2]) - float(f[3])))
    x, y = float(found[1]) + 0.35, (float(found[2]) + float(found[3])) / 2
    layer = re.search(r'\(layer "\S+"\)', found[4])
    assert layer
    piece = f"  (segment (start {x} {y}) (end {x} {y}) (width 0.2) {layer[0]} (net 0))\n"
    return text.replace("  (segment", piece + "  (segment", 1)


def track_over_the_edge(text: str) -> str:
    piece = '  (segment (start 128.8 100) (end 128.8 100.2) (width 0.2) (layer "F.Cu") (net 0))\n'
    return text.replace("  (segment", piece + "  (segment", 1)


def fill_adrift(text: str) -> str:
    """An island of pour over the middle of a hole's clearance, where no other copper is."""
    hole = re.search(r'"lumitip:MountingHole_[^\n]*\n[^\n]*\n[^\n]*\n\s*\(at (\S+) (\S+)\)', text)
    assert hole
    x, y = float(hole[1]), float(hole[2])
    corners = " ".join(f"(xy {x + dx} {y + dy})" for dx, dy in ((0, 0), (0.2, 0), (0, 0.2)))
    island = f'    (filled_polygon (layer "F.Cu") (pts {corners}))\n    (filled_polygon'
    return text.replace("    (filled_polygon", island, 1)


RECEIVER_DAMAGES: dict[Damage, set[str]] = {
    net_names_swapped: {"names", "open", "short"},
    inputs_swapped: {"lands", "channels"},
    detector_reversed: {"lands", "polarity", "silk_marks"},
    track_narrow: {"track_width"},
    via_dropped: {"open", "service"},
    vias_beside_dropped: {"bypass_via"},
    via_ring_thin: {"via_ring"},
    hole_moved: {"holes", "hole_clearance"},
    hole_narrow: {"hole_width", "pin_clearance"},
    hole_missing: {"hole_count", "holes", "silk_gap", "lands"},
    edge_moved: {"outline", "pocket_gap"},
    pull_up_wrong: {"service"},
    capacitor_missing: {"bypass_supply", "bypass_ground"},
    capacitor_far: {
        "bypass_via",
        "bypass_supply",
        "bypass_ground",
        "channels",
        "names",
        "open",
        "short",
        "clearance",
        "silk_gap",
    },
    dot_lost: {"silk_marks"},
    select_lines_swapped: {"lands", "service"},
    connector_reversed: {"lands", "wires", "service", "silk_labels"},
    track_added_near_another: {"clearance"},
    track_over_the_edge: {"edge_clearance"},
    fill_adrift: {"islands", "hole_clearance"},
    spokes_cut: {"spokes"},
}


def hurt(folder: Path, file: str, damage: Damage) -> set[str]:
    path = folder / file
    before = path.read_text()
    path.write_text(damage(before))
    assert path.read_text() != before
    return failing(folder, "board", Path(file).stem)


@pytest.mark.parametrize("damage", EMITTER_DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_the_emitter(damage: Damage, damaged_boards: Path) -> None:
    assert hurt(damaged_boards, EMITTER, damage) == EMITTER_DAMAGES[damage]


@pytest.mark.parametrize("damage", RECEIVER_DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_the_receiver(damage: Damage, damaged_boards: Path) -> None:
    assert hurt(damaged_boards, RECEIVER, damage) == RECEIVER_DAMAGES[damage]


def gone(folder: Path) -> None:
    (folder / RECEIVER).unlink()


def short(folder: Path) -> None:
    cut_short(folder / RECEIVER, 50_000)


def exchanged(folder: Path) -> None:
    swap(folder / EMITTER, folder / RECEIVER)


@pytest.mark.parametrize("damage", [gone, short], ids=lambda d: d.__name__)
def test_a_file_that_cannot_be_read(damage: Callable[[Path], None], damaged_boards: Path) -> None:
    damage(damaged_boards)
    assert failing(damaged_boards, "board") == {"readable"}


def test_the_boards_exchanged(damaged_boards: Path) -> None:
    exchanged(damaged_boards)
    assert {"cells", "channels", "strings"} <= failing(damaged_boards, "board")


def pull_ups_lost(text: str) -> str:
    """No part is a resistor by its reference."""
    hurt, count = re.subn(r'((?:"Reference"|reference) ")R', r"\g<1>X", text)
    assert count
    return hurt


def test_a_receiver_without_pull_ups_never_settles(damaged_boards: Path) -> None:
    assert {"service", "settling"} <= hurt(damaged_boards, RECEIVER, pull_ups_lost)


def test_every_check_fails_for_some_damage(boards: Callable[[str], Path]) -> None:
    folder = boards("small")
    design = read_design(folder / "design.json")
    found = list(board.measure(folder, design))
    assert [m for m in found if not m.passed] == []
    names = {m.check.removeprefix("board.") for m in found if m.subject in (EMITTER, RECEIVER)}
    elsewhere = {"readable", "settling", "wire_order"}
    assert names == elsewhere.union(*EMITTER_DAMAGES.values(), *RECEIVER_DAMAGES.values())
