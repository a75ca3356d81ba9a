"""Damage the flange's board, and exactly the right checks fail."""

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import in_part, moved_part, once, swapped_pads
from damages import failing
from lumitip_fab.checks import board
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive, resolve
from lumitip_fab.derive.boards.supply_input import halved
from lumitip_fab.design.encoding import read_design
from lumitip_fab.errors import InputError

pytestmark = pytest.mark.slow

Damage = Callable[[str], str]
FLANGE = "boards/flange/flange.kicad_pcb"


def capacitor_far(text: str) -> str:
    """The input capacitor where there is nothing: a wide loop, and nothing joins it."""
    return moved_part(text, "C1", -7.5, 5.0)


def supply_narrow(text: str) -> str:
    return once(text, r"(\(segment .*?\(width )0\.5\)", r"\g<1>0.4)")


def supply_of_the_gripper_narrow(text: str) -> str:
    """A track that the gripper's current passes."""
    net = re.search(r'\(net (\d+) "[^"]*_IN"\)', text)
    assert net
    return once(text, rf"(\(segment [^\n]*?\(width )0\.5(\)[^\n]*\(net {net[1]}\))", r"\g<1>0.2\2")


def ground_under_the_regulator_missing(text: str) -> str:
    """The pour of the back, which is of no net any more."""
    zone = text.index("(zone", text.index("(zone") + 1)
    return text[:zone] + re.sub(
        r'\(net \d+\)\s+\(net_name "GND"\)', '(net 0) (net_name "")', text[zone:], count=1
    )


def way_to_the_capacitor_missing(text: str) -> str:
    """The tracks of the supply that end at the capacitor taken away."""
    net = re.search(r'\(net (\d+) "VIN"\)', text)
    assert net
    x, y = 150 - 4.9, 100 + 0.825
    kept = []
    for line in text.split("\n"):
        if "(segment" in line and f"(net {net[1]})" in line:
            ends = re.findall(r"\((?:start|end) (\S+) (\S+)\)", line)
            if any(abs(float(a) - x) < 0.5 and abs(float(b) - y) < 0.6 for a, b in ends):
                continue
        kept.append(line)
    return "\n".join(kept)


def contacts_in_front(text: str) -> str:
    """The spring contacts on the side where all else is, their pads in their places."""
    return in_part(text, "J1", r'\(layer "B.Cu"\)', '(layer "F.Cu")')


def resistor_small(text: str) -> str:
    """A resistor before the regulator that does not damp, and lets a large pulse through."""
    return in_part(text, "R3", r'value "4R7"', 'value "0R05"')


def resistor_without_a_value(text: str) -> str:
    return in_part(text, "R3", r'value "4R7"', 'value "some"')


def resistor_bridged(text: str) -> str:
    """A track from one end of the resistor to the other."""
    at = text.index('(fp_text reference "R3"')
    part = text[text.rindex("\n  (footprint", 0, at) :]
    place = re.search(r"\(at (\S+) (\S+?)[ )]", part)
    net = re.search(r'\(net (\d+) "VIN"\)', text)
    assert place and net
    x, y = float(place[1]), float(place[2])
    track = (
        f"  (segment (start {x:g} {y - 1.475:g}) (end {x:g} {y + 1.475:g}) (width 0.5) "
        f'(layer "F.Cu") (net {net[1]}))\n'
    )
    at = text.index("  (segment")
    return text[:at] + track + text[at:]


def tvs_reversed(text: str) -> str:
    return swapped_pads(text, "D1", "1", "2")


def dot_lost(text: str) -> str:
    """The dot at lead 1 of the regulator."""
    return in_part(text, "U1", r'\n[^\n]*\(fp_line [^\n]*"F.SilkS"\) \(width 0\.3\)[^\n]*', "")


def references_exchanged(text: str) -> str:
    return (
        once(text, r'\(gr_text "C2"', '(gr_text "R?"')
        .replace('(gr_text "C3"', '(gr_text "C2"')
        .replace('(gr_text "R?"', '(gr_text "C3"')
    )


def reference_under_a_body(text: str) -> str:
    """The coil's reference in the middle of the coil."""
    at = text.index('(fp_text reference "L1"')
    place = re.search(r"\(at (\S+) (\S+?)[ )]", text[text.rindex("\n  (footprint", 0, at) :])
    assert place
    return once(text, r'(\(gr_text "L1"\s+\(at )\S+ [^ )]+', rf"\g<1>{place[1]} {place[2]}")


DAMAGES: dict[Damage, set[str]] = {
    resistor_small: {"plug_in_voltage", "plug_in_current"},
    resistor_without_a_value: {"plug_in_voltage", "plug_in_current", "plug_in_surge"},
    resistor_bridged: {"undamped", "supply_input", "short", "joined"},  # it meets ground, too
    tvs_reversed: {
        "tvs",
        "lands",
        "silk_marks",
        "undamped",
        "contact_signals",
        "apart",
        "joined",
    },
    dot_lost: {"silk_marks"},
    references_exchanged: {"silk_bodies"},
    reference_under_a_body: {"silk_bodies"},
    contacts_in_front: {"lands", "silk_bodies"},
    # Its pads lie in the ground pour.
    capacitor_far: {
        "lands",
        "silk_bodies",
        "bypass_via",
        "hot_loop",
        "hot_loop_input",
        "open",
        "short",
        "apart",
        "joined",
    },
    supply_narrow: {"supply_width"},
    supply_of_the_gripper_narrow: {"supply_width", "warming"},
    ground_under_the_regulator_missing: {"hot_loop_ground"},
    way_to_the_capacitor_missing: {"hot_loop_input", "open", "apart"},
}


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_the_flange(damage: Damage, damaged_boards: Path) -> None:
    path = damaged_boards / FLANGE
    before = path.read_text()
    path.write_text(damage(before))
    assert path.read_text() != before
    assert failing(damaged_boards, "board", "flange") == DAMAGES[damage]


def test_the_flange_passes(boards: Callable[[str], Path]) -> None:
    folder = boards("small")
    found = [
        m for m in board.measure(folder, read_design(folder / "design.json")) if m.subject == FLANGE
    ]
    assert [m for m in found if not m.passed] == []
    layout = {m.check.removeprefix("board.") for m in found if "hot_loop" in m.check}
    assert layout == {"hot_loop", "hot_loop_ground", "hot_loop_input"}


def test_a_gate_that_bears_less_than_the_tvs_diode_lets_through(
    boards: Callable[[str], Path], tmp_path: Path
) -> None:
    """At 24 V a divider halves what is between gate and source."""
    damaged = Path(shutil.copytree(boards("fingertip"), tmp_path / "damaged"))
    path, before = damaged / FLANGE, (boards("fingertip") / FLANGE).read_text()
    assert failing(damaged, "board", "flange") == set()
    path.write_text(in_part(before, "R1", r'value "100K"', 'value "1M"'))
    assert failing(damaged, "board", "flange") == {"gate_voltage"}
    path.write_text(in_part(before, "R1", r'value "100K"', 'value "some"'))
    assert failing(damaged, "board", "flange") == {"gate_voltage"}


@pytest.mark.parametrize(("volts", "divides"), [(5.0, False), (12.0, False), (12.5, True)])
def test_a_divider_halves_the_gate_where_the_tvs_diode_holds_more_than_it_bears(
    volts: float, divides: bool, design_dir: Path
) -> None:
    asked = load(design_dir / "fingertip.toml").with_values({"supply.voltage_v": volts})
    config = resolve(asked).config
    assert halved(config) == divides
    parts = config.parts.flange
    assert parts.tvs.clamping_v / (2 if divides else 1) <= parts.transistor.gate_v


def test_a_gate_that_a_surge_overcomes_though_it_is_halved_is_refused(
    design_dir: Path, tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    entries = folder / "parts/transistors.toml"
    entries.write_text(
        entries.read_text(encoding="utf-8").replace("gate_v = 20.0", "gate_v = 16.0")
    )
    with pytest.raises(
        InputError, match=r"gate bears 16 V; while 'SMBJ24A' holds a surge it is at"
    ):
        derive(load(folder / "fingertip.toml"))
