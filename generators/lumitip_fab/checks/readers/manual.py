"""Words, tables and pictures of the manual's HTML, and the fonts of a PDF's page."""

import re
from base64 import b64decode
from collections.abc import Mapping
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pikepdf

from lumitip_fab.errors import OutputError

_LETTER = re.compile(rb"<([0-9A-Fa-f]{2})>\s*<([0-9A-Fa-f]{4})>")
_FILES = ("/FontFile", "/FontFile2", "/FontFile3")
_USUAL_EM = 0.6  # of a letter whose width the file does not tell


@dataclass(frozen=True)
class Face:
    """A font with a letter for each byte."""

    name: str
    embedded: bool
    """Whether its outlines are in the file; else every printer takes its own."""
    letters: Mapping[int, str]
    """Character of each code; Windows-1252 for all others."""
    widths_em: Mapping[int, float]

    def text(self, codes: bytes) -> str:
        """The texts."""
        return "".join(self.letters.get(c) or bytes([c]).decode("cp1252") for c in codes)

    def width_em(self, codes: bytes) -> float:
        """How wide they are, in font sizes."""
        return sum(self.widths_em.get(code, _USUAL_EM) for code in codes)


def faces_of(page: pikepdf.Page) -> dict[str, Face]:
    """The fonts of a page, by the names that its operators use.

    Raises:
        ValueError: if one has more than a byte for each letter.
    """
    fonts: Any = page.resources.get("/Font", {})
    return {str(name): _face(fonts[name]) for name in fonts.keys()}  # noqa: SIM118


def _face(font: Any) -> Face:
    if str(font.Subtype) not in ("/TrueType", "/Type1"):
        raise ValueError(f"a font of kind {font.Subtype}, one byte for each letter is needed")
    outlines = font.get("/FontDescriptor", {})
    table = font.ToUnicode.read_bytes() if "/ToUnicode" in font else b""
    letters = {int(code, 16): chr(int(point, 16)) for code, point in _LETTER.findall(table)}
    widths = [float(width) / 1000 for width in font.get("/Widths", [])]
    first = int(font.get("/FirstChar", 0))
    return Face(
        name=str(font.BaseFont)[1:],
        embedded=any(kind in outlines for kind in _FILES),
        letters={code: letter for code, letter in letters.items() if letter != "\0"},
        widths_em=dict(enumerate(widths, first)),
    )


def lacking(faces: Mapping[str, Face]) -> list[str]:
    """Names of the fonts that are not embedded."""
    return sorted({face.name for face in faces.values() if not face.embedded})


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
