"""What is written of a drawing: all of it, whatever the words, and the same each time."""

import re
import subprocess
import sys
import uuid
from collections.abc import Callable
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.boards.kicad.schematic import files, symbols
from lumitip_fab.boards.kicad.schematic.sheet import Drawn, Sheet
from lumitip_fab.boards.kicad.schematic.writer import sheet_text
from lumitip_fab.boards.kicad.sexpr import FORMAT
from lumitip_fab.boards.model import Placement
from lumitip_fab.boards.placement import place
from lumitip_fab.checks.readers.kicad_shapes import (
    Node,
    child,
    children,
    numbers,
    read_nodes,
    words,
)
from lumitip_fab.design import Component, Design, Point

WORDS = (
    'a "quoted" \\ back',
    "75 Ω",
    "",
    "100",
    "1e5",
    "007",
    "nil",
    "t",
    "yes",
    "(x) ; #1 'y' [z]",
)
Written = tuple[Placement, Sheet, dict[str, Component], Path]


@pytest.fixture
def awkward(designs: Callable[[str], Design], tmp_path: Path) -> Written:
    """A sheet with words that a reader or writer might take for something else."""
    d = designs("small")
    board = replace(place(d, d.emitter), title=WORDS[0], revision="100")
    resistor = next(part for part in board.components if part.kind == "resistor")
    sheet, parts = Sheet(), {}
    for i, told in enumerate(WORDS):
        at, ref = (25.4 + 0.127 * i, 50.8), f"R{i}"
        parts[ref] = replace(resistor, ref=ref, value=told, part=told, manufacturer=told)
        sheet.symbols.append(Drawn("R", ref, told, *at, (i % 4) * 90, ("1", told), (0.0, -1.27)))
        sheet.power("GND", at)
        sheet.texts.append((told, at, 1.5 + i))
        sheet.flag(told, at, (i % 4) * 90)
        sheet.wire(at, (25.4, 76.2), (0.0, -2.54))
        sheet.junctions.append(at)
        sheet.frames.append((at, (101.6 + i, 127.0)))
    file = tmp_path / "awkward.kicad_sch"
    shapes = {"R": symbols.hand_drawn()["R"], "GND": symbols.hand_drawn()["GND"]}
    file.write_text(sheet_text(board, "A3", sheet, shapes, parts), encoding="utf-8")
    return board, sheet, parts, file


@pytest.fixture(params=["emitter", "receiver"])
def drawn(
    designs: Callable[[str], Design],
    request: pytest.FixtureRequest,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> Written:
    """The sheet of a finger's board."""
    d = designs("small")
    finger = next(f for f in d.fingers if f.name == request.param)
    board = place(d, finger)
    sheets: list[Sheet] = []

    def told(*drawing: Any) -> str:
        sheets.extend(given for given in drawing if isinstance(given, Sheet))
        return sheet_text(*drawing)

    monkeypatch.setattr(files, "sheet_text", told)
    made = files.schematic_files(board, d)
    file = tmp_path / f"{request.param}.kicad_sch"
    file.write_bytes(made[file.name])
    return board, sheets[0], {part.ref: part for part in board.components}, file


def test_all_of_a_board_is_written(drawn: Written) -> None:
    _all_is_there(drawn)


def test_all_is_written_whatever_the_words(awkward: Written) -> None:
    _all_is_there(awkward)
    whole = read_nodes(awkward[-1])
    block = child(whole, "title_block")
    assert words(child(block, "title")) == [f"{WORDS[0]}: emitter"]
    assert words(child(block, "rev")) == ["100"]
    assert words(child(whole, "paper")) == ["A3"]
    assert numbers(child(whole, "version")) == (FORMAT,)
    named = [words(shape)[0] for shape in children(child(whole, "lib_symbols"), "symbol")]
    assert named == ["lumitip:R", "lumitip:GND"]


@pytest.mark.slow
def test_identifiers_come_from_names_alone(awkward: Written, drawn: Written) -> None:
    for *_, file in (awkward, drawn):
        text = file.read_text(encoding="utf-8")
        found = re.findall(r"\(uuid (.+?)\)", text)
        assert len(found) == text.count("(uuid ") == len(set(found))
        assert {uuid.UUID(told).version for told in found} == {5}


def test_nothing_is_said_meanwhile() -> None:
    """Nor is the library imported before a schematic is drawn."""
    program = (
        "import logging, sys, warnings; warnings.simplefilter('error')\n"
        "import lumitip_fab.boards.files\n"
        "assert 'skip' not in sys.modules\n"
        "from lumitip_fab.boards.kicad.schematic.template import Template\n"
        "logging.basicConfig(level=logging.INFO)\n"
        "page = Template()\n"
        "for kind in ('junction', 'wire', 'text', 'global_label', 'symbol', 'path'):\n"
        "    page.copy(kind), page.copy(kind)\n"
        "page.finished(())\n"
    )
    done = subprocess.run([sys.executable, "-c", program], check=False, capture_output=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")


def _all_is_there(written: Written) -> None:
    _, sheet, parts, file = written
    whole = read_nodes(file)
    assert _read(whole) == _rounded(sheet)
    for label in children(whole, "global_label"):
        assert (_at(child(label, "property")), _angle(child(label, "property"))) == (_at(label), 0)
        side = "right" if _angle(label) in (180, 270) else "left"
        assert words(child(child(label, "effects"), "justify")) == [side]
    drawn = list(children(whole, "symbol"))
    for node in drawn:
        fields = {words(field)[0]: words(field)[1] for field in children(node, "property")}
        part = parts.get(fields["Reference"])
        footprint = f"lumitip:{part.footprint.name}" if part else ""
        assert fields["Footprint"] == footprint
        assert fields["Datasheet"] == (part.data_page if part else "")
        ordered = (part.manufacturer, part.part) if part and part.part else (None, None)
        assert (fields.get("Manufacturer"), fields.get("MPN")) == ordered
        numbered = part.lcsc if part and part.part and part.lcsc else None
        assert fields.get("LCSC") == numbered
        assert words(child(node, "in_bom")) == ["no" if part and not part.part else "yes"]
        ids = [words(field)[0] for field in chain(*(children(f, "id") for f in node[1:] if f))]
        assert ids == [str(i) for i in range(len(fields))]
    entries = [
        (words(entry)[0], *words(child(entry, "reference")))
        for entry in children(child(whole, "symbol_instances"), "path")
    ]
    identifiers = [words(child(node, "uuid"))[0] for node in drawn]
    assert entries == [
        (f"/{own}", symbol.ref) for own, symbol in zip(identifiers, sheet.symbols, strict=True)
    ]


def _read(whole: Node) -> Sheet:
    """A sheet as it was drawn."""
    wires = (child(wire, "pts") for wire in children(whole, "wire"))
    around = (child(frame, "pts") for frame in children(whole, "polyline"))
    corners = [[numbers(xy) for xy in children(pts, "xy")] for pts in around]
    assert all(len(frame) == 5 and frame[0] == frame[4] for frame in corners)
    return _rounded(
        Sheet(
            [_symbol(node) for node in children(whole, "symbol")],
            [tuple(numbers(end) for end in children(pts, "xy")) for pts in wires],
            [_at(node) for node in children(whole, "junction")],
            [(words(n)[0], _at(n), _angle(n)) for n in children(whole, "global_label")],
            [(words(n)[0], _at(n), _height(n)) for n in children(whole, "text")],
            [(frame[0], frame[2]) for frame in corners],
        )
    )


def _symbol(node: Node) -> Drawn:
    (x, y), shown = _at(node), {}
    fields = {words(field)[0]: field for field in children(node, "property")}
    for name, field in fields.items():
        if "hide" not in words(child(field, "effects")):
            at = _at(field)
            shown[name] = at[0] - x, at[1] - y
            assert _height(field) == 1.27
        assert _angle(field) == _angle(node) % 180
    assert shown.keys() <= {"Reference", "Value"}
    return Drawn(
        words(child(node, "lib_id"))[0].removeprefix("lumitip:"),
        words(fields["Reference"])[1],
        words(fields["Value"])[1],
        x,
        y,
        _angle(node),
        tuple(words(pin)[0] for pin in children(node, "pin")),
        shown.get("Reference"),
        shown.get("Value"),
    )


def _at(node: Node) -> Point:
    x, y, *_ = numbers(child(node, "at"))
    return x, y


def _angle(node: Node) -> int:
    return int(numbers(child(node, "at"))[2])


def _height(node: Node) -> float:
    return numbers(child(child(child(node, "effects"), "font"), "size"))[0]


def _rounded(sheet: Sheet) -> Sheet:
    """To what the file tells, and without the count of power symbols, which is not in it."""

    def near(at: Point) -> Point:
        return round(at[0], 5), round(at[1], 5)

    return Sheet(
        [
            replace(
                s,
                x_mm=round(s.x_mm, 5),
                y_mm=round(s.y_mm, 5),
                ref_at=s.ref_at and near(s.ref_at),
                value_at=s.value_at and near(s.value_at),
            )
            for s in sheet.symbols
        ],
        [(near(start), near(end)) for start, end in sheet.wires],
        [near(at) for at in sheet.junctions],
        [(net, near(at), angle) for net, at, angle in sheet.labels],
        [(told, near(at), height) for told, at, height in sheet.texts],
        [(near(corner), near(opposite)) for corner, opposite in sheet.frames],
    )
