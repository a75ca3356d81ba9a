"""The power LED of the flange's board: what is refused, and what its checks find damaged."""

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

FLANGE = "boards/flange/flange.kicad_pcb"
Damage = Callable[[str], str]


@pytest.fixture
def folder(boards: Callable[[str], Path], tmp_path: Path) -> Path:
    """Boards of a design with a power LED, to damage."""
    return Path(shutil.copytree(boards("switched"), tmp_path / "lit"))


def led_reversed(text: str) -> str:
    return swapped_pads(text, "D2", "1", "2")


def resistor_small(text: str) -> str:
    return in_part(text, "R4", r'value "1K1"', 'value "120R"')


def resistor_large(text: str) -> str:
    return in_part(text, "R4", r'value "1K1"', 'value "4K7"')


def resistor_without_a_value(text: str) -> str:
    return in_part(text, "R4", r'value "1K1"', 'value "some"')


def led_behind(text: str) -> str:
    """On the side of the contacts, its pads in their places."""
    return in_part(text, "D2", r'\(layer "F.Cu"\)', '(layer "B.Cu")')


def led_bridged(text: str) -> str:
    """A track from the output to the LED: no resistor before it."""
    at = text.index('(fp_text reference "R4"')
    place = re.search(r"\(at (\S+) (\S+?)[ )]", text[text.rindex("\n  (footprint", 0, at) :])
    net = re.search(r'\(net (\d+) "5V"\)', text)
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
    resistor_large: {"indicator_dim"},
    resistor_without_a_value: {"indicator_dim", "indicator_bright", "indicator_load"},
    led_bridged: {"indicator", "short", "joined"},
}


def test_an_undamaged_board_passes(folder: Path) -> None:
    design = read_design(folder / "design.json")
    found = list(board.measure_board(folder, design, "flange"))
    assert [m for m in found if not m.passed] == []
    lit = {m.check.removeprefix("board.") for m in found if "indicator" in m.check}
    assert lit == {"indicator", "indicator_dim", "indicator_bright", "indicator_load"}


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_the_power_led(damage: Damage, folder: Path) -> None:
    before = (folder / FLANGE).read_text()
    (folder / FLANGE).write_text(damage(before))
    assert (folder / FLANGE).read_text() != before
    assert failing(folder, "board", "flange") == DAMAGES[damage]


def test_an_led_among_the_contacts_is_seen(folder: Path) -> None:
    (folder / FLANGE).write_text(led_behind((folder / FLANGE).read_text()))
    assert "indicator" in failing(folder, "board", "flange")


def test_a_flange_without_it_has_no_such_checks(boards: Callable[[str], Path]) -> None:
    folder = boards("small")
    design = read_design(folder / "design.json")
    assert design.electrical.indicators == ()
    names = {m.check for m in board.measure_board(folder, design, "flange")}
    assert not any("indicator" in name for name in names)


def test_currents_are_within_what_the_led_needs_and_bears(
    designs: Callable[[str], Design],
) -> None:
    (lit,) = designs("switched").electrical.indicators
    assert lit.visible_ma <= lit.low_ma < lit.high_ma <= lit.max_ma
    assert lit.resistor_w <= lit.load * lit.rated_w


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


def test_an_automatic_led_that_the_output_does_not_suit_is_left_out(
    design_dir: Path, tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    table = folder / "parts/indicators.toml"
    table.write_text(table.read_text().replace("[2.4, 3.1]", "[2.4, 4.7]"))
    design = derive(load(folder / "fingertip.toml"))
    choice = next(c for c in design.choices if c.field == "flange.indicator")
    assert choice.value == "'none'"
    assert "to be seen" in choice.reason
    assert design.electrical.indicators == ()
