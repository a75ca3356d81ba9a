"""Damage one form of a manual, and exactly the right checks fail."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pikepdf
import pytest

from active_pages import ACTIVE, added
from damages import cut_short, edit
from lumitip_fab.checks import manual_pages
from lumitip_fab.docs.page import html_page
from lumitip_fab.docs.sheet import pdf_sheets
from lumitip_fab.pipeline.artefact import Files

HTML, PDF, DRAWING = "manual/manual.html", "manual/manual.pdf", "manual/work.svg"
NOTE = "mould/emitter_casting.md"
NAME = '😀 Größe № 7 "quoted" it\'s Палец 指尖'
SVG = """\
<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="50mm" viewBox="0 0 100 50">
<g font-size="4" font-family="Helvetica"><text x="60" y="10">right, above</text>
<text x="10" y="40" transform="rotate(30 10 40)">turned <tspan dx="3">part</tspan> 5 µm</text>
<text x="5" y="10">left</text></g></svg>
"""
ROWS = "\n".join(f"| W{i} | Ø{i} mm ≥ ½ | plug-in, -{i}.5 °C | |" for i in range(100))
TEXT = f"""\
# {NAME}: build manual

## 1. ﬁrst ﬂow

{"plug-in hyphen-ated words-that-are-long and pre-heated " * 40}

| wire | size | where | none |
|---|---|---:|---|
{ROWS}

Wash your hands.

- one **bold** `code/file_name.stl`
  1. inner
  2. inner two

3. three at 2.5 °C, for 24 h, as the note says
4. four “curly” ‘single’ … 1⁄2 × 3 → 5 − 3

## 2. More

![A caption](manual/work.svg)

![left](manual/work.svg) ![right](manual/work.svg)

After. http://example.com/long_url-with-{"hyphens-" * 30}end {"y" * 200}
"""
NOTED = """# Casting

| wire | size | where | none |
|---|---|---:|---|

Wash your hands.

3. three at 2.5 °C, for 24 h, as the note says
4. Another one of 7 mm

## More
"""
Damage = Callable[[Path], None]


def write(folder: Path, text: str = TEXT, svg: str = SVG) -> None:
    """A manual in both forms, with its drawing."""
    for path in ("manual", "mould"):
        (folder / path).mkdir(parents=True, exist_ok=True)
    (folder / NOTE).write_text(NOTED, encoding="utf-8")
    (folder / DRAWING).write_text(svg, encoding="utf-8")
    files = Files(folder, {DRAWING: None})  # type: ignore[dict-item]
    (folder / HTML).write_text(html_page(NAME, text, files), encoding="utf-8")
    (folder / PDF).write_bytes(pdf_sheets(NAME, text, files))


def failing(folder: Path) -> set[str]:
    design = SimpleNamespace(fingers=(), flanges=())  # whose drawings are none of this manual
    found = manual_pages.measure(folder, design)  # type: ignore[arg-type]
    return {m.check.removeprefix("manual_pages.") for m in found if not m.passed}


def html(old: str, new: str = "") -> Damage:
    return lambda folder: edit(folder / HTML, old, new)


def pdf(change: Callable[[pikepdf.Pdf], None]) -> Damage:
    def damage(folder: Path) -> None:
        with pikepdf.open(folder / PDF, allow_overwriting_input=True) as document:
            change(document)
            document.save(folder / PDF)

    return damage


def pdf_of(old: str, new: str) -> Damage:
    """The PDF of another text or drawing."""

    def damage(folder: Path) -> None:
        kept = (folder / HTML).read_bytes()
        write(folder, TEXT.replace(old, new), SVG.replace(old, new))
        (folder / HTML).write_bytes(kept)
        (folder / DRAWING).write_text(SVG, encoding="utf-8")

    return damage


DAMAGES: dict[str, tuple[Damage, set[str]]] = {
    "number changed": (html("2.5 °C, ", "25 °C, "), {"notes", "words"}),
    "number of a note changed": (
        lambda folder: edit(folder / NOTE, "24 h", "12 h"),
        {"notes"},
    ),
    "unit of a note changed": (lambda folder: edit(folder / NOTE, "24 h", "24 min"), {"notes"}),
    "column of a note renamed": (
        lambda folder: edit(folder / NOTE, "| size |", "| length |"),
        {"labels"},
    ),
    "heading of a note renamed": (
        lambda folder: edit(folder / NOTE, "## More", "### Less"),
        {"labels"},
    ),
    "line of a note twice": (
        lambda folder: edit(folder / NOTE, "Wash your hands.", "Wash your hands.\n\n" * 2),
        {"lines"},
    ),
    "line of a note moved": (
        lambda folder: (folder / NOTE).write_text(
            NOTED.replace("Wash your hands.\n\n", "") + "\nWash your hands.\n", encoding="utf-8"
        ),
        {"lines"},
    ),
    "note unreadable": (lambda folder: (folder / NOTE).write_bytes(b"\xff"), {"notes"}),
    "sign changed": (html("≥ ½", "≤ ½"), {"words"}),
    "cell changed": (html("<td>W7</td>", "<td>W</td>"), {"words"}),
    "word left out": (html("and pre-heated"), {"words"}),
    "third of a passage left out": (
        html("plug-in hyphen-ated words-that-are-long and pre-heated " * 13),
        {"words"},
    ),
    "row left out": (html("<td>W50</td>\n<td>Ø50 mm ≥ ½</td>"), {"words"}),
    "last passage left out": (html("y" * 200), {"words"}),
    "chapter twice": (html("<h2>2. More", "<h2>1. More"), {"chapters", "words"}),
    "no chapters": (lambda folder: write(folder, "# None"), {"chapters", "labels", "pictures"}),
    "item numbered anew": (html('<ol start="3">', "<ol>"), {"notes", "words"}),
    "HTML cut short": (
        lambda folder: cut_short(folder / HTML, 6000),
        {"labels", "pictures", "words"},
    ),
    "HTML missing": (lambda folder: (folder / HTML).unlink(), {"readable"}),
    "drawing broken": (html("base64,", "base64,A"), {"readable"}),
    "drawing of another name": (html("manual/work.svg", "manual/other.svg"), {"pictures"}),
    "drawing changed": (lambda folder: edit(folder / DRAWING, "left", "right"), {"pictures"}),
    "drawing not shown": (
        lambda folder: (folder / "manual/more.svg").write_text(SVG, encoding="utf-8"),
        {"pictures"},
    ),
    "link to nowhere": (html("After.", '<a href="#more">After.</a>'), {"links"}),
    "file that is lost": (html("After.", '<a href="more.pdf">After.</a>'), {"links"}),
    "PDF of another drawing": (pdf_of("5 µm", "6 µm"), {"words"}),
    "PDF of another number": (pdf_of("-77.5", "-78.5"), {"words"}),
    "PDF with more": (pdf_of("## 2.", "Never do this.\n\n## 2."), {"words"}),
    "PDF with more at its end": (pdf_of("After.", "After. " + "z" * 40), {"words"}),
    "page lost": (pdf(lambda document: document.pages.__delitem__(1)), {"pages", "words"}),
    "last page lost": (pdf(lambda document: document.pages.__delitem__(-1)), {"words"}),
    "page twice": (
        pdf(lambda document: document.pages.append(document.pages[0])),
        {"pages", "words"},
    ),
    "pages swapped": (pdf(lambda document: document.pages.reverse()), {"pages", "words"}),
    "PDF cut short": (lambda folder: cut_short(folder / PDF), {"readable"}),
    **{change.__name__: (added(PDF, change), {"readable"}) for change in ACTIVE},
    "PDF missing": (lambda folder: (folder / PDF).unlink(), {"readable"}),
}


def test_both_forms_agree(tmp_path: Path) -> None:
    write(tmp_path)
    with pikepdf.open(tmp_path / PDF) as document:
        assert len(document.pages) > 3
    assert failing(tmp_path) == set()


def test_links_that_lead_somewhere_pass(tmp_path: Path) -> None:
    write(tmp_path)
    links = ("#end", "manual.pdf", "https://example.com/x")
    linked = "".join(f'<a href="{to}"></a>' for to in links)
    edit(tmp_path / HTML, "After.", f'<i id="end"></i>{linked}After.')
    assert failing(tmp_path) == set()


@pytest.mark.slow_cases
@pytest.mark.parametrize("name", DAMAGES)
def test_damage_fails_exactly(name: str, tmp_path: Path) -> None:
    damage, expected = DAMAGES[name]
    write(tmp_path)
    damage(tmp_path)
    assert failing(tmp_path) == expected
