"""The manual's two forms as they are read: passages and pictures of the HTML, pages of the PDF."""

import re
import unicodedata
from base64 import b64decode
from contextlib import closing
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree as XmlTree

import pikepdf
import pypdfium2
from markdown_it import MarkdownIt

from lumitip_fab.checks.readers import MALFORMED
from lumitip_fab.checks.readers.plain_pdf import require_plain
from lumitip_fab.errors import OutputError
from lumitip_fab.text import page_letters

_HYPHEN = re.compile("[\x02\ufffe]")
_MARKDOWN = MarkdownIt("commonmark", {"html": False}).enable("table")
_FOOT_PT = 40.0  # below it is the foot of a page
_BLOCKS = frozenset(("p", "li", "td", "th", "br", "small", "h1", "h2", "h3", "h4", "h5", "h6"))
_UNSEEN = frozenset(("style", "title", "script"))
_TEXT = "{http://www.w3.org/2000/svg}text"


def letters(text: str) -> str:
    """A text without spaces, with the PDF's letters and without ligatures; pdfium has a sign of its
    own for a hyphen at the end of a line."""
    whole = unicodedata.normalize("NFKC", page_letters(_HYPHEN.sub("-", text)))
    return "".join(whole.split())


@dataclass
class Passage:
    """A paragraph, item, heading, cell or caption; or the words in a drawing, in any order."""

    text: str = ""
    drawing: bool = False
    heads: str = ""
    """The heading row of its table, which each page repeats."""
    row: int = 0
    """Number of its row of all tables; 0 outside of them."""


@dataclass(frozen=True)
class Shown:
    """A picture in the page."""

    file: str
    """Path of its own file, from the output folder."""
    data: bytes


@dataclass
class Html(HTMLParser):
    """The passages of a page in order, with its pictures and links."""

    passages: list[Passage] = field(default_factory=lambda: [Passage()])
    chapters: list[str] = field(default_factory=list)
    """Headings of the second level."""
    sections: list[str] = field(default_factory=list)
    """Headings of the third level."""
    pictures: list[Shown] = field(default_factory=list)
    links: list[str] = field(default_factory=list)
    places: set[str] = field(default_factory=set)
    """Names that links may lead to."""
    _heads: str = ""
    _rows: int = 0
    _row: int = 0
    _numbers: list[int | None] = field(default_factory=list)
    _unseen: bool = False

    @property
    def lines(self) -> list[str]:
        """Letters of each passage, and of each row of a table as a whole."""
        found, before = [""], 0
        for passage in self.passages:
            text = "" if passage.drawing else letters(passage.text)
            if passage.row and passage.row == before:
                found[-1] += text
            else:
                found.append(text)
            before = passage.row
        return found

    @property
    def rows(self) -> list[str]:
        """Letters of each row of its tables."""
        texts: dict[int, str] = {}
        for passage in self.passages:
            if passage.row:
                texts[passage.row] = texts.get(passage.row, "") + letters(passage.text)
        return list(texts.values())

    def __post_init__(self) -> None:
        super().__init__()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Begins a passage, or shows a picture."""
        values = {name: value or "" for name, value in attrs}
        self.places |= {values[name] for name in ("id", "name") if name in values}
        self._unseen |= tag in _UNSEEN
        if tag == "a" and "href" in values:
            self.links.append(values["href"])
        elif tag in ("ol", "ul"):
            self._numbers.append(int(values.get("start", 1)) if tag == "ol" else None)
        elif tag == "table":
            self._heads = ""
        elif tag == "tr":
            self._rows += 1
            self._row = self._rows
        elif tag == "img":
            self._picture(values)
        if tag in _BLOCKS:
            self._begin()
        if tag == "li" and self._numbers:
            self._mark()
        elif tag == "h2":
            self.chapters.append("")
        elif tag == "h3":
            self.sections.append("")

    def handle_endtag(self, tag: str) -> None:
        """Ends it."""
        if tag == "th":
            self._heads += self.passages[-1].text
        elif tag == "h2" and self.chapters:
            self.chapters[-1] = self.passages[-1].text
        elif tag == "h3" and self.sections:
            self.sections[-1] = self.passages[-1].text
        elif tag in ("ol", "ul") and self._numbers:
            self._numbers.pop()
        elif tag == "table":
            self._row = 0
        if tag in _BLOCKS:
            self._begin()
        self._unseen &= tag not in _UNSEEN

    def handle_data(self, data: str) -> None:
        """Words."""
        if not self._unseen:
            self.passages[-1].text += data

    def _begin(self) -> None:
        self.passages.append(Passage(heads=self._heads, row=self._row))

    def _mark(self) -> None:
        """Begin an item with its number or its bullet, which a browser adds."""
        number = self._numbers[-1]
        self.passages[-1].text = "\u2022 " if number is None else f"{number}. "
        if number is not None:
            self._numbers[-1] = number + 1

    def _picture(self, values: dict[str, str]) -> None:
        file = values.get("data-file", "")
        data = b64decode(values["src"].partition("base64,")[2], validate=True)
        self.pictures.append(Shown(file, data))
        if file.endswith(".svg"):
            texts = XmlTree.fromstring(data).iter(_TEXT)
            words = "".join("".join(text.itertext()) for text in texts)
            self.passages.append(Passage(words, drawing=True))
            self._begin()


def read_html(path: Path) -> Html:
    """The HTML form.

    Raises:
        OutputError: if it is missing or damaged.
    """
    page = Html()
    try:
        page.feed(path.read_text(encoding="utf-8"))
        page.close()
    except (OSError, XmlTree.ParseError, AssertionError, *MALFORMED) as error:
        raise OutputError(f"cannot be read: {error!r:.200}") from error
    return page


def read_note(path: Path) -> Html:
    """A note in Markdown, as a browser shows it.

    Raises:
        OutputError: if it is missing or damaged.
    """
    page = Html()
    try:
        page.feed(_MARKDOWN.render(path.read_text(encoding="utf-8")))
        page.close()
    except (OSError, AssertionError, *MALFORMED) as error:
        raise OutputError(f"cannot be read: {error!r:.200}") from error
    return page


@dataclass(frozen=True)
class Sheet:
    """A page of the PDF."""

    text: str
    foot: str


def read_sheets(path: Path) -> tuple[Sheet, ...]:
    """The pages of the PDF form.

    Raises:
        OutputError: if it is missing or damaged.
    """
    sheets = []
    try:
        with pikepdf.open(path) as pdf:
            require_plain(pdf)
        with closing(pypdfium2.PdfDocument(path)) as document:
            for page in document:
                text = page.get_textpage()
                foot = text.get_text_bounded(top=_FOOT_PT)
                sheets.append(Sheet(text.get_text_bounded(bottom=_FOOT_PT), foot))
    except (OSError, AssertionError, pikepdf.PdfError, *MALFORMED) as error:
        raise OutputError(f"cannot be read: {error!r:.200}") from error
    return tuple(sheets)
