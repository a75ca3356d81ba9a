"""The power LEDs of flange and breakout: what is refused, and what its checks find damaged."""

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import in_part, swapped_pads
from damages import failing
from lumitip_fab.checks import board
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import read_design
from lumitip_fab.errors import InputError

pytestmark = pytest.mark.slow

FLANGE, BREAKOUT = (f"boards/{name}/{name}.kicad_pcb" for name in ("flange", "breakout"))
Damage = Callable[[str, str, str], str]
LIT = {"flange": ("D2", "R4", "1K1", "4K7"), "breakout": ("LED1", "R7", "390R", "1K8")}
"""LED and resistor of each board, its value, and one with which the LED is dark."""
each_board = pytest.mark.parametrize("name", LIT)


@pytest.fixture
def folder(boards: Callable[[str], Path], tmp_path: Path) -> Path:
    """Boards of a design with power LEDs, to damage."""
    return Path(shutil.copytree(boards("switched"), tmp_path / "lit"))


def led_reversed(text: str, led: str, _: str) -> str:
    return swapped_pads(text, led, "1", "2")


def resistor_small(text: str, _: str, resistor: str) -> str:
    return in_part(text, resistor, r'value "[^"]+"', 'value "20R"')


def resistor_without_a_value(text: str, _: str, resistor: str) -> str:
    return in_part(text, resistor, r'value "[^"]+"', 'value "some"')


def led_behind(text: str, led: str, _: str) -> str:
    """On the board's back, its pads in their places."""
    return in_part(text, led, r'\(layer "F.Cu"\)', '(layer "B.Cu")')


def led_bridged(text: str, _: str, resistor: str) -> str:
    """A track from the supply to the LED: no resistor before it."""
    at = text.index(f'(fp_text reference "{resistor}"')
    part = text[text.rindex("\n  (footprint", 0, at) : at + 4000]
    place = re.search(r"\(at (\S+) (\S+?)[ )]", part)
    net = re.search(r'\(net (\d+) "(5V|3V3)"\)', part)
    assert place and net
    x, y = float(place[1]), float(place[2])
    track = (
        f"  (segment (start {x - 0.825:g} {y:g}) (end {x + 0.825:g} {y:g}) (width 0.5) "
        f'(layer "F.Cu") (net {net[1]}))\n'
    )
    at = text.index("  (segment")
    return text[:at] + track + text[at:]


DAMAGES: dict[Damage, set[str]] = {
    led_reversed: {"indicator", "lands", "silk_marks", "joined", "apart"},
    resistor_small: {"indicator_bright", "indicator_load"},
    resistor_without_a_value: {"indicator_dim", "indicator_bright", "indicator_load"},
    led_bridged: {"indicator", "short", "joined"},
}


@each_board
def test_an_undamaged_board_passes(folder: Path, name: str) -> None:
    design = read_design(folder / "design.json")
    found = list(board.measure_board(folder, design, name))
    assert [m for m in found if not m.passed] == []
    lit = {m.check.removeprefix("board.") for m in found if "indicator" in m.check}
    assert lit == {"indicator", "indicator_dim", "indicator_bright", "indicator_load"}


@each_board
@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_the_power_led(damage: Damage, folder: Path, name: str) -> None:
    _damage(folder, name, damage)
    assert failing(folder, "board", name) == DAMAGES[damage]


@each_board
def test_an_led_that_is_too_dim_is_seen(folder: Path, name: str) -> None:
    *_, ohm, dark = LIT[name]
    _damage(
        folder,
        name,
        lambda text, _, ref: in_part(text, ref, f'value "{ohm}"', f'value "{dark}"'),
    )
    assert failing(folder, "board", name) == {"indicator_dim"}


@each_board
def test_an_led_on_the_back_is_seen(folder: Path, name: str) -> None:
    _damage(folder, name, led_behind)
    assert "indicator" in failing(folder, "board", name)


def _damage(folder: Path, name: str, damage: Damage) -> None:
    file = folder / {"flange": FLANGE, "breakout": BREAKOUT}[name]
    led, resistor, *_ = LIT[name]
    before = file.read_text()
    file.write_text(damage(before, led, resistor))
    assert file.read_text() != before


@each_board
def test_a_board_without_it_has_no_such_checks(boards: Callable[[str], Path], name: str) -> None:
    folder = boards("small")
    design = read_design(folder / "design.json")
    assert design.electrical.indicators == ()
    names = {m.check for m in board.measure_board(folder, design, name)}
    assert not any("indicator" in name for name in names)


def test_currents_are_within_what_the_led_needs_and_bears(
    designs: Callable[[str], Design],
) -> None:
    found = designs("switched").electrical.indicators
    assert [(lit.board, lit.output_v) for lit in found] == [("flange", 5.0), ("breakout", 3.3)]
    for lit in found:
        assert lit.visible_ma <= lit.low_ma < lit.high_ma <= lit.max_ma
        assert lit.resistor_w <= lit.load * lit.rated_w


def test_a_module_needs_no_breakout_and_no_led_there(designs: Callable[[str], Design]) -> None:
    assert {lit.board for lit in designs("integrated").electrical.indicators} == {"flange"}


ENTRY = """
["dim"]
source = "a test"
confidence = "assumed"
manufacturer = "a test"
order_number = "dim"
body_mm = [2.0, 1.25, 0.75]
pad_mm = [0.975, 1.4]
pad_pitch_mm = 1.875
colour = "blue"
forward_v = [{low}, {high}]
current_ma = {ma}
visible_ma = 0.5
max_current_ma = {most}
"""
REFUSED = [
    ({"low": 3.0, "high": 4.7, "ma": 2.0, "most": 10.0}, "needs 0.5 mA to be seen"),
    ({"low": 2.4, "high": 3.1, "ma": 20.0, "most": 20.0}, "rated 20 mA"),
    ({"low": 1.8, "high": 2.2, "ma": 30.0, "most": 90.0}, "the limit of a '0603' is 60 mW"),
]


@pytest.mark.parametrize(("figures", "says"), REFUSED)
def test_an_led_that_the_output_does_not_suit_is_refused(
    design_dir: Path, tmp_path: Path, figures: dict[str, float], says: str
) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    with (folder / "parts/indicators.toml").open("a") as table:
        table.write(ENTRY.format(**figures))
    mine = folder / "mine.toml"
    mine.write_text('extends = "fingertip.toml"\n[flange]\nindicator = "dim"\n')
    with pytest.raises(InputError) as caught:
        derive(load(mine))
    assert any(p.field == "flange.indicator" and says in p.message for p in caught.value.problems)


def test_the_flanges_green_led_is_too_dim_at_the_controllers_supply(
    design_dir: Path, tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    mine = folder / "mine.toml"
    mine.write_text('extends = "fingertip.toml"\n[breakout]\nindicator = "APT2012LZGCK"\n')
    with pytest.raises(InputError) as caught:
        derive(load(mine))
    (problem,) = caught.value.problems
    assert problem.field == "breakout.indicator"
    assert "needs 0.5 mA to be seen and up to 3.1 V; at 3.3 V" in problem.message


@pytest.mark.parametrize(
    ("old", "new", "field", "left"),
    [
        ("[2.4, 3.1]", "[2.4, 4.7]", "flange.indicator", "breakout"),
        ("[1.8, 2.4]", "[2.2, 3.1]", "breakout.indicator", "flange"),
    ],
)
def test_an_automatic_led_that_the_supply_does_not_suit_is_left_out(
    design_dir: Path, tmp_path: Path, old: str, new: str, field: str, left: str
) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    table = folder / "parts/indicators.toml"
    table.write_text(table.read_text().replace(old, new))
    design = derive(load(folder / "fingertip.toml"))
    choice = next(c for c in design.choices if c.field == field)
    assert choice.value == "'none'"
    assert "to be seen" in choice.reason
    assert [lit.board for lit in design.electrical.indicators] == [left]


def test_a_breakout_that_is_too_small_has_no_automatic_led(
    design_dir: Path, tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    mine = folder / "mine.toml"
    small = 'extends = "fingertip.toml"\n[protection]\ndiode = "none"\n[breakout]\n'
    mine.write_text(small + "board_mm = [43.0, 36.0]\n")
    choice = next(c for c in derive(load(mine)).choices if c.field == "breakout.indicator")
    assert choice.value == "'none'"
    assert "room between the wires" in choice.reason
    mine.write_text(small + 'board_mm = [43.0, 36.0]\nindicator = "KT-0805YG"\n')
    with pytest.raises(InputError, match=r"breakout\.indicator is 'KT-0805YG'; it has room"):
        derive(load(mine))
