"""The protection of the controller's pins: what is refused, and what its checks find damaged."""

import json
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

slow = pytest.mark.slow

BREAKOUT = "boards/breakout/breakout.kicad_pcb"
CHECKS = {"", "_reach", "_pins", "_line", "_pulse"}
Damage = Callable[[str], str]


@pytest.fixture
def folder(boards: Callable[[str], Path], tmp_path: Path) -> Path:
    """Boards of a design with protected pins, to damage."""
    return Path(shutil.copytree(boards("switched"), tmp_path / "protected"))


def _track(text: str, ref: str, net: str) -> str:
    """A track between both pads of a standing part of 1.65 mm from pad to pad."""
    at = text.index(f'(fp_text reference "{ref}"')
    place = re.search(r"\(at (\S+) (\S+?)[ )]", text[text.rindex("\n  (footprint", 0, at) :])
    number = re.search(rf'\(net (\d+) "{net}"\)', text)
    assert place and number
    x, y = float(place[1]), float(place[2])
    track = (
        f"  (segment (start {x:g} {y - 0.825:g}) (end {x:g} {y + 0.825:g}) (width 0.25) "
        f'(layer "F.Cu") (net {number[1]}))\n'
    )
    at = text.index("  (segment")
    return text[:at] + track + text[at:]


def diode_reversed(text: str) -> str:
    return swapped_pads(text, "Z5", "1", "2")


def diode_far(text: str) -> str:
    """Off the copper of its wire."""
    return moved_part(text, "Z7", 20.0, 0.0)


def resistor_bridged(text: str) -> str:
    return _track(text, "R4", "A0")


def resistor_small(text: str) -> str:
    return in_part(text, "R4", r'value "1K"', 'value "100R"')


def resistor_without_a_value(text: str) -> str:
    return in_part(text, "R4", r'value "1K"', 'value "some"')


def capacitor_large(text: str) -> str:
    return in_part(text, "C1", r'value "22pF"', 'value "47pF"')


def capacitor_without_a_value(text: str) -> str:
    return in_part(text, "C1", r'value "22pF"', 'value "some"')


def capacitor_bridged(text: str) -> str:
    return _track(text, "C1", "GND")


DAMAGES: dict[Damage, set[str]] = {
    diode_reversed: {
        "protection",
        "protection_reach",
        "protection_pulse",
        "lands",
        "silk_marks",
        "joined",
        "apart",
    },
    resistor_bridged: {
        "protection",
        "protection_pins",
        "protection_pulse",
        "short",
        "joined",
    },
    resistor_small: {"protection_pulse"},
    resistor_without_a_value: {"protection_pulse"},
    capacitor_large: {"protection_line"},
    capacitor_without_a_value: {"protection_line"},
}


@slow
def test_an_undamaged_board_passes(folder: Path) -> None:
    design = read_design(folder / "design.json")
    found = list(board.measure_board(folder, design, "breakout"))
    assert [m for m in found if not m.passed] == []
    names = {m.check.removeprefix("board.") for m in found if "protection" in m.check}
    assert names == {f"protection{ending}" for ending in CHECKS}


@slow
@pytest.mark.parametrize("damage", DAMAGES, ids=lambda d: d.__name__)
def test_a_damage_of_the_protection(damage: Damage, folder: Path) -> None:
    before = (folder / BREAKOUT).read_text()
    (folder / BREAKOUT).write_text(damage(before))
    assert (folder / BREAKOUT).read_text() != before
    assert failing(folder, "board", "breakout") == DAMAGES[damage]


SEEN: dict[Damage, set[str]] = {
    diode_far: {"protection", "protection_reach"},
    capacitor_bridged: {"protection"},
}
"""Damages that other checks see as well."""


@slow
@pytest.mark.parametrize("damage", SEEN, ids=lambda d: d.__name__)
def test_a_damage_is_seen_here_too(damage: Damage, folder: Path) -> None:
    (folder / BREAKOUT).write_text(damage((folder / BREAKOUT).read_text()))
    assert SEEN[damage] <= failing(folder, "board", "breakout")


@slow
def test_a_pin_or_diode_farther_than_allowed_fails(folder: Path) -> None:
    design = json.loads((folder / "design.json").read_text())
    design["electrical"]["protection"] |= {"reach_mm": 1.0, "pin_mm": 1.0}
    (folder / "design.json").write_text(json.dumps(design))
    assert failing(folder, "board", "breakout") == {"protection_reach", "protection_pins"}


@slow
def test_a_board_without_it_has_no_such_checks(boards: Callable[[str], Path]) -> None:
    folder = boards("small")
    design = read_design(folder / "design.json")
    assert design.electrical.protection is None
    names = {m.check for m in board.measure_board(folder, design, "breakout")}
    assert not any("protection" in name for name in names)


def test_each_signal_has_its_parts(designs: Callable[[str], Design]) -> None:
    design = designs("switched")
    protection = design.electrical.protection
    assert protection is not None and protection.board == "breakout"
    (breakout,) = design.protecting
    kinds = [part.kind for part in breakout.components]
    assert protection.lines == ("S0", "S1", "S2", "A0", "A1", "LED")
    assert set(protection.clamped) == {*protection.lines, "3V3", "5V"}
    assert kinds.count("esd diode") == 8
    assert kinds.count("resistor") == 6 + 1  # that of the power LED
    assert kinds.count("capacitor") == 2
    assert kinds.count("fiducial") == 3
    assert protection.most_pin_a is not None
    assert protection.pin_a <= protection.most_pin_a


def _refused(folder: Path, text: str) -> dict[str, str]:
    mine = folder / "mine.toml"
    mine.write_text(f'extends = "fingertip.toml"\n{text}')
    with pytest.raises(InputError) as caught:
        derive(load(mine))
    return {problem.field: problem.message for problem in caught.value.problems}


REFUSED = [
    ("[protection]\nseries_ohm = 1003.0\n", "protection.series_ohm", "Use 1000"),
    ("[protection]\nseries_ohm = 100.0\n", "protection.series_ohm", "at least 300 is needed"),
    ('[protection]\nresistor = "1206"\n', "protection.resistor", "along the sockets"),
    ('[protection]\ncapacitor = "100nF 0603"\n', "protection.capacitor", "200 scans a second"),
    (
        '[protection]\ndiode = "H5VUD5U"\n[breakout]\nboard_mm = [45.72, 33.02]\n',
        "protection.diode",
        "Increase breakout.board_mm",
    ),
    ("[breakout]\nhole_mm = 9.0\nhole_spacing_mm = 20.0\n", "breakout.hole_mm", "beside the screw"),
]


@pytest.mark.slow_cases
@pytest.mark.parametrize(("text", "field", "says"), REFUSED)
def test_parts_that_do_not_protect_or_have_no_room_are_refused(
    design_dir: Path, tmp_path: Path, text: str, field: str, says: str
) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    assert says in _refused(folder, text).get(field, "")


def test_a_diode_that_conducts_at_a_signal_is_refused(design_dir: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    table = folder / "parts/esd_diodes.toml"
    low = table.read_text().replace("standoff_v = 5.0", "standoff_v = 2.5")
    table.write_text(low.replace("[6.0, 9.0]", "[2.8, 4.0]"))
    found = _refused(folder, '[protection]\ndiode = "H5VUD5U"\n')
    assert "for signals up to 2.5 V" in found["protection.diode"]


def test_an_automatic_diode_without_room_is_left_out(design_dir: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    mine = folder / "mine.toml"
    mine.write_text('extends = "fingertip.toml"\n[breakout]\nboard_mm = [45.72, 33.02]\n')
    design = derive(load(mine))
    choice = next(c for c in design.choices if c.field == "protection.diode")
    assert choice.value == "'none'"
    assert "before them" in choice.reason
    assert design.electrical.protection is None


def test_parts_too_wide_for_a_modules_row_are_left_out_or_refused(
    design_dir: Path, tmp_path: Path
) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    mine = folder / "mine.toml"
    wide = 'extends = "presets/integrated.toml"\n[protection]\nresistor = "0805"\n'
    mine.write_text(wide)
    choice = next(c for c in derive(load(mine)).choices if c.field == "protection.diode")
    assert choice.value == "'none'"
    mine.write_text(wide + 'diode = "H5VUD5U"\n')
    with pytest.raises(
        InputError, match=r"protection\.diode is 'H5VUD5U'; the row below the module"
    ):
        derive(load(mine))


def test_a_controller_of_unknown_rating_is_not_limited(design_dir: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    table = folder / "parts/controllers.toml"
    table.write_text(table.read_text().replace("hbm_v = 2000.0\n", ""))
    mine = folder / "mine.toml"
    mine.write_text('extends = "fingertip.toml"\n[protection]\nseries_ohm = 100.0\n')
    protection = derive(load(mine)).electrical.protection
    assert protection is not None
    assert protection.most_pin_a is None


def test_a_capacitor_that_slows_the_scan_is_left_out(design_dir: Path, tmp_path: Path) -> None:
    mine = Path(shutil.copytree(design_dir, tmp_path / "design")) / "slow.toml"
    mine.write_text('extends = "presets/mux16.toml"\n[receiver]\npull_up_ohm = 16000.0\n')
    design = derive(load(mine))
    protection = design.electrical.protection
    assert protection is not None
    assert protection.capacitor_pf == 0
