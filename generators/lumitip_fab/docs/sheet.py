"""The manual as a PDF on A4 set by reportlab: the same text."""

import io
import math
import re
from collections.abc import Iterator
from functools import partial
from html import escape
from itertools import pairwise
from typing import NamedTuple

import PIL.Image
from markdown_it.token import Token
from reportlab import rl_config
from reportlab.graphics.shapes import Group, String
from reportlab.lib.pagesizes import A4
from reportlab.lib.units import inch, mm
from reportlab.pdfgen.canvas import Canvas
from reportlab.platypus import (
    Flowable,
    Image,
    LongTable,
    Paragraph,
    SimpleDocTemplate,
    Table,
    TableStyle,
)
from svglib.svglib import svg2rlg

from lumitip_fab.docs.page import markdown
from lumitip_fab.docs.sheet_pages import MARGIN, MARGIN_HIGH, WIDTH, kept_step
from lumitip_fab.docs.sheet_styles import (
    BESIDE,
    BODY,
    CELL,
    FIGURE,
    HEADS,
    ITEM,
    LINES,
    NEAR_LINES,
    SMALL,
)
from lumitip_fab.pipeline.artefact import Files
from lumitip_fab.text import page_letters
from lumitip_fab.typeface import CODE, OF_HELVETICA, PLAIN, load_typeface

rl_config.useA85 = 0  # streams as text take most of the time, and a quarter more room

_MOST_HIGH = 132 * mm  # of a drawing, which otherwise has its own size
_WIDE, _WIDE_HIGH = 1.5, 170 * mm  # of the page: a drawing so wide has small words already
_GAP = 6 * mm  # between pictures beside each other
_PAIR_HIGH = 85 * mm


class _Layout(NamedTuple):
    """Sizes of pictures, as shares, how many of a paragraph stand in a row at most, and whether the
    rows of tables are near each other."""

    drawing: float
    pixels: float
    row: int
    near: bool = False


_LAYOUTS = (
    _Layout(1.0, 1.0, 2),
    _Layout(0.9, 0.9, 2),
    _Layout(0.9, 0.9, 4),
    _Layout(0.8, 0.7, 4),
    _Layout(0.7, 0.5, 4),
    _Layout(0.8, 0.7, 4, near=True),
    _Layout(0.6, 0.5, 4),
    _Layout(0.55, 0.5, 4, near=True),
)
"""In the order in which they are tried, where one saves a page: near rows before drawings whose
words would be small. A picture of pixels has no words to read."""
_READABLE_PT = 6.0
"""Height of the least words of a drawing, where there is room for it: no layout makes them less."""
_SMALL_SHARE = 0.8
"""Of its size, that a drawing keeps whose words are smaller than that in any case."""
_DPI = 200
_TRUE_SIZE = re.compile(rb'^<svg [^>]*data-scale="1"')
"""The beginning of a drawing that a print of its page is measured by."""
_STEP = re.compile(r"\d+\. ")
"""The beginning of a step's heading."""
_WHOLE_ROWS = 14  # of a table that is not parted between pages
_LETTER, _PADDING = 4.9, 18.0  # width of a letter of a cell's text, and what is left beside it


def pdf_sheets(name: str, text: str, files: Files) -> bytes:
    """The bytes of the PDF; the same text gives the same.

    Args:
        name: its title.
        text: in Markdown.
        files: for the pictures.
    """
    buffer = io.BytesIO()
    load_typeface()
    document = SimpleDocTemplate(
        buffer,
        pagesize=A4,
        leftMargin=MARGIN,
        rightMargin=MARGIN,
        topMargin=MARGIN_HIGH,
        bottomMargin=MARGIN_HIGH,
        title=name,
        author="lumitip-fab",
        creator="lumitip-fab",
        invariant=1,
        initialFontName=PLAIN,
    )

    def foot(canvas: Canvas, _document: object) -> None:
        canvas.setFont(PLAIN, 7.1)
        canvas.setFillGray(0.45)
        canvas.drawString(MARGIN, 10 * mm, page_letters(name))
        canvas.drawRightString(A4[0] - MARGIN, 10 * mm, str(canvas.getPageNumber()))

    tokens = markdown().parse(text)
    _set_letters(tokens)
    story = [piece for part in _sections(tokens) for piece in _kept(part, files)]
    document.build(story, onFirstPage=foot, onLaterPages=foot)
    return buffer.getvalue()


def _set_letters(tokens: list[Token]) -> None:
    """Leave in all texts only what the typeface has."""
    for token in tokens:
        token.content = page_letters(token.content)
        _set_letters(token.children or [])


def _sections(tokens: list[Token]) -> Iterator[list[Token]]:
    """The steps, from heading to heading."""
    begins = [k for k, t in enumerate(tokens) if t.type == "heading_open" and t.tag == "h2"]
    for begin, end in pairwise([0, *begins, len(tokens)]):
        yield tokens[begin:end]


def _kept(tokens: list[Token], files: Files) -> list[Flowable]:
    """A step is not broken if it fits on a page, and of more than one page takes the fewest, if
    need be with smaller drawings. Other sections continue on the page."""
    drawn = any(child.type == "image" for token in tokens for child in token.children or [])
    if not (drawn or _STEP.match(tokens[1].content)):
        return list(_flowables(tokens, files))
    layouts = _LAYOUTS if drawn else _LAYOUTS[:1]
    return kept_step([partial(_step, tokens, files, layout) for layout in layouts])


def _step(tokens: list[Token], files: Files, layout: _Layout) -> list[Flowable]:
    return list(_flowables(tokens, files, layout))


def _flowables(
    tokens: list[Token], files: Files, layout: _Layout = _LAYOUTS[0]
) -> Iterator[Flowable]:
    """The blocks of the text, one after the other, with drawings as a layout has them."""
    numbers: list[int | None] = []
    rows: list[list[Paragraph]] = []
    for at, token in enumerate(tokens):
        if token.type in ("bullet_list_open", "ordered_list_open"):
            numbers.append(int(token.attrs.get("start", 1)) if token.tag == "ol" else None)
        elif token.type in ("bullet_list_close", "ordered_list_close"):
            numbers.pop()
        elif token.type == "table_open":
            rows = []
        elif token.type == "tr_open":
            rows.append([])
        elif token.type == "table_close":
            yield _table(rows, NEAR_LINES if layout.near else LINES)
        elif token.type == "inline":
            before = tokens[at - 1]
            if before.type in ("th_open", "td_open"):
                text = _inline(token)
                style = FIGURE if "right" in str(before.attrs.get("style", "")) else CELL
                rows[-1].append(Paragraph(f"<b>{text}</b>" if before.tag == "th" else text, style))
            elif before.type == "heading_open":
                yield from _heading(int(before.tag[1]), token)
            elif numbers:
                yield Paragraph(_inline(token), ITEM, bulletText=_bullet(numbers))
            else:
                yield from _paragraph(token, files, layout)


def _bullet(numbers: list[int | None]) -> str:
    number = numbers[-1]
    if number is None:
        return "\u2022"
    numbers[-1] = number + 1
    return f"{number}."


def _heading(level: int, token: Token) -> Iterator[Flowable]:
    yield Paragraph(_inline(token), HEADS[min(level, 4)])


def _paragraph(token: Token, files: Files, layout: _Layout) -> Iterator[Flowable]:
    children = token.children or []
    pictures = [child for child in children if child.type == "image"]
    if not pictures:
        yield Paragraph(_inline(token), BODY)
    columns = max(min(len(pictures), layout.row), 1)
    width = (WIDTH - (columns - 1) * _GAP) / columns
    high = _PAIR_HIGH if columns > 1 else _MOST_HIGH
    shown = [
        [
            _picture(str(child.attrs["src"]), files, width, high, layout),
            Paragraph(escape(child.content), SMALL),
        ]
        for child in pictures
    ]
    if pictures:
        padded = [*shown, *[""] * (-len(shown) % columns)]
        rows = [padded[i : i + columns] for i in range(0, len(padded), columns)]
        yield Table(rows, [WIDTH / columns] * columns, style=BESIDE)


def _picture(path: str, files: Files, width: float, high: float, layout: _Layout) -> Flowable:
    """A drawing stays a drawing, at most in its own size; a picture of pixels stays one."""
    if path.endswith(".svg"):
        data = files.read(path)
        drawing = svg2rlg(io.BytesIO(data))
        least = _letter(drawing)
        if high * least < _READABLE_PT * drawing.height or drawing.width > _WIDE * WIDTH:
            high = max(high, _WIDE_HIGH)
        scale = min(1.0, width / drawing.width, high / drawing.height)
        if not _TRUE_SIZE.search(data):
            readable = _READABLE_PT / least
            kept = readable if readable <= scale else _SMALL_SHARE * scale
            scale = min(scale, max(layout.drawing * scale, kept))
        drawing.scale(scale, scale)
        drawing.width, drawing.height = drawing.width * scale, drawing.height * scale
        drawing.hAlign = "CENTER"
        drawing.initialFontName = PLAIN
        return drawing
    seen = PIL.Image.open(io.BytesIO(files.read(path)))
    scale = layout.pixels * min(width / seen.width, high / seen.height)
    wide, high = seen.width * scale, seen.height * scale
    # On the white of paper, and hardly finer than it is printed.
    small = seen.convert("RGBA").reduce(max(1, round(inch / scale / _DPI)))
    paper = PIL.Image.new("RGBA", small.size, "white")
    paper.alpha_composite(small)
    plain = io.BytesIO()
    paper.convert("RGB").save(plain, "ppm")
    plain.seek(0)
    return Image(plain, wide, high)


def _letter(group: Group, scale: float = 1.0) -> float:
    """Set a drawing's words in the faces of this document; returns the height of the least."""
    least = math.inf
    for node in group.contents:
        if isinstance(node, Group):
            least = min(least, _letter(node, scale * math.hypot(*node.transform[2:4])))
        elif isinstance(node, String):
            node.fontName, share = OF_HELVETICA[node.fontName]
            node.fontSize *= share
            least = min(least, scale * node.fontSize)
    return least


def _table(rows: list[list[Paragraph]], style: TableStyle) -> Flowable:
    """Columns as wide as their text up to some words, narrower within the page, but not than their
    longest word."""
    columns = [[row[i] for row in rows if i < len(row)] for i in range(max(map(len, rows)))]
    least = [max(cell.minWidth() for cell in column) + _PADDING for column in columns]
    asked = [max(map(_asked, column)) for column in columns]
    share = min((WIDTH - sum(least)) / max(sum(asked) - sum(least), 1.0), 1.0)
    widths = [low + share * (high - low) for low, high in zip(least, asked, strict=True)]
    if share < 0:
        widths = [WIDTH / sum(asked) * high for high in asked]
    split = len(rows) > _WHOLE_ROWS
    table = LongTable(rows, widths, repeatRows=1, splitByRow=split, style=style, hAlign="LEFT")
    table.spaceBefore = table.spaceAfter = 6
    return table


def _asked(cell: Paragraph) -> float:
    return float(max(cell.minWidth(), min(len(cell.getPlainText()), 100) * _LETTER)) + _PADDING


def _inline(token: Token) -> str:
    """Text in reportlab's own mark-up."""
    parts = []
    for child in token.children or []:
        match child.type:
            case "text":
                parts.append(escape(child.content))
            case "code_inline":
                parts.append(f'<font face="{CODE}">{escape(child.content)}</font>')
            case "softbreak" | "hardbreak":
                parts.append(" ")
            case "strong_open" | "em_open":
                parts.append("<b>" if child.tag == "strong" else "<i>")
            case "strong_close" | "em_close":
                parts.append("</b>" if child.tag == "strong" else "</i>")
    return "".join(parts)
