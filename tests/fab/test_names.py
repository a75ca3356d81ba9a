"""Names of any script: as they are written where the medium has their letters, else in ASCII."""

import io
import unicodedata
from collections.abc import Callable
from pathlib import Path

import pypdfium2
import pytest
from pydantic import TypeAdapter, ValidationError
from reportlab.pdfbase.pdfmetrics import getFont

from lumitip_fab.boards.spice import simulation
from lumitip_fab.checks import firmware
from lumitip_fab.config.load import Input
from lumitip_fab.config.sections import DEVICE_BYTES, DeviceName, Text
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.docs.wiring import wiring_files
from lumitip_fab.firmware.files import firmware_files
from lumitip_fab.mask.note import mask_files
from lumitip_fab.text import LONGEST, PAGE_LETTERS, board_name, page_letters, page_name
from lumitip_fab.typeface import BOLD, PLAIN, load_typeface

NAMES = {
    "Палец левый": ("Палец левый", "Palets levyy"),
    "Δάχτυλο": ("Δάχτυλο", "Dachtylo"),
    "指尖传感器": ("ZhiJianChuanGanQi", "ZhiJianChuanGanQi"),
    "😀 tip": (":grinning: tip", ":grinning: tip"),
    "Größe № 7": ("Größe No 7", "Grosse No 7"),
    "plain 2": ("plain 2", "plain 2"),
}
_TEXT, _DEVICE = TypeAdapter(Text), TypeAdapter(DeviceName)


@pytest.fixture(params=NAMES)
def named(
    request: pytest.FixtureRequest, inputs: dict[str, Input], vary: Callable[..., Input]
) -> Design:
    """The published design by another name, derived."""
    return derive(vary(inputs["published"], {"name": request.param}))


def test_a_name_of_any_script_is_kept_and_has_a_form_for_every_medium(named: Design) -> None:
    title = named.title
    assert title.name in NAMES
    assert (title.on_pages().name, title.on_boards().name) == NAMES[title.name]
    assert title.on_boards().revision == title.revision


def test_drawings_of_the_mask_and_the_cables_show_it(named: Design) -> None:
    d = named
    made = mask_files(d, d.receiver)
    pdf = next(a for a in made if a.path.endswith(".pdf"))
    page = pypdfium2.PdfDocument(io.BytesIO(pdf.data))[0]
    assert f"{NAMES[d.title.name][0]} A" in page.get_textpage().get_text_range()
    svg = next(a for a in made if a.path.endswith(".svg")).data.decode()
    assert f"<title>{d.title.name} A" in svg
    wiring = {a.path: a.data.decode() for a in wiring_files(d)}
    assert f"<title>{d.title.name} A: wiring</title>" in wiring["wiring/wiring.svg"]
    assert f">{NAMES[d.title.name][0]} A: wiring</text>" in wiring["wiring/wiring.svg"]


def test_every_letter_that_pages_keep_is_in_their_typefaces() -> None:
    load_typeface()
    letters = {
        code
        for first, last in PAGE_LETTERS
        for code in range(first, last + 1)
        if unicodedata.category(chr(code)) != "Cn"
    }
    for face in (PLAIN, BOLD):
        lacking = letters - set(getFont(face).face.charToGlyph)
        assert not lacking, [f"{code:04X}" for code in sorted(lacking)]


@pytest.mark.parametrize("text", ["é", "e\u0301"])
def test_both_ways_to_write_an_accent_look_alike(text: str) -> None:
    assert (page_name(text), board_name(text)) == ("é", "e")


def test_a_long_name_is_cut_where_it_grows() -> None:
    name = "传" * LONGEST
    assert _TEXT.validate_python(name) == name
    assert len(board_name(name)) <= LONGEST
    assert board_name(name).startswith("ChuanChuan")


@pytest.mark.parametrize(
    "text",
    [
        "a\tb",
        "a\x7fb",
        "\u202eb",
        "a\u2066b",
        "a\u200bb",
        "\ufeffb",
        "a\u2028b",
        "\ue000",
        "\U000e0041",
        "a\x85b",
    ],
)
def test_what_cannot_be_seen_is_refused_with_its_number(text: str) -> None:
    hidden = next(c for c in text if c not in "ab")
    for kind in (_TEXT, _DEVICE):
        with pytest.raises(ValidationError, match=f"U\\+{ord(hidden):04X} "):
            kind.validate_python(text)


def test_emoji_of_several_parts_are_names() -> None:
    assert _TEXT.validate_python("👩‍🚀") == "👩‍🚀"


def test_a_bluetooth_name_is_measured_in_bytes() -> None:
    assert len("Палец Палец Па".encode()) == 26
    assert _DEVICE.validate_python("Палец Палец Па")
    assert _DEVICE.validate_python("L" * DEVICE_BYTES)
    with pytest.raises(ValidationError, match="32 bytes of UTF-8; a Bluetooth name has at most 29"):
        _DEVICE.validate_python("Палец Палец Палец"[:17])


def test_a_netlist_is_in_ascii(named: Design) -> None:
    d = named
    (made,) = simulation(d, d.emitter)
    assert made.data.isascii()
    assert made.data.decode().startswith(f"* {NAMES[d.title.name][1]}, emitter")


@pytest.mark.parametrize("name", ["Палец левый", "指尖传感器", '😀 "7"? \\1'])
def test_the_check_reads_a_bluetooth_name_as_a_compiler_does(
    name: str, inputs: dict[str, Input], vary: Callable[..., Input], tmp_path: Path
) -> None:
    d = derive(vary(inputs["published"], {"controller.name": name}))
    (tmp_path / "firmware").mkdir()
    for made in firmware_files(d):
        (tmp_path / made.path).write_bytes(made.data)

    def passed() -> bool:
        (found,) = (m for m in firmware.measure(tmp_path, d) if m.check == "firmware.name")
        return bool(found.passed)

    assert passed()
    header = tmp_path / "firmware" / "protocol.h"
    text = header.read_text(encoding="ascii")
    header.write_text(text.replace('_NAME "', '_NAME "\\320'), encoding="ascii")
    assert not passed()


def test_a_page_keeps_all_other_letters_of_a_text() -> None:
    text = "90 °C → 24 V ± 5 %, ≥ 3 µm, 1 Ω – “x” … × 2\nnext"
    assert page_letters(text) == text
    assert page_letters("指 ≥ 3\n") == "Zhi ≥ 3\n"
