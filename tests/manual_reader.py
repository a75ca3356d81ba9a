"""The build manual as its readers have it: HTML and PDF."""

import re
from base64 import b64decode
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path

import pikepdf

from lumitip_fab.checks.readers import MALFORMED
from lumitip_fab.checks.readers.mask_page import faces_of, lacking
from lumitip_fab.errors import OutputError

_FOOT = 2  # texts at the foot of each page, drawn first
_BLOCKS = {"h1", "h2", "h3", "h4", "h5", "p", "li", "td", "th", "tr", "table"}


@dataclass(frozen=True)
class Chapter:
    """Everything below a heading, down to the next one."""

    heading: str
    tables: list[list[list[str]]] = field(default_factory=list)
    """Rows of cells, the heading row first."""


class Manual(HTMLParser):
    """The manual's HTML."""

    def __init__(self) -> None:
        super().__init__()
        self.blocks = [""]
        """Words of each paragraph, item, heading and cell."""
        self.chapters = [Chapter("")]
        self.pictures: list[tuple[str, bytes]] = []
        """Path and bytes of each picture."""
        self.codes: list[str] = []
        """Texts in the code typeface, such as file names."""
        self._open = ""
        self._text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Opens a heading, a table, a row, a cell, or shows a picture."""
        if tag in _BLOCKS:
            self.blocks.append("")
        if tag == "img":
            attributes = dict(attrs)
            data = (attributes.get("src") or "").partition("base64,")[2]
            self.pictures.append(
                (attributes.get("data-file") or "", b64decode(data, validate=True))
            )
        elif tag == "table":
            self.chapters[-1].tables.append([])
        elif tag == "tr":
            self.chapters[-1].tables[-1].append([])
        if tag in ("br", "small"):
            self.blocks.append("")
        if tag in ("td", "th", "code", "h1", "h2", "h3", "h4", "h5", "title", "style"):
            self._open, self._text = tag, ""

    def handle_endtag(self, tag: str) -> None:
        """Keeps what stood in it."""
        if tag in ("td", "th"):
            self.chapters[-1].tables[-1][-1].append(self._text)
        elif tag == "code":
            self.codes.append(self._text)
        elif re.fullmatch(r"h\d", tag):
            self.chapters.append(Chapter(self._text))
        if tag in ("title", "style"):
            self._open = ""
        if tag in _BLOCKS:
            self.blocks.append("")

    def handle_data(self, data: str) -> None:
        """Words."""
        if self._open not in ("title", "style"):
            self.blocks[-1] += data
            self._text += data


def read_html(path: Path) -> Manual:
    """The manual's HTML.

    Raises:
        OutputError: if it is missing or cannot be read.
    """
    manual = Manual()
    try:
        manual.feed(path.read_text(encoding="utf-8"))
        manual.close()
    except (OSError, ValueError, LookupError) as error:
        raise OutputError(f"{path}: cannot be read as a manual: {error!r:.120}") from error
    return manual


def read_pdf(path: Path) -> tuple[list[str], list[str]]:
    """What is written on each page of a PDF, without spaces, and the fonts that it lacks.

    Raises:
        OutputError: if it is missing or cannot be read.
    """
    sheets, without = list[str](), set[str]()
    try:
        with pikepdf.open(path) as document:
            for page in document.pages:
                faces = faces_of(page)
                without |= set(lacking(faces))
                drawn, face = list[str](), ""
                for operands, operator in pikepdf.parse_content_stream(page):
                    if str(operator) == "Tf":
                        face = str(operands[0])
                    elif str(operator) == "Tj":
                        drawn.append(faces[face].text(bytes(operands[0])))
                sheets.append(re.sub(r"\s", "", "".join(drawn[_FOOT:])))
    except (OSError, *MALFORMED, pikepdf.PdfError) as error:
        raise OutputError(f"{path}: cannot be read as a PDF: {error!r:.120}") from error
    return sheets, sorted(without)
