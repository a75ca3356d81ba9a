"""The manual's two forms say the same: every passage of the HTML stands in the PDF, in order, and
nothing else does. A passage that stands in a note too has the same numbers and units there."""

import hashlib
import math
import re
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path

from lumitip_fab.checks.notes import labels_alone, lines_misplaced
from lumitip_fab.checks.readers.manual import (
    Html,
    Passage,
    letters,
    read_html,
    read_note,
    read_sheets,
)
from lumitip_fab.checks.result import Measurement, Subject, unreadable
from lumitip_fab.checks.work_words import measure_words
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline.manifest import sha256_of

READS = (
    "manual/*",
    "*/*.md",
    "assembly/*.svg",
    "boards/*/*.png",
    "boards/*/*_assembly_*.svg",
    "mask/*.svg",
    "wiring/*.svg",
)

_HTML, _PDF = "manual/manual.html", "manual/manual.pdf"
_CHAPTER = re.compile(r"(\d+)\. ")
_ITEM = re.compile(r"^\d+\. ")
_NUMBER = re.compile(r"\d+(\.\d+)?")
_FIGURE = re.compile(_NUMBER.pattern + r"(%|°C?|min|mL|[cmkμ]?[ALNVWghmsΩ])?")
"""A number with its unit."""
_ELSEWHERE = re.compile(r"(https?|mailto):")
_SHORT = 12  # letters that stand in many places
_FEW = 8  # letters beside numbers that are alike by chance
_AHEAD = 4000  # letters in which a passage is looked for after one that differs


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Read both forms, and the files of the pictures."""
    html = Subject("manual_pages", _HTML)
    try:
        page = read_html(outputs / _HTML)
    except OutputError as error:
        yield unreadable("manual_pages.readable", _HTML, str(error))
        return
    yield html.figure("readable", len(page.passages), 1, math.inf, "passages")
    yield html.count("chapters", _out_of_order(page.chapters), "out of order")
    yield html.count("pictures", _wrong_pictures(outputs, page), "that are not their files")
    lost = [to for to in page.links if not _leads(outputs, page, to)]
    yield html.count("links", lost, "that lead nowhere")
    yield html.count("notes", list(_at_odds(outputs, page)), "passages at odds with a note")
    yield html.count("lines", list(lines_misplaced(outputs, page)), "lines of a note misplaced")
    yield html.count("labels", list(labels_alone(outputs, page)), "labels of a note alone")
    yield from measure_words(outputs, design)
    pdf = Subject("manual_pages", _PDF)
    try:
        sheets = read_sheets(outputs / _PDF)
    except OutputError as error:
        yield unreadable("manual_pages.readable", _PDF, str(error))
        return
    numbers = [sheet.foot.split()[-1:] for sheet in sheets]
    wrong = [f"page {n}" for n, foot in enumerate(numbers, 1) if foot != [str(n)]]
    yield pdf.count("pages", wrong, "with another number")
    differing = list(_differing(page.passages, letters("".join(s.text for s in sheets))))
    yield pdf.count("words", differing, "passages that differ from the HTML")


def _out_of_order(headings: list[str]) -> list[str]:
    """Chapters with another number than the one after the chapter before."""
    numbered = [(h, int(found[1])) for h in headings if (found := _CHAPTER.match(h))]
    wrong = [heading for n, (heading, number) in enumerate(numbered, 1) if number != n]
    return wrong if numbered else ["there is none"]


def _wrong_pictures(outputs: Path, page: Html) -> list[str]:
    """Pictures that are not their files, and drawings of the work that are not shown."""
    wrong = []
    for shown in page.pictures:
        if sha256_of(outputs / shown.file) != hashlib.sha256(shown.data).hexdigest():
            wrong.append(shown.file)
    work = {path.relative_to(outputs).as_posix() for path in outputs.glob("manual/*.svg")}
    return wrong + sorted(work - {shown.file for shown in page.pictures})


def _leads(outputs: Path, page: Html, to: str) -> bool:
    if to.startswith("#"):
        return to[1:] in page.places
    file = outputs / "manual" / to.partition("#")[0]
    return bool(_ELSEWHERE.match(to)) or sha256_of(file) is not None


def _at_odds(outputs: Path, page: Html) -> Iterator[str]:
    """Passages of manual or notes that stand in both, but with other numbers or units."""
    noted: dict[str, set[str]] = defaultdict(set)
    for path in sorted(outputs.glob("*/*.md")):
        try:
            lines = read_note(path).lines
        except OutputError as error:
            yield f"{path.name} {error}"
            continue
        for line in (_ITEM.sub("", line) for line in lines):
            noted[_FIGURE.sub("0", line)].add(line)
    shown: dict[str, set[str]] = defaultdict(set)
    for line in (_ITEM.sub("", line) for line in page.lines):
        shown[_FIGURE.sub("0", line)].add(line)
    for form in sorted(shown.keys() & noted.keys()):
        if sum(map(str.isalpha, form)) > _FEW:
            yield from sorted(shown[form] ^ noted[form])


def _differing(passages: list[Passage], printed: str) -> Iterator[str]:
    """Passages that do not follow on the one before, and what else is printed there.

    Args:
        passages: of the HTML, in order.
        printed: letters of the whole PDF.
    """
    at, drawn = 0, ""
    for passage in passages:
        wanted = letters(passage.text)
        if passage.drawing or not wanted:
            drawn += wanted
            continue
        # A table that runs on over a page repeats its heading row.
        for before in (drawn + letters(passage.heads), drawn):
            begin = at + len(before)
            if printed.startswith(wanted, begin) and _same(printed[at:begin], before):
                break
        else:
            yield passage.text.strip()
            begin = printed.find(wanted, at, at + _AHEAD) if len(wanted) > _SHORT else -1
        if begin >= 0:
            at, drawn = begin + len(wanted), ""
    if not _same(printed[at:], drawn):
        yield "more at the end"


def _same(letters_in: str, other: str) -> bool:
    """Whether two texts have the same letters: a renderer orders those of a drawing by place."""
    return Counter(letters_in) == Counter(other)
