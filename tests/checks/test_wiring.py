"""Damage list, note or diagram of the cables, and exactly the right checks fail."""

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from damages import excerpt
from damages import failing as failing_of
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.docs.wiring import wiring_files
from lumitip_fab.errors import InputError

pytestmark = pytest.mark.slow

Edit = Callable[[str], str]
LIST, NOTE, DIAGRAM = "cables.csv", "cables.md", "wiring.svg"


@pytest.fixture
def copied(outputs: Path, tmp_path: Path) -> Path:
    """What the check reads, of the published design, to damage."""
    return excerpt(outputs, tmp_path / "wired", "wiring", "boards", "firmware/layout.h")


def failing(folder: Path) -> set[str]:
    return failing_of(folder, "wiring")


def replaced(old: str, new: str) -> Edit:
    def edit(text: str) -> str:
        assert old in text
        return text.replace(old, new, 1)

    return edit


def swapped(one: str, other: str) -> Edit:
    def edit(text: str) -> str:
        assert one in text
        assert other in text
        return text.replace(one, "\0").replace(other, one).replace("\0", other)

    return edit


def without(pattern: str) -> Edit:
    def edit(text: str) -> str:
        less = re.sub(pattern, "", text, count=1, flags=re.MULTILINE | re.DOTALL)
        assert less != text
        return less

    return edit


def lengthened(text: str) -> str:
    """With a wire of an analog signal that has more capacitance than the firmware waits for."""
    longer = re.sub(r"^(W2\.\d+,A0,.*,0\.08,)260,", r"\g<1>320,", text, count=1, flags=re.MULTILINE)
    assert longer != text
    return longer


EDITS: list[tuple[str, Edit, set[str]]] = [
    # Two wires swapped at one end, in each file.
    (LIST, swapped("breakout,J5.3,", "breakout,J5.4,"), {"ends", "pins", "note", "diagram"}),
    (NOTE, swapped("| J5.3 |", "| J5.4 |"), {"note"}),
    (DIAGRAM, swapped('id="breakout.J5.3"', 'id="breakout.J5.4"'), {"diagram", "texts"}),
    # A wire dropped.
    (LIST, without(r"^W2\.7,.*?\n"), {"ends", "pins", "note", "diagram"}),
    (LIST, without(r"^W3\.2,.*?\n"), {"contacts", "ends", "note", "diagram"}),
    (NOTE, without(r"^\| W1\.2 .*?\n"), {"note"}),
    (DIAGRAM, without(r'^<g class="wire" id="W2\.9".*?</g>\n'), {"diagram", "texts"}),
    # What is told of a wire.
    (LIST, replaced("W2.2,", "W2.1,"), {"ends", "note", "diagram"}),
    (LIST, replaced("S0,receiver,J1.3", "S0,receiver,J1.4"), {"ends", "note", "diagram"}),
    (LIST, replaced("J6.1,BK", "J6.1,RD"), {"colours", "note", "diagram"}),
    (LIST, replaced("J6.2,RD", "J6.2,BU"), {"colours", "note", "diagram"}),
    (LIST, replaced("J5.5,GN", "J5.5,YE"), {"colours", "note", "diagram"}),
    (LIST, replaced("J5.5,GN", "J5.5,XX"), {"colours", "marks", "note", "diagram"}),
    (LIST, replaced("BK,0.08,270", "BK,0.08,150"), {"lengths", "note", "texts"}),
    (LIST, replaced("BK,0.08,270", "BK,0.08,300"), {"lengths", "note", "texts"}),
    (LIST, lengthened, {"capacitance", "lengths", "note", "texts"}),
    (LIST, replaced("RD,0.08,270", "RD,0.02,270"), {"density", "note", "texts"}),
    (LIST, replaced("RD,0.08,270,83.00", "RD,0.08,270,34.10"), {"current", "note", "texts"}),
    (LIST, replaced("RD,0.08,340,", "RD,0.0005,340,"), {"density", "drop", "note", "texts"}),
    (LIST, replaced("RD,0.08,340,", "RD,0,340,"), {"readable"}),
    (LIST, replaced("colour,", "color,"), {"readable"}),
    (NOTE, replaced("| 83.00 |", "| 96.23 |"), {"note"}),
    (NOTE, replaced("breakout, 270 mm", "breakout, 520 mm"), {"note"}),
    (NOTE, replaced("| RD red", "| BU blue"), {"note"}),
    (NOTE, replaced("| BK black", "| BK red"), {"note"}),
    (NOTE, swapped("to contact 9", "to contact 5"), {"contacts"}),
    (NOTE, replaced("header J3:", "header J2:"), {"contacts"}),
    (NOTE, replaced("W3.1 goes to contact 5, ", ""), {"contacts"}),
    (NOTE, replaced("W3.1 goes to contact 5", "W3.1 goes to 9"), {"contacts", "named"}),
    (NOTE, replaced("white, marked pink", "black, marked red"), {"marks"}),
    (NOTE, replaced("W3.3 white", "W3.2 white"), {"marks"}),
    (NOTE, replaced("in the set of 10", "in the set of 12"), {"marks"}),
    (NOTE, replaced("\n- Measure", "\n- Cut W2.9 off.\n- Measure"), {"named"}),
    (DIAGRAM, replaced(">W1.2 RD", ">W1.2 BK"), {"diagram"}),
    (DIAGRAM, replaced('stroke="#d11f2e"', 'stroke="#1a1a1a"'), {"diagram"}),
    (DIAGRAM, replaced("</svg>", ""), {"diagram"}),
    (DIAGRAM, swapped(">GND</text></g>\n", ">24V</text></g>\n"), {"texts"}),
    (DIAGRAM, swapped(">Emitter</text>", ">Receiver</text>"), {"texts"}),
    (DIAGRAM, swapped(">J5</text>", ">J6</text>"), {"texts"}),
    (DIAGRAM, swapped(">W1</text>", ">W3</text>"), {"texts"}),
    (DIAGRAM, replaced(">270 mm, ", ">150 mm, "), {"texts"}),
    (DIAGRAM, replaced("83 mA", "38 mA"), {"texts"}),
]


def test_nothing_fails_as_it_is_written(copied: Path) -> None:
    assert failing(copied) == set()


@pytest.mark.parametrize(("file", "edit", "expected"), EDITS)
def test_a_damage_fails_its_check(copied: Path, file: str, edit: Edit, expected: set[str]) -> None:
    path = copied / "wiring" / file
    path.write_text(edit(path.read_text(encoding="utf-8")), encoding="utf-8")
    assert failing(copied) == expected


def test_a_net_or_a_pin_on_another_lead_is_seen(copied: Path) -> None:
    board = copied / "boards/receiver/receiver.kicad_pcb"
    text = board.read_text(encoding="utf-8")
    board.write_text(swapped('"A0"', '"A1"')(text), encoding="utf-8")
    assert failing(copied) == {"ends", "pins"}
    board.write_text(text, encoding="utf-8")
    header = copied / "firmware/layout.h"
    told = header.read_text(encoding="utf-8")
    header.write_text(replaced("A0, A1", "A1, A0")(told), encoding="utf-8")
    assert failing(copied) == {"pins"}
    header.write_text(replaced("PINS 6, 7", "PINS 7, 6")(told), encoding="utf-8")
    assert failing(copied) == {"pins"}


def test_a_supply_beside_a_line_to_the_controller_is_seen(copied: Path) -> None:
    """Pads of the cable from the flange exchanged: a bridge of solder would lead 24 V to 5 V."""
    file = copied / "boards/breakout/breakout.kicad_pcb"
    text = file.read_text(encoding="utf-8")
    begin = text.index('(fp_text reference "J7"')
    before, row = text[:begin], text[begin:]
    (ground, supply) = (re.search(rf'\(net \d+ "{name}"\)', row)[0] for name in ("GND", "5V"))
    row = row.replace(ground, "\0", 1).replace(supply, ground, 1).replace("\0", supply, 1)
    file.write_text(before + row, encoding="utf-8")
    assert failing(copied) == {"ends", "neighbours"}


def test_a_multiplexer_without_a_pad_is_seen(copied: Path) -> None:
    board = copied / "boards/receiver/receiver.kicad_pcb"
    text = board.read_text(encoding="utf-8")
    start = text.index('"U1"')
    pad = re.compile(r'\(pad "?16"? .*?(?=\(pad |\(model )', re.DOTALL)
    less = pad.sub("", text[start:], count=1)
    assert less != text[start:]
    board.write_text(text[:start] + less, encoding="utf-8")
    assert "pins" in failing(copied)


def test_lost_files_are_told(copied: Path) -> None:
    (copied / "wiring" / NOTE).unlink()
    (copied / "wiring" / DIAGRAM).write_bytes(b"\xff\xfe")
    assert failing(copied) == {"note", "diagram"}
    (copied / "firmware/layout.h").unlink()
    assert failing(copied) == {"pins", "note", "diagram"}
    (copied / "boards/breakout/breakout.kicad_pcb").unlink()
    assert failing(copied) == {"readable"}


def _designed(design_dir: Path, tmp_path: Path, text: str) -> Path:
    folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
    file = folder / "presets" / "changed.toml"
    file.write_text('extends = "published.toml"\n' + text, encoding="utf-8")
    return file


def test_without_a_breakout_the_wires_go_to_the_pins(design_dir: Path, tmp_path: Path) -> None:
    file = _designed(design_dir, tmp_path, "[breakout]\nenabled = false\n")
    design = derive(load(file))
    emitter, receiver = design.cabling.cables
    assert [w.end.label for w in emitter.wires] == ["GND", "24V"]
    assert {w.signal: w.end.label for w in receiver.wires} == {
        "GND": "GND",
        "3V3": "3V3",
        "S0": "D6",
        "S1": "D7",
        "S2": "D8",
        "A0": "A0",
        "A1": "A1",
        "A2": "A2",
        "A3": "A3",
    }
    assert emitter.length_mm > receiver.length_mm
    svg = wiring_files(design)[2].data.decode()
    assert svg.count('class="wire"') == 11


def test_what_carries_more_current_is_thicker(design_dir: Path, tmp_path: Path) -> None:
    text = "[wiring]\nsupply_mm = 10000.0\nsection_mm2 = 0.05\n"
    emitter, receiver, supply = derive(load(_designed(design_dir, tmp_path, text))).cabling.cables
    assert (emitter.section_mm2, receiver.section_mm2, supply.section_mm2) == (0.08, 0.05, 0.14)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            "[wiring]\nsection_mm2 = 1.0\n",
            "is 1; the holes of 1.2 mm .* strands of at most 0.718 mm²",
        ),
        (
            "[wiring]\nsupply_mm = 1e4\n[emitter]\nstring_leds = 1\n"
            "[supply]\nvoltage_v = 2.5\nmax_ma = 5e3\n",
            "is 0.08; .* is needed for .* Reduce emitter.current_ma.",
        ),
    ],
)
def test_wires_too_thick_are_refused(
    design_dir: Path, tmp_path: Path, text: str, told: str
) -> None:
    with pytest.raises(InputError, match=told):
        derive(load(_designed(design_dir, tmp_path, text)))


def test_a_cable_of_many_wires_has_striped_ones(design_dir: Path) -> None:
    cables = derive(load(design_dir / "presets" / "dense.toml")).cabling.cables
    colours = [wire.colour for wire in cables[1].wires]
    assert len({*colours}) == len(colours)
    assert any(len(colour) == 4 for colour in colours)
    numbers = [wire.number for cable in cables for wire in cable.wires]
    assert len({*numbers}) == len(numbers)
