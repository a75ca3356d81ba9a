"""Markdown pages as tests read them: links, sections, code and prose, by a CommonMark parser."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

from markdown_it import MarkdownIt
from markdown_it.token import Token

ROOT = Path(__file__).parents[1]
README = ROOT / "README.md"
DOCS = sorted((ROOT / "docs").rglob("*.md"))
PAGES = [
    *(ROOT / f"{name}.md" for name in ("README", "CONTRIBUTING", "SECURITY", "CHANGELOG")),
    ROOT / "outputs/README.md",
    *sorted((ROOT / "readout").rglob("README.md")),
    *DOCS,
]
_PARSER = MarkdownIt("commonmark").enable("table")


@dataclass(frozen=True)
class Link:
    """A relative link or picture of a page: file (as written, may be empty) and anchor."""

    file: str
    anchor: str


def links(text: str) -> list[Link]:
    """Relative links and pictures, in order; addresses on other computers are left out."""
    found = []
    for token in _inline(text):
        address = str(token.attrGet("href") or token.attrGet("src") or "")
        if address and not re.match(r"[a-z]+:", address):
            file, _, anchor = address.partition("#")
            found.append(Link(file, anchor))
    return found


@dataclass(frozen=True)
class Section:
    """All that stands between a heading and the next one, of whatever level."""

    heading: str
    anchor: str
    texts: list[str] = field(default_factory=list)
    """Paragraphs, items and cells of tables, without code, line breaks and addresses of links."""
    rows: list[list[str]] = field(default_factory=list)
    """Markdown of the cells of each row of its tables, without the headings of the columns."""


def sections(text: str) -> list[Section]:
    """The sections of a page, in order. Anchors are as GitHub forms them: a repeated one has its
    number behind it."""
    found: list[Section] = []
    used: set[str] = set()
    within = False
    for opening, token in pairwise(_PARSER.parse(text)):
        if opening.type == "heading_open":
            plain = "".join(part.content for part in token.children or ())
            slug = re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")
            number = sum(1 for other in used if re.fullmatch(rf"{re.escape(slug)}(-\d+)?", other))
            found.append(Section(plain, f"{slug}-{number}" if number else slug))
            used.add(found[-1].anchor)
        elif token.type in ("tbody_open", "tbody_close"):
            within = token.type == "tbody_open"
        elif token.type == "tr_open" and within:
            found[-1].rows.append([])
        elif token.type == "inline" and found:
            parts = (p.content if p.type == "text" else " " for p in token.children or ())
            found[-1].texts.append("".join(parts).strip())
            if within:
                found[-1].rows[-1].append(token.content)
    return found


def anchors(text: str) -> set[str]:
    """Anchors of the headings."""
    return {section.anchor for section in sections(text)}


def broken_links(page: Path, text: str) -> list[str]:
    """Links of a page whose file or heading does not exist.

    Args:
        page: where the text stands; links are relative to its folder.
        text: its Markdown.
    """
    broken = []
    for link in links(text):
        file = (page.parent / link.file).resolve() if link.file else page
        if not file.exists():
            broken.append(f"{link.file}: no such file")
        elif link.anchor:
            target = text if file == page else file.read_text("utf-8")
            if link.anchor not in anchors(target):
                broken.append(f"{link.file}#{link.anchor}: no such heading")
    return broken


def linked_files(page: Path, text: str) -> set[Path]:
    """Files that a page links or shows."""
    return {(page.parent / link.file).resolve() for link in links(text) if link.file}


def code_blocks(text: str, language: str) -> list[str]:
    """Fenced blocks of a language."""
    return [t.content for t in _PARSER.parse(text) if t.type == "fence" and t.info == language]


def long_lines(text: str, most: int) -> list[int]:
    """Numbers of the lines that are longer than `most`, but for tables, links and output."""
    found, fenced = [], ""
    for number, line in enumerate(text.split("\n"), 1):
        if line.lstrip().startswith("```"):
            fenced = "" if fenced else line.strip()
        free = line.startswith("|") or "](" in line or fenced == "```text"
        if len(line) > most and not free:
            found.append(number)
    return found


def sentences(text: str, least: int) -> set[str]:
    """Sentences of the prose that have at least `least` characters, without line breaks."""
    prose = []
    for token in _PARSER.parse(text):
        if token.type == "inline":
            prose.append(re.sub(r"\s+", " ", token.content))
    split = (part for block in prose for part in re.split(r"(?<=[.!?:;])\s", block))
    return {part.strip() for part in split if len(part.strip()) >= least}


def _inline(text: str) -> Iterator[Token]:
    for token in _PARSER.parse(text):
        yield from token.children or ()
