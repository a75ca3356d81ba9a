"""The check of the schematics passes on what is built, and fails on each damage."""

from collections.abc import Callable
from pathlib import Path

import pytest

from damages import excerpt
from lumitip_fab.checks import schematic
from lumitip_fab.design.encoding import read_design

pytestmark = pytest.mark.slow

CHECKS = [f"schematic.{name}" for name in ("parts", "fields", "pins", "nets", "title_block")]


def _failed(out: Path) -> dict[str, str]:
    """Name and note of each figure out of its range."""
    found = schematic.measure(out, read_design(out / "design.json"))
    return {m.check.removeprefix("schematic."): m.note for m in found if not m.passed}


@pytest.mark.parametrize("preset", ["small", "published"])
def test_schematics_and_boards_agree(boards: Callable[[str], Path], preset: str) -> None:
    out = boards(preset)
    found = list(schematic.measure(out, read_design(out / "design.json")))
    assert [m.check for m in found] == CHECKS * 4
    assert all(m.passed for m in found), [m.note for m in found]


@pytest.mark.parametrize(
    ("finger", "old", "new", "check"),
    [
        ("receiver", '(global_label "Q3"', '(global_label "Q30"', "nets"),
        ("emitter", '(property "Reference" "D2"', '(property "Reference" "D3"', "nets"),
        ("receiver", '(property "Value" "75K"', '(property "Value" "7K5"', "parts"),
        ("receiver", '"lumitip:RESC1608X50N" (id', '"lumitip:RESC2012X50N" (id', "parts"),
        ("receiver", '(property "MPN" "SML-', '(property "MPN" "SMM-', "fields"),
        (
            "receiver",
            '(property "Manufacturer" "Nexperia"',
            '(property "Maker" "Nexperia"',
            "fields",
        ),
        ("receiver", '(property "LCSC" "C', '(property "LCSC" "C9', "fields"),
        ("emitter", '(lib_id "lumitip:R")', '(lib_id "lumitip:R") (dnp yes)', "fields"),
        ("receiver", "(kicad_sch", "(kicad_pcb", "readable"),
        ("receiver", ': receiver")', ': emitter")', "title_block"),
        ("emitter", '(rev "', '(rev "0', "title_block"),
        ("flange", '(date "', '(date "2019-01-01', "title_block"),
        ("breakout", '(comment 1 "Design ', '(comment 1 "Design 0', "title_block"),
    ],
)
def test_a_damaged_schematic_fails(
    damaged_boards: Path, finger: str, old: str, new: str, check: str
) -> None:
    file = damaged_boards / f"boards/{finger}/{finger}.kicad_sch"
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), encoding="utf-8")
    assert check in _failed(damaged_boards)


def _change_pin(file: Path, pin: str, old: str, new: str) -> None:
    """Replace a word of the first pin of a name in a schematic's own library."""
    text = file.read_text(encoding="utf-8")
    last = text.index(pin) + len(pin)
    first = text.rindex("(pin ", 0, last)
    assert old in text[first:last]
    file.write_text(text[:first] + text[first:last].replace(old, new) + text[last:], "utf-8")


@pytest.mark.parametrize(
    ("board", "pin", "old", "new"),
    [
        ("receiver", '(name "VCC"', "(pin power_in", "(pin passive"),
        ("receiver", '(name "Y3"', '"Y3"', '"Y4"'),
        ("receiver", '(name "S1"', "(pin input", "(pin passive"),
        ("flange", '(name "EN"', "(pin input", "(pin passive"),
        ("flange", '(name "FB"', '"FB"', '"EN"'),
    ],
)
def test_a_pin_of_another_type_or_name_fails(
    damaged_boards: Path, board: str, pin: str, old: str, new: str
) -> None:
    _change_pin(damaged_boards / f"boards/{board}/{board}.kicad_sch", pin, old, new)
    assert _failed(damaged_boards).keys() == {"pins"}


@pytest.mark.parametrize(
    ("pin", "old", "new"),
    [
        ('(name "SET"', "(pin input", "(pin passive"),
        ('(name "OUT"', "(pin output", "(pin passive"),
        ('(name "IN"', "(pin power_in", "(pin bidirectional"),
        ('(name "SET"', '"SET"', '"OUT"'),
    ],
)
def test_a_pin_of_a_current_source_fails(
    boards: Callable[[str], Path], tmp_path: Path, pin: str, old: str, new: str
) -> None:
    """Of the emitter alone: the other boards are not there."""
    out = excerpt(boards("fingertip"), tmp_path, "boards/emitter")
    assert _failed(out).keys() == {"readable"}
    _change_pin(out / "boards/emitter/emitter.kicad_sch", pin, old, new)
    assert _failed(out).keys() == {"readable", "pins"}


def test_a_cut_wire_fails(damaged_boards: Path) -> None:
    file = damaged_boards / "boards/receiver/receiver.kicad_sch"
    lines = file.read_text(encoding="utf-8").splitlines()
    wires = [i for i, line in enumerate(lines) if line.startswith("  (wire")]
    del lines[wires[len(wires) // 2]]
    file.write_text("\n".join(lines), encoding="utf-8")
    assert "nets" in _failed(damaged_boards)


def test_a_renamed_supply_fails(damaged_boards: Path) -> None:
    file = damaged_boards / "boards/receiver/receiver.kicad_sch"
    before, own, after = file.read_text(encoding="utf-8").partition('"#PWR003"')
    assert '"Value" "3V3"' in after
    changed = after.replace('"Value" "3V3"', '"Value" "5V"', 1)
    file.write_text(before + own + changed, encoding="utf-8")
    assert "nets" in _failed(damaged_boards)


def test_a_missing_schematic_fails(damaged_boards: Path) -> None:
    (damaged_boards / "boards/emitter/emitter.kicad_sch").unlink()
    assert _failed(damaged_boards).keys() == {"readable"}
