"""Sheets of flange and breakout: blocks, nets, types of pins, texts that can be read."""

import json
import re
import shutil
from collections import defaultdict
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from lumitip_fab.boards.kicad.project import project_files
from lumitip_fab.boards.kicad.schematic import schematic_files
from lumitip_fab.boards.model import BoardModel, Placement, Routing
from lumitip_fab.boards.placement import place
from lumitip_fab.checks.readers.kicad_shapes import Node, child, children, read_nodes, words
from lumitip_fab.checks.readers.kicad_sheet import read_sheet
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from programs import needs
from sheet_texts import overlaps

FIVE_VOLTS = """\
extends = "published.toml"
[grid]
columns = [3, 2, 3, 2, 3]
[board]
tip_margin_mm = 4.6
[supply]
voltage_v = 5.0
[emitter]
current_ma = 12.0
[flange]
tvs = "SMBJ5.0A"
indicator = "auto"
[breakout]
indicator = "auto"
"""
BOARDS = (
    *(("published", name) for name in ("flange", "breakout", "emitter", "receiver")),
    *(("../fingertip", name) for name in ("flange", "breakout", "emitter", "receiver")),
    *(("integrated", name) for name in ("flange", "receiver")),
    *(("five volts", name) for name in ("flange", "breakout")),
    ("mux16", "breakout"),
)
AUXILIARY = [board for board in BOARDS if board[1] in ("flange", "breakout")]
Drawn = Callable[[tuple[str, str]], tuple[Design, Placement, Path]]
every = pytest.mark.parametrize("board", BOARDS, ids="-".join)


@pytest.fixture(scope="module")
def drawn(design_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Drawn:
    """`drawn(("published", "flange"))`: design, placement and project, without tracks."""
    folder = tmp_path_factory.mktemp("drawn")
    shutil.copytree(design_dir, folder / "design")
    presets = folder / "design/presets"
    (presets / "five volts.toml").write_text(FIVE_VOLTS)
    designs: dict[str, Design] = {}

    def draw(board: tuple[str, str]) -> tuple[Design, Placement, Path]:
        preset, name = board
        if preset not in designs:
            designs[preset] = derive(load(presets / f"{preset}.toml"))
        design = designs[preset]
        made = next(b for b in (*design.fingers, *design.auxiliary_boards) if b.name == name)
        placed, out = place(design, made), folder / preset / name
        files = schematic_files(placed, design)
        files |= project_files(BoardModel(placed, Routing((), (), 0), ()), placed.thickness_mm)
        for path, data in files.items():
            (out / path).parent.mkdir(parents=True, exist_ok=True)
            (out / path).write_bytes(data)
        return design, placed, out / f"{name}.kicad_sch"

    return draw


def _properties(symbol: Node) -> dict[str, str]:
    return {name: value for name, value, *_ in map(words, children(symbol, "property"))}


def _titles(sheet: Path) -> list[str]:
    return [words(text)[0] for text in children(read_nodes(sheet), "text")]


def _types(sheet: Path) -> dict[str, dict[str, str]]:
    """Type of each pin by its name, of each symbol in the sheet's library."""
    shapes = children(child(read_nodes(sheet), "lib_symbols") or [], "symbol")
    return {
        words(shape)[0].removeprefix("lumitip:"): {
            words(child(pin, "name"))[0]: words(pin)[0]
            for unit in children(shape, "symbol")
            for pin in children(unit, "pin")
        }
        for shape in shapes
    }


@pytest.mark.slow_cases
@every
def test_the_nets_are_those_of_the_circuit(drawn: Drawn, board: tuple[str, str]) -> None:
    _, placed, sheet = drawn(board)
    wanted = defaultdict(set)
    for part in placed.components:
        for pad, net in part.nets:
            wanted[net].add(f"{part.ref}.{pad}")
    assert read_sheet(sheet).nets == dict(wanted)


@pytest.mark.slow_cases
@every
def test_no_text_is_over_another_a_symbol_or_a_wire(drawn: Drawn, board: tuple[str, str]) -> None:
    assert overlaps(drawn(board)[2]) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        (r'("Value" "10uF" \(id 1\) \(at) \S+ \S+', r"\1 {x} {y}", "value of C1 over body of U1"),
        (r'("Reference" "C1" \(id 0\) \(at) \S+ \S+', r"\1 {x} {y}", "reference of C1 over"),
        (r'("Value" ")10uF', r"\g<1>10uF of a long name, 25 V", "value of C1 over"),
        (r'(\(text "Headers" \(at) \S+ \S+', r"\1 {x} {y}", "text Headers"),
    ],
)
def test_a_text_that_collides_is_found(
    drawn: Drawn, tmp_path: Path, old: str, new: str, found: str
) -> None:
    _, _, sheet = drawn(("published", "flange"))
    text = sheet.read_text(encoding="utf-8")
    x, y = re.search(r'"lumitip:Regulator_U1"\)\s+\(at (\S+) (\S+)', text).groups()  # type: ignore[union-attr]
    damaged = tmp_path / sheet.name
    changed, count = re.subn(old, new.format(x=x, y=y), text, count=1)
    damaged.write_text(changed, encoding="utf-8")
    assert count == 1
    assert any(found in text for text in overlaps(damaged)), overlaps(damaged)


@pytest.mark.slow
def test_each_block_has_its_title(drawn: Drawn) -> None:
    path = ["Contacts of the tool", "Reverse supply and plug-in"]
    buck, linear = "Buck regulator 24 V to 5 V", "Linear regulator 5 V to 3.3 V"
    wires, last = ["To the receiver", "To the emitter"], ["Test points", "Power flags"]
    flange = _titles(drawn(("published", "flange"))[2])
    assert [t for t in flange if "open" not in t] == [*path, buck, "Headers", *last]
    whole = _titles(drawn(("integrated", "flange"))[2])
    pins = "Protection of the pins"
    module = ["Controller: Raytac MDBT50Q", "Headers", *wires, "USB", "Debugger", *last]
    assert [t for t in whole if "open" not in t] == [
        *path,
        buck,
        "Power LED",
        linear,
        pins,
        *module,
    ]
    simple = _titles(drawn(("five volts", "flange"))[2])
    assert [t for t in simple if "open" not in t] == [*path, "Power LED", "Headers", *last]
    breakout = _titles(drawn(("published", "breakout"))[2])
    assert breakout == ["Controller", *wires, "From the supply", "Power flags"]


@pytest.mark.slow
def test_pins_have_their_types(drawn: Drawn) -> None:
    types = _types(drawn(("integrated", "flange"))[2])
    assert types["Regulator_U1"] == {
        **{"VIN": "power_in", "GND": "power_in", "EN": "input", "FB": "input"},
        **{"SW": "output", "BST": "passive"},
    }
    assert types["Regulator_U3"] == {"IN": "power_in", "GND": "power_in", "OUT": "power_out"}
    module = types["Module_U2"]
    assert {module[name] for name in ("VDD", "VDDH", "VBUS", "GND")} == {"power_in"}
    assert (module["A2"], module["SWDCLK"], module["USB_DM"]) == (
        *("bidirectional", "input", "bidirectional"),
    )
    assert types["Transistor_Q1"] == {"G": "input", "S": "passive", "D": "passive"}
    assert _types(drawn(("published", "receiver"))[2])["Phototransistor"]["C"] == "open_collector"
    socket = _types(drawn(("published", "breakout"))[2])["Socket_J1"]
    assert (socket["3V3"], socket["VIN"], socket["A0"]) == (
        *("power_out", "power_in", "bidirectional"),
    )


@pytest.mark.slow_cases
@pytest.mark.parametrize("board", AUXILIARY, ids="-".join)
def test_what_is_ordered_has_its_numbers(drawn: Drawn, board: tuple[str, str]) -> None:
    """And the address of its data sheet, or of a page that leads to it."""
    _, placed, sheet = drawn(board)
    parts = {part.ref: part for part in placed.components if part.nets}
    for symbol in children(read_nodes(sheet), "symbol"):
        fields = _properties(symbol)
        part = parts.get(fields["Reference"])
        assert fields["Datasheet"] == (part.data_page if part else "")
        if part is None or not part.part:
            assert fields.keys().isdisjoint({"MPN", "Manufacturer", "LCSC"})
        else:
            assert (fields["MPN"], fields["Manufacturer"]) == (part.part, part.manufacturer)
            assert fields.get("LCSC", "") == part.lcsc
            assert not part.lcsc or part.lcsc in fields["Datasheet"] or part.datasheet
    if board in (("published", "flange"), ("../fingertip", "flange")):
        assert any(part.kind == "regulator" and part.datasheet for part in parts.values())


@pytest.mark.slow
def test_the_title_block_has_date_revision_and_hash_of_the_design(drawn: Drawn) -> None:
    """The date is written in the parameter file: the same file gives the same bytes on each day."""
    design, placed, sheet = drawn(("published", "flange"))
    block = child(read_nodes(sheet), "title_block") or []
    assert words(child(block, "rev")) == [placed.revision]
    assert words(child(block, "comment")) == ["1", f"Design {placed.design_hash}"]
    assert words(child(block, "date")) == [design.title.date]
    assert re.fullmatch(r"\d{4}-\d\d-\d\d", design.title.date)
    assert schematic_files(placed, design) == schematic_files(placed, design)


@needs("kicad-cli")
@pytest.mark.slow
@pytest.mark.parametrize("preset", ["published", "integrated"])
def test_parts_in_another_order_are_drawn_by_themselves(
    drawn: Drawn, kicad: Callable[..., str], tmp_path: Path, preset: str
) -> None:
    """Blocks begin with fuse, regulator and module; a further board may have any other parts."""
    design, placed, sheet = drawn((preset, "flange"))
    folder = Path(shutil.copytree(sheet.parent, tmp_path / "other"))
    parts = tuple(reversed(placed.components))
    for path, data in schematic_files(replace(placed, components=parts), design).items():
        (folder / path).write_bytes(data)
    other = folder / sheet.name
    assert "Other parts" in _titles(other)
    assert read_sheet(other).nets == read_sheet(sheet).nets
    assert overlaps(other) == []
    assert _violations(other, kicad, tmp_path) == []


@needs("kicad-cli")
@pytest.mark.slow
@every
def test_kicads_rules_find_nothing(
    drawn: Drawn, kicad: Callable[..., str], tmp_path: Path, board: tuple[str, str]
) -> None:
    assert _violations(drawn(board)[2], kicad, tmp_path) == []


@needs("kicad-cli")
@pytest.mark.slow
@pytest.mark.parametrize(
    ("pattern", "new", "kind"),
    [
        (
            r'  \(symbol\n    \(lib_id "lumitip:PWR_FLAG"\)[\s\S]*?\n  \)\n',
            "",
            "power_pin_not_driven",
        ),
        (r"\(pin input", "(pin output", "pin_to_pin"),
        (r"  \(wire .*\n", "", "pin_not_connected"),
    ],
)
def test_a_wrong_circuit_is_found(
    drawn: Drawn, kicad: Callable[..., str], tmp_path: Path, pattern: str, new: str, kind: str
) -> None:
    sheet = drawn(("published", "flange"))[2]
    folder = Path(shutil.copytree(sheet.parent, tmp_path / "damaged"))
    text = sheet.read_text(encoding="utf-8")
    changed, count = re.subn(pattern, new, text)
    assert count
    (folder / sheet.name).write_text(changed, encoding="utf-8")
    found = _violations(folder / sheet.name, kicad, tmp_path)
    assert (kind, "error") in found, found


def _violations(sheet: Path, kicad: Callable[..., str], tmp: Path) -> list[tuple[str, str]]:
    report = tmp / "erc.json"
    kicad("kicad-cli", "sch", "erc", "--severity-all", "--format", "json", "-o", report, sheet)
    read = json.loads(report.read_text(encoding="utf-8"))
    return [(v["type"], v["severity"]) for page in read["sheets"] for v in page["violations"]]
