"""The bulk capacitor of the receiver: what is refused, and what its checks find damaged."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import in_part, moved_part
from lumitip_fab.boards.files import board_files
from lumitip_fab.checks import board
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.boards.bulk import BESIDE_WIRES_MM
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import design_text, read_design
from lumitip_fab.errors import InputError

pytestmark = pytest.mark.slow

PRESETS = {file.stem for file in (Path(__file__).parents[2] / "design/presets").glob("*.toml")}
RECEIVER = "boards/receiver/receiver.kicad_pcb"
CHECKS = {"bulk", "bulk_reach", "bulk_dip"}
Damage = Callable[[str], str]


@pytest.fixture(scope="module")
def whole(design_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The receiver's board of a small grid that has room for a bulk capacitor."""
    out = tmp_path_factory.mktemp("bulk")
    design = _mine(design_dir, out, "[grid]\ncolumns = [3, 3]\n")
    (out / "design.json").write_text(design_text(design))
    for artefact in board_files(design, design.receiver):
        (out / artefact.path).parent.mkdir(parents=True, exist_ok=True)
        (out / artefact.path).write_bytes(artefact.data)
    return out


@pytest.fixture
def folder(whole: Path, tmp_path: Path) -> Path:
    """A copy, to damage."""
    return Path(shutil.copytree(whole, tmp_path / "bulk"))


def failing(folder: Path) -> set[str]:
    """Checks of the board that fail."""
    design = read_design(folder / "design.json")
    found = board.measure_board(folder, design, "receiver")
    return {m.check.removeprefix("board.") for m in found if not m.passed}


def value_small(text: str) -> str:
    return in_part(text, "C2", r'value "10uF"', 'value "1nF"')


def value_lost(text: str) -> str:
    return in_part(text, "C2", r'value "10uF"', 'value "some"')


def far(text: str) -> str:
    """At the other end of the wires, where nothing joins it."""
    return moved_part(text, "C2", 25.0, 0.0)


def missing(text: str) -> str:
    return in_part(text, "C2", r'reference "C2"', 'reference "X2"')


DAMAGES: dict[Damage, set[str]] = {
    value_small: {"bulk_dip"},
    value_lost: {"bulk_dip"},
    far: {"bulk", "bulk_reach"},
    missing: {"bulk", "bulk_reach", "bulk_dip"},
}


def test_an_undamaged_board_passes(folder: Path) -> None:
    design = read_design(folder / "design.json")
    found = list(board.measure_board(folder, design, "receiver"))
    assert [m for m in found if not m.passed] == []
    assert {m.check.removeprefix("board.") for m in found} >= CHECKS


@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_the_bulk_capacitor(damage: Damage, folder: Path) -> None:
    before = (folder / RECEIVER).read_text()
    (folder / RECEIVER).write_text(damage(before))
    assert (folder / RECEIVER).read_text() != before
    assert failing(folder) & CHECKS == DAMAGES[damage]


def test_a_receiver_without_it_has_no_such_checks(boards: Callable[[str], Path]) -> None:
    folder = boards("small")
    design = read_design(folder / "design.json")
    assert design.electrical.bulk is None
    names = {m.check for m in board.measure_board(folder, design, "receiver")}
    assert not any("bulk" in name for name in names)


def _mine(design_dir: Path, tmp_path: Path, text: str) -> Design:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    (folder / "mine.toml").write_text(f'extends = "fingertip.toml"\n{text}')
    return derive(load(folder / "mine.toml"))


REFUSED = [
    (
        '[receiver]\nbulk_capacitor = "100nF 0603"\n',
        "receiver.bulk_capacitor",
        "the supply dips by",
    ),
    ('[receiver]\nbulk_capacitor = "22uF 0805"\n', "stack.silicone_mm", "receiver.bulk_capacitor"),
    (
        '[receiver]\nbulk_capacitor = "10uF 0603 10V"\n[grid]\ncolumns = [3, 2, 3, 2]\n',
        "receiver.bulk_capacitor",
        "leave no room",
    ),
]


@pytest.mark.parametrize(("text", "field", "says"), REFUSED)
def test_a_capacitor_that_cannot_be_is_refused(
    design_dir: Path, tmp_path: Path, text: str, field: str, says: str
) -> None:
    with pytest.raises(InputError) as caught:
        _mine(design_dir, tmp_path, text)
    assert any(p.field == field and says in p.message for p in caught.value.problems)


def test_an_automatic_capacitor_without_room_is_left_out(design_dir: Path, tmp_path: Path) -> None:
    design = _mine(design_dir, tmp_path, "[grid]\ncolumns = [3, 2, 3, 2]\n")
    choice = next(c for c in design.choices if c.field == "receiver.bulk_capacitor")
    assert (choice.value, design.electrical.bulk) == ("'none'", None)
    assert "leave no room" in choice.reason


def test_the_dip_is_within_half_a_count(whole: Path) -> None:
    bulk = read_design(whole / "design.json").electrical.bulk
    assert bulk is not None
    assert 0 < bulk.dip_mv <= bulk.most_mv < 1000 * bulk.supply_v / 255


def test_the_mark_of_the_first_wire_has_room_between_hole_and_capacitor(
    designs: Callable[[str], Design],
) -> None:
    receiver = designs("wsg50").receiver
    bulk, (tie,) = receiver.parts[-1], receiver.ties
    assert bulk.kind == "capacitor"
    hole_mm = min(x for x, _ in tie.holes) - tie.hole_mm / 2
    assert hole_mm - bulk.box.x_max_mm >= BESIDE_WIRES_MM


@pytest.mark.parametrize("preset", sorted(PRESETS))
def test_every_preset_but_the_published_circuit_has_one(
    preset: str, designs: Callable[[str], Design]
) -> None:
    assert (designs(preset).electrical.bulk is None) == (preset in {"published", "by_goals"})
