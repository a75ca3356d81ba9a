"""`docs/evidence.md`: every section with a figure is in it, with its level, its command and what
compares it; each figure that it repeats stands in that section."""

import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from lumitip import cli as readout
from lumitip_fab import cli as fab
from markdown_pages import DOCS, README, ROOT, Section, links, sections

PAGE = ROOT / "docs/evidence.md"
MAP = ROOT / "docs/index.md"
TEXT = PAGE.read_text("utf-8")
PAGES = {
    page: page.read_text("utf-8")
    for page in (README, *DOCS)
    if page not in (PAGE, ROOT / "docs/glossary.md")
}
LEVELS = [
    "Measured on hardware (published)",
    "Measured on files",
    "Simulated with a model that shares nothing",
    "Simulated with our own model",
    "Assumed",
    "Inputs, limits and definitions of the design",
]
MAKEFILE = (ROOT / "Makefile").read_text("utf-8")
PARSERS = {"lumitip": readout.command_parser, "lumitip-fab": fab.command_parser}
NUMBER = r"(?<![\w.,/#-])[−±≤≥~+]?\d[\d,]*(?:\.\d+)?(?![\d.]*\w)"
UNIT = (
    r"\s?(?:°C|°|%)|\s(?:[cmµn]?m[²³]?|mm/s|EUR|frames/s|readings/s|steps/s|/s|µs|ms|s|min|minutes?"
    r"|seconds?|hours?|h|mA|A|kV|V|W|N|MPa|[GMk]B|g|kg|mL|k?Ω|k?Hz|pF|µH|dpi|times|bits?|bytes?"
    r"|counts?|cells?|checks?|frames?|steps|poses|fingers|designs|curves|lines|scans|characters)"
)
FIGURE = re.compile(rf"({NUMBER})((?:{UNIT})(?![\w/]))?")
CHECKED = re.compile(r"not kept|`[^`]+` (?:figure|limit)(?:, `[^`]+` (?:figure|limit))*")


@dataclass(frozen=True)
class Row:
    """A row of the page."""

    level: str
    page: Path
    anchor: str
    claim: str
    source: str
    checked: str

    @property
    def name(self) -> str:
        """The section, as the page links it."""
        return f"{self.page.name}#{self.anchor}"


def rows(text: str) -> list[Row]:
    """All rows of the tables, in order. A row has one link, in its first cell."""
    found = []
    for section in sections(text):
        for cell, claim, source, checked in section.rows:
            (link,) = links(cell)
            page = (PAGE.parent / link.file).resolve()
            found.append(Row(section.heading, page, link.anchor, claim, source, checked))
    return found


def cells(section: Section) -> list[str]:
    """Cells of its tables that are a number alone: their unit stands in a heading."""
    return [cell for row in section.rows for cell in row if re.fullmatch(NUMBER, cell)]


def figures(section: Section) -> list[str]:
    """Numbers with a unit, and cells of tables that are a number alone."""
    found = [m[0] for text in section.texts for m in FIGURE.finditer(text) if m[2]]
    return found + cells(section)


def with_figures(pages: dict[Path, str]) -> dict[tuple[Path, str], Section]:
    """Sections with a figure, by page and anchor, in the order of the map."""
    tables = MAP.read_text("utf-8").partition("\n## ")[2]
    order = [MAP, README, *((MAP.parent / link.file).resolve() for link in links(tables))]
    return {
        (page, section.anchor): section
        for page in sorted(pages, key=order.index)
        for section in sections(pages[page])
        if figures(section)
    }


def command_fault(command: str) -> bool:
    """Whether a command, or the path of a file, is none of this repository."""
    program, *arguments = shlex.split(command)
    files = re.findall(r"[\w./-]+\.(?:py|toml)\b", command)
    if any(not (ROOT / file).is_file() for file in files):
        return True
    if program == "make":
        return not re.search(rf"^{arguments[0]}:", MAKEFILE, re.MULTILINE)
    if program in PARSERS:
        try:
            PARSERS[program]().parse_args(arguments)
        except SystemExit:
            return True
        return False
    return program not in ("python", "pytest") and not (ROOT / program).exists()


def repeated(row: Row, section: Section) -> Iterator[str]:
    """Figures of a row that do not stand in its section."""
    there = [m for text in section.texts for m in FIGURE.finditer(text)]
    whole, numbers, alone = {m[0] for m in there}, {m[1] for m in there}, set(cells(section))
    for figure in FIGURE.finditer(re.sub("`[^`]*`", "", row.claim)):
        if figure[0] not in whole and figure[1] not in (alone if figure[2] else numbers):
            yield figure[0]


def row_faults(row: Row, section: Section) -> Iterator[str]:
    """What is wrong with a row, the section that it links at hand."""
    if not FIGURE.search(row.claim):
        yield f"{row.name}: no figure"
    for figure in repeated(row, section):
        yield f"{row.name}: has no {figure}"
    commands = re.findall("`([^`]+)`", row.source)
    if not commands and not row.source.startswith("none"):
        yield f"{row.name}: no command"
    if not CHECKED.fullmatch(row.checked):
        yield f"{row.name}: '{row.checked}' is not 'not kept', nor files, each a figure or a limit"
    for file, kind in re.findall("`([^`]+)` (figure|limit)", row.checked):
        commands.append(file)
        names = (row.page.name, row.page.parent.name if row.page.parent != PAGE.parent else "")
        read = (ROOT / file).read_text("utf-8") if (ROOT / file).is_file() else ""
        mentioned = "README" in read if row.page == README else any(n and n in read for n in names)
        if kind == "figure" and not mentioned:
            yield f"{row.name}: {file} does not read this page"
    for command in commands:
        if command_fault(command):
            yield f"{row.name}: there is no {command}"


def faults(text: str, pages: dict[Path, str]) -> list[str]:
    """What is wrong with the page, one line each, sorted."""
    found, needed = [], with_figures(pages)
    order, there = list(needed), rows(text)
    for row in there:
        section = needed.get((row.page, row.anchor))
        if section is None:
            found.append(f"{row.name}: a section without a figure")
        else:
            found += row_faults(row, section)
    for level in LEVELS:
        listed = [(r.page, r.anchor) for r in there if r.level == level]
        found += [f"{p.name}#{a}: twice" for p, a in set(listed) if listed.count((p, a)) > 1]
        known = [order.index(place) for place in listed if place in needed]
        if known != sorted(known):
            found.append(f"{level}: not in the order of the map")
    bound = {(row.page, row.anchor) for row in there}
    for (page, anchor), section in needed.items():
        if (page, anchor) not in bound:
            found.append(f"{page.name}#{anchor}: not bound: {', '.join(figures(section))}")
    return sorted(found)


def test_every_figure_is_bound() -> None:
    found = faults(TEXT, PAGES)
    assert found == [], "\n".join(found)


def test_it_has_each_level() -> None:
    headings = [section.heading for section in sections(TEXT) if section.rows]
    assert headings == LEVELS


def test_a_new_figure_that_nobody_bound_is_found() -> None:
    page = ROOT / "docs/firmware.md"
    other = {page: f"{PAGES[page]}\n\n## Power\n\nIt takes 12 mA, or `13 mA`.\n"}
    assert faults(TEXT, PAGES | other) == ["firmware.md#power: not bound: 12 mA"]
    other = {page: f"{PAGES[page]}\n\n## Power\n\n| at | mA |\n|---|---|\n| rest | 12.5 |\n"}
    assert faults(TEXT, PAGES | other) == ["firmware.md#power: not bound: 12.5"]
    other = {page: f"{PAGES[page]}\n\n## Power\n\nVersion 12, PA12, step 3.\n\n```\n12 mA\n```\n"}
    assert faults(TEXT, PAGES | other) == []


def test_a_section_whose_figures_went_is_stale() -> None:
    page = ROOT / "docs/firmware.md"
    assert "firmware.md#what-runs-on-the-controller: a section without a figure" in faults(
        TEXT, PAGES | {page: "# What runs on the controller\n\nA sketch.\n"}
    )


def line(of: str) -> str:
    """A row of the page, as it is written."""
    return next(each for each in TEXT.splitlines() if each.startswith("| ") and of in each)


RADIO = line("firmware.md#")
DAMAGES = {
    "a figure changed on its page alone": ("100 frames", "101 frames", "has no 101 frames"),
    "a script that is gone": ("tests/firmware/test_scans.py", "tests/gone.py", "there is no"),
    "a subcommand that is gone": ("lumitip-fab spec", "lumitip-fab look", "there is no"),
    "a target that is gone": ("lumitip-fab spec design/fingertip.toml", "make it", "there is no"),
    "a word for what compares it": ("` limit", "` roughly", "is not 'not kept'"),
    "a test that reads another page": ("` limit", "` figure", "does not read this page"),
    "no figure": ("100 frames", "frames", "no figure"),
}
"""Damages of the row of the firmware's page, and what is said of them."""


@pytest.mark.slow_cases
@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_row_is_found(damage: str) -> None:
    old, new, said = DAMAGES[damage]
    assert old in RADIO
    found = faults(TEXT.replace(RADIO, RADIO.replace(old, new)), PAGES)
    assert len(found) >= 1
    assert all("firmware.md#what-runs-on-the-controller" in f and said in f for f in found)


def test_rows_that_are_doubled_lost_or_moved_are_found() -> None:
    name = "firmware.md#what-runs-on-the-controller"
    assert faults(TEXT.replace(RADIO, f"{RADIO}\n{RADIO}"), PAGES) == [f"{name}: twice"]
    (lost,) = faults(TEXT.replace(f"{RADIO}\n", ""), PAGES)
    assert lost.startswith(f"{name}: not bound: 100 frames")
    first = line("#missing-terms")
    moved = TEXT.replace(f"{first}\n", "").replace(
        "|---|---|---|---|", f"|---|---|---|---|\n{first}", 1
    )
    assert faults(moved, PAGES) == [f"{LEVELS[0]}: not in the order of the map"]
