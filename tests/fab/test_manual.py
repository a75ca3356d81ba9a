"""The manual has the design's figures and drawings; each comparison sees a damage."""

import re
from collections.abc import Callable
from pathlib import Path

import pikepdf
import pytest

from damages import edit, excerpt
from lumitip_fab.design.encoding import read_design
from manual_figures import measure
from manual_reader import read_pdf

pytestmark = pytest.mark.slow

_NEEDED = (
    "assembly",
    "backing",
    "boards",
    "firmware",
    "fit",
    "flange",
    "gauge",
    "holder",
    "manual",
    "mask",
    "mould",
    "print",
    "wiring",
)
ROOT = Path(__file__).parents[2]
HTML, PDF = "manual/manual.html", "manual/manual.pdf"


@pytest.fixture
def copied(outputs: Path, tmp_path: Path) -> Path:
    """The manual of the published design and all that it names, to damage."""
    return excerpt(outputs, tmp_path / "copy", "bom.csv", *_NEEDED)


def failing(folder: Path) -> set[str]:
    found = measure(folder, read_design(folder / "design.json"))
    return {m.check.removeprefix("manual.") for m in found if not m.passed}


# What is replaced in the HTML, by what, and the checks that then fail: the PDF says it still.
EDITS = [
    ("<td>24 h</td>", "<td>12 h</td>", {"figures", "units", "pdf"}),
    ("Leave it for 24 h", "Leave it for 7 h", {"units", "pdf"}),
    ("alone to 90 °C", "alone to 190 °C", {"units", "pdf"}),
    ("<td>24 V</td>", "<td>5 V</td>", {"figures"}),
    ("<td>1 x M5 x 12</td>", "<td>1 x M4 x 12</td>", {"figures", "pdf"}),
    ("<td>warm-up</td>", "<td>cool-down</td>", {"figures", "pdf"}),
    ("<code>fit/fit_plate.3mf</code>", "<code>fit/plate.3mf</code>", {"files", "pdf"}),
    ('data-file="wiring/wiring.svg"', 'data-file="wiring/cables.svg"', {"drawings"}),
    ('data-file="manual/mounted.svg"', 'data-file="assembly/robot.svg"', {"drawings"}),
    ("2.53 g", "3.53 g", {"amounts", "pdf"}),
    ("<td>W2.3</td>", "<td>W2.4</td>", {"wires"}),
    ("<td>used by one pair of fingers</td>", "<td>altogether</td>", {"parts", "pdf"}),
]


PRESETS = sorted(file.stem for file in (ROOT / "design/presets").glob("*.toml"))


@pytest.mark.parametrize("preset", PRESETS)
def test_the_manual_of_a_preset_agrees_with_its_design(
    built: Callable[[str], Path], preset: str
) -> None:
    assert failing(built(preset)) == set()


@pytest.mark.parametrize(("old", "new", "expected"), EDITS)
def test_a_damage_fails_its_check(copied: Path, old: str, new: str, expected: set[str]) -> None:
    edit(copied / HTML, old, new)
    assert failing(copied) == expected


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        ("manual/lowered.svg", "mm", "cm", {"drawings"}),
        ("mould/receiver_casting.md", "part A | **", "part A | **1", {"amounts"}),
        ("wiring/cables.md", "| W1.2 | RD red", "| W1.2 | BU blue", {"wires"}),
        ("wiring/wiring.svg", "Emitter", "Radiator", {"drawings"}),
        ("bom.csv", "Solaris", "Lunaris", {"parts"}),
    ],
)
def test_a_manual_of_another_build_is_seen(
    copied: Path, file: str, old: str, new: str, expected: set[str]
) -> None:
    edit(copied / file, old, new)
    assert failing(copied) == expected


def test_a_picture_of_another_board_is_seen(copied: Path) -> None:
    other = (copied / "boards/receiver/receiver_back.png").read_bytes()
    (copied / "boards/emitter/emitter_back.png").write_bytes(other)
    assert failing(copied) == {"drawings"}


def test_the_back_of_the_emitter_is_shown_where_parts_are_there(copied: Path) -> None:
    text = (copied / HTML).read_text(encoding="utf-8")
    back = re.compile(r'<span class="pair"><img [^>]*emitter_back.png[^>]*>.*?</span>', re.DOTALL)
    (copied / HTML).write_text(back.sub("", text, count=1), encoding="utf-8")
    assert failing(copied) == {"drawings"}


def test_a_page_that_is_lost_is_seen(copied: Path) -> None:
    with pikepdf.open(copied / PDF, allow_overwriting_input=True) as document:
        assert len(document.pages) > 6
        del document.pages[6]
        document.save(copied / PDF)
    assert failing(copied) == {"pdf"}


def test_a_font_that_is_left_out_is_seen(copied: Path) -> None:
    with pikepdf.open(copied / PDF, allow_overwriting_input=True) as document:
        font = next(iter(document.pages[0].resources.Font.values()))
        del font["/FontDescriptor"]["/FontFile2"]
        document.save(copied / PDF)
    assert failing(copied) == {"fonts"}


def test_lost_files_are_told(copied: Path) -> None:
    (copied / PDF).unlink()
    assert failing(copied) == {"pdf", "fonts"}
    (copied / HTML).write_bytes(b"\xff\xfe")
    assert failing(copied) == {"readable"}


def test_the_pdf_tells_no_day(outputs: Path) -> None:
    data = (outputs / PDF).read_bytes()
    assert b"D:20000101000000" in data
    assert not re.search(rb"D:(?!20000101)\d{8}", data)


def test_nothing_stands_twice(copied: Path) -> None:
    text = (copied / HTML).read_text(encoding="utf-8")
    blocks = re.findall(r"<(?:p|li)>(.*?)</(?:p|li)>", text, re.DOTALL)
    long = [block for block in blocks if len(block) > 60 and "<img" not in block]
    assert len(long) > 60
    assert sorted(block for block in set(long) if long.count(block) > 1) == []
    plain = (re.sub(r"<.*?>", "", block) for block in blocks)
    sentences = [" ".join(s.split()) for block in plain for s in re.split(r"(?<=[.:?]) ", block)]
    said = [sentence for sentence in sentences if len(sentence) > 32]
    assert sorted(sentence for sentence in set(said) if said.count(sentence) > 1) == []


def test_a_step_that_fits_on_a_page_is_not_broken(copied: Path) -> None:
    sheets, _ = read_pdf(copied / PDF)
    for title, end in (("Lower the finger", "the plate rocks"), ("Wrap the finger", "comes loose")):
        (page,) = [words for words in sheets if title.replace(" ", "") in words]
        assert end.replace(" ", "") in page
