"""Test points of the flange, and wire pads of the breakout: what their checks find damaged."""

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import in_part, moved_part, swapped_pads
from damages import failing
from lumitip_fab.checks import board
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import read_design
from lumitip_fab.errors import InputError

pytestmark = pytest.mark.slow

FLANGE, BREAKOUT = (f"boards/{name}/{name}.kicad_pcb" for name in ("flange", "breakout"))
CHECKS = {"probes", "probe_width", "probe_room", "probe_names"}
Damage = Callable[[str], str]


@pytest.fixture
def folder(boards: Callable[[str], Path], tmp_path: Path) -> Path:
    """Boards, to damage."""
    return Path(shutil.copytree(boards("switched"), tmp_path / "probed"))


def ref_of(design: Design, net: str) -> str:
    (flange,) = (b for b in design.auxiliary_boards if b.name == "flange")
    return next(d.ref for d in flange.components if (d.kind, d.value) == ("test point", net))


def missing(text: str, ref: str) -> str:
    return in_part(text, ref, rf'reference "{ref}"', 'reference "X1"')


def behind(text: str, ref: str) -> str:
    """Its copper on the side that lies in the flange."""
    return in_part(text, ref, r'\(layers "F.Cu" "F.Mask"\)', '(layers "B.Cu" "B.Mask")')


def narrow(text: str, ref: str) -> str:
    return in_part(text, ref, r"\(size 1\.5 1\.5\)", "(size 1.2 1.2)")


def beside_a_header(text: str, ref: str) -> str:
    """Under the edge of the header, its tracks where they were."""
    return moved_part(text, ref, -0.7, 0.0)


DAMAGES: dict[tuple[Damage, str], set[str]] = {
    (missing, "485+"): {"probes", "probe_names"},
    (behind, "485-"): {"probes"},
    (narrow, "5V"): {"probe_width"},
    (beside_a_header, "485-"): {"probe_room"},
}


def test_undamaged_boards_pass(folder: Path) -> None:
    design = read_design(folder / "design.json")
    for name in ("flange", "breakout"):
        found = list(board.measure_board(folder, design, name))
        assert [m for m in found if not m.passed] == []
        assert {m.check.removeprefix("board.") for m in found} >= CHECKS
    names = {m.check for m in board.measure_board(folder, design, "receiver")}
    assert not any("probe" in name for name in names)


@pytest.mark.parametrize(
    ("damage", "net"), DAMAGES, ids=[f"{damage.__name__}-{net}" for damage, net in DAMAGES]
)
def test_a_damage_of_a_test_point(damage: Callable[..., str], net: str, folder: Path) -> None:
    ref = ref_of(read_design(folder / "design.json"), net)
    before = (folder / FLANGE).read_text()
    (folder / FLANGE).write_text(damage(before, ref))
    assert failing(folder, "board", "flange") & CHECKS == DAMAGES[damage, net]


def test_a_name_that_is_not_printed_is_seen(folder: Path) -> None:
    text = (folder / FLANGE).read_text()
    hurt = text.replace('(gr_text "12V_IN"', '(gr_text "12V_INN"')  # at header and test point
    assert hurt.count('"12V_INN"') == 3
    (folder / FLANGE).write_text(hurt)
    expected = {"probe_names", "silk_labels", "silk_bodies"}
    assert failing(folder, "board", "flange") == expected


def test_two_supplies_exchanged_are_seen(folder: Path) -> None:
    """The wires of 12 V and 5 V of the breakout."""
    text = (folder / BREAKOUT).read_text()
    (folder / BREAKOUT).write_text(swapped_pads(text, "J7", "2", "3"))
    assert "probes" in failing(folder, "board", "breakout")


def test_every_net_has_one_once(designs: Callable[[str], Design]) -> None:
    (flange,) = (b for b in designs("switched").auxiliary_boards if b.name == "flange")
    nets = [d.value for d in flange.components if d.kind == "test point"]
    assert nets == ["485+", "485-", "485GND", "12V_IN", "12V", "GND", "5V"]
    assert all(d.side == "front" for d in flange.components if d.kind == "test point")


def test_a_supply_that_is_the_output_has_one(design_dir: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    mine = folder / "mine.toml"
    mine.write_text('extends = "fingertip.toml"\n[supply]\nvoltage_v = 5.0\n')
    (flange,) = (b for b in derive(load(mine)).auxiliary_boards if b.name == "flange")
    nets = [d.value for d in flange.components if d.kind == "test point"]
    assert nets == ["485+", "485-", "485GND", "5V_IN", "5V", "GND"]


def test_more_data_lines_than_places_are_refused(design_dir: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    table = folder / "parts/couplings.toml"
    table.write_text(re.sub(r'kind = "(control|output)"', 'kind = "data"', table.read_text()))
    with pytest.raises(InputError) as caught:
        derive(load(folder / "fingertip.toml"))
    messages = [p.message for p in caught.value.problems if p.field == "flange.signals"]
    assert any("test points" in message for message in messages)
