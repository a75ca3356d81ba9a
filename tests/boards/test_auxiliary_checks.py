"""Damage the board files of an auxiliary board, and exactly the right checks fail."""

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
    text_over_a_tie,
    tie_far,
    tie_missing,
    tie_moved,
    tie_of,
    tie_wide,
)
from damages import failing
from lumitip_fab.checks import board
from lumitip_fab.design.encoding import read_design
from silk_damages import letters_small, title_lost

pytestmark = pytest.mark.slow

Damage = Callable[[str], str]
BREAKOUT = "boards/breakout/breakout.kicad_pcb"


def part_moved(text: str) -> str:
    return moved_part(text, "J6", 0.05, 0.0)


def part_added(text: str) -> str:
    pad = '(pad "1" smd rect (at 0 0) (size 0.3 0.3) (layers "F.Cu") (net 0 ""))'
    extra = f'(fp_text reference "X1" (at 0 0) (layer "F.SilkS")) {pad}'
    return text.rstrip()[:-1] + f'(footprint "X" (layer "F.Cu") (at 128.8 100) {extra}))\n'


def part_missing(text: str) -> str:
    return in_part(text, "J6", r'\(fp_text reference "J6"', '(fp_text reference "X6"')


def hole_of_a_pad_wider(text: str) -> str:
    return in_part(text, "J5", r"\(drill 1\.2\)", "(drill 1.3)")


def pad_without_copper(text: str) -> str:
    return in_part(text, "J6", r'(pad "2".*?)"\*\.Cu" ', r"\g<1>")


def wires_exchanged(text: str) -> str:
    """Two pads of a cable with each other's number: their copper and their nets stay."""
    return swapped_pads(text, "J5", "2", "3")


def socket_pins_exchanged(text: str) -> str:
    """Two pins whose pads say each other's net: their copper is as before."""
    first = re.search(r'\(net (\d+) "A0"\)', text)
    second = re.search(r'\(net (\d+) "A1"\)', text)
    assert first and second
    text = in_part(text, "J1", re.escape(first[0]), second[0])
    return in_part(text, "J1", r'(pad "5".*)' + re.escape(second[0]), r"\g<1>" + first[0])


def names_exchanged(text: str) -> str:
    """The emitter's wires called by each other's name."""
    y = 100 - 14.367
    near = [
        m
        for m in re.finditer(r'\(gr_text "(GND|12V)" \(at (\S+) (\S+) ', text)
        if abs(float(m[3]) - y) < 3 and float(m[2]) < 140
    ]
    assert len(near) == 2
    for m, other in zip(near, ("12V", "GND"), strict=True):
        text = text[: m.start()] + m[0].replace(m[1], other) + text[m.end() :]
    return text


def via_dropped(text: str) -> str:
    ground = re.search(r'\(net (\d+) "GND"\)', text)
    assert ground
    return once(text, rf"\n  \(via [^\n]*\(net (?!{ground[1]}\))[^\n]*", "")


def via_ring_thin(text: str) -> str:
    return once(text, r"(\(via .*?\(size )0\.6\)", r"\g<1>0.5)")


def track_narrow(text: str) -> str:
    return once(text, r"(\(segment .*?\(width )0\.2\)", r"\g<1>0.15)")


def supply_narrow(text: str) -> str:
    return once(text, r"(\(segment .*?\(width )0\.5\)", r"\g<1>0.4)")


def track_across(text: str) -> str:
    """A track over a gap between two nets."""
    piece = '  (segment (start 130.3 85.633) (end 132.82 85.633) (width 0.2) (layer "B.Cu") '
    return text.replace("  (segment", f"{piece}(net 0))\n  (segment", 1)


def track_over_the_edge(text: str) -> str:
    piece = '  (segment (start 127.15 100) (end 127.15 100.2) (width 0.2) (layer "F.Cu") (net 0))\n'
    return text.replace("  (segment", piece + "  (segment", 1)


def hole_moved(text: str) -> str:
    return moved_part(text, "H1", 0.05, 0.0)


def hole_narrow(text: str) -> str:
    return in_part(text, "H1", r"\(drill 2\.1\)", "(drill 2)")


def tie_over_the_edge(text: str) -> str:
    return moved_part(text, tie_of(text, -1), 0.5, 0.0)


def tie_under_a_socket(text: str) -> str:
    return moved_part(text, tie_of(text), 0.0, -5.6)


def hole_missing(text: str) -> str:
    return in_part(text, "H1", "np_thru_hole", "connect")


def edge_moved(text: str) -> str:
    low = max(float(y) for y in re.findall(r"\(gr_line \(start \S+ (\S+)\)[^\n]*Edge", text))

    def farther(m: re.Match[str]) -> str:
        y = float(m[3])
        return f"({m[1]} {m[2]} {y + 0.1 if y > low - 1.1 else y:g})"

    return "\n".join(
        re.sub(r"\((start|mid|end) (\S+) (\S+)\)", farther, line) if "Edge.Cuts" in line else line
        for line in text.split("\n")
    )


def fill_adrift(text: str) -> str:
    """An island of pour inside a hole's clearance."""
    corners = "(xy 132.22 100) (xy 132.42 100) (xy 132.22 100.2)"
    island = f'    (filled_polygon (layer "F.Cu") (pts {corners}))\n    (filled_polygon'
    return text.replace("    (filled_polygon", island, 1)


def letters_thin(text: str) -> str:
    return once(text, r'(\(gr_text "GND"[^\n]*\(thickness )0\.15', r"\g<1>0.1")


def silk_on_a_pad(text: str) -> str:
    line = '  (gr_line (start 140 114.367) (end 158 114.367) (layer "F.SilkS") (width 0.15))\n'
    return text.replace("  (gr_line", line + "  (gr_line", 1)


def reference_twice(text: str) -> str:
    return in_part(text, "H2", 'reference "H2"', 'reference "H1"')


ELSEWHERE = {"feed", "probe_width", "probe_room", "title_block", "warming", "wire_order"}
"""Damaged in test_feed.py, test_probes.py, test_board_checks.py, test_flange_checks.py and
test_wire_order.py."""
DAMAGES: dict[Damage, set[str]] = {
    part_moved: {"lands", "clearance"},  # the pour is as near as it may be
    part_added: {"other_parts"},
    part_missing: {"other_parts", "lands", "apart", "tie_reach", "probes", "probe_names"},
    hole_of_a_pad_wider: {"lands"},
    pad_without_copper: {
        *("lands", "apart", "tie_count", "tie_width", "hole_clearance"),
        *("probes", "probe_names", "silk_bodies"),
    },
    wires_exchanged: {"lands", "apart", "joined", "probes"},
    socket_pins_exchanged: {"open", "short"},
    names_exchanged: {"silk_labels"},
    via_dropped: {"open", "apart"},
    via_ring_thin: {"via_ring"},
    track_narrow: {"track_width"},
    track_across: {"short", "joined"},
    supply_narrow: {"supply_width"},
    track_over_the_edge: {"edge_clearance"},
    spokes_cut: {"spokes"},
    hole_moved: {"holes", "hole_clearance"},
    hole_narrow: {"hole_width"},
    hole_missing: {"hole_count", "holes", "other_parts"},
    tie_moved: {"ties", "hole_clearance"},
    tie_far: {"ties", "tie_reach", "hole_clearance"},
    tie_wide: {"tie_width", "tie_edge", "hole_clearance"},
    tie_missing: {"tie_count", "ties", "tie_reach", "other_parts"},
    tie_over_the_edge: {"ties", "tie_edge", "hole_clearance"},
    tie_under_a_socket: {"ties", "tie_reach", "tie_parts", "tie_silk", "hole_clearance"},
    text_over_a_tie: {"tie_silk", "silk_bodies"},
    edge_moved: {"outline"},
    fill_adrift: {"islands", "hole_clearance"},
    title_lost: {"silk_title"},
    letters_small: {"silk_letters"},
    letters_thin: {"silk_lines"},
    silk_on_a_pad: {"silk_gap", "tie_silk"},
    reference_twice: {"references"},
}


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_the_breakout(damage: Damage, damaged_boards: Path) -> None:
    path = damaged_boards / BREAKOUT
    before = path.read_text()
    path.write_text(damage(before))
    assert path.read_text() != before
    assert failing(damaged_boards, "board", "breakout") == DAMAGES[damage]


def test_a_missing_auxiliary_is_told(damaged_boards: Path) -> None:
    (damaged_boards / BREAKOUT).unlink()
    assert failing(damaged_boards, "board") == {"readable"}


def test_every_check_fails_for_some_damage(boards: Callable[[str], Path]) -> None:
    folder = boards("small")
    design = read_design(folder / "design.json")
    found = [m for m in board.measure(folder, design) if m.subject == BREAKOUT]
    assert [m for m in found if not m.passed] == []
    names = {m.check.removeprefix("board.") for m in found}
    assert names == set().union(*DAMAGES.values(), {"readable"}, ELSEWHERE)
