"""README and the pages of docs: links, the map of all pages, length, and nothing said twice."""

import re
from itertools import combinations
from pathlib import Path

import pytest

from markdown_pages import (
    DOCS,
    PAGES,
    README,
    ROOT,
    anchors,
    broken_links,
    linked_files,
    long_lines,
    sections,
    sentences,
)

MAP = ROOT / "docs/index.md"
MOST_LINES, MOST_CHARACTERS, LONG_SENTENCE = 120, 100, 70


def _name(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


@pytest.mark.parametrize("page", PAGES, ids=_name)
def test_every_link_and_anchor_of_a_page_resolves(page: Path) -> None:
    assert broken_links(page, page.read_text("utf-8")) == []


def test_simulated_tasks_are_linked_to_the_section_on_them() -> None:
    found = [
        (page.parent / file, anchor)
        for page in DOCS
        for file, anchor in re.findall(
            r"\[simulated tasks[^]]*\]\(([^)#]+)#?([^)]*)\)", page.read_text("utf-8")
        )
    ]
    assert found
    for page, anchor in found:
        (section,) = [s for s in sections(page.read_text("utf-8")) if s.anchor == anchor]
        assert "Gymnasium environments" in " ".join(section.texts), page


def test_a_damaged_link_is_found() -> None:
    text = MAP.read_text("utf-8")
    assert "](start.md)" in text
    assert broken_links(MAP, text.replace("](start.md)", "](begin.md)", 1)) == [
        "begin.md: no such file"
    ]
    moved = text.replace("estimation.md#accuracy", "estimation.md#exactness")
    assert broken_links(MAP, moved) == ["estimation.md#exactness: no such heading"]
    assert broken_links(MAP, "# One\n\n[here](#one) [there](#two)") == ["#two: no such heading"]
    assert broken_links(MAP, "![none](images/none.png)") == ["images/none.png: no such file"]


def test_anchors_are_those_of_github() -> None:
    text = "# How good is it?\n\n## `spec`, and a_b\n\n## Same\n\n## Same\n"
    assert anchors(text) == {"how-good-is-it", "spec-and-a_b", "same", "same-1"}


def _not_on_the_map(text: str) -> set[str]:
    return {page.name for page in DOCS if page != MAP} - {f.name for f in linked_files(MAP, text)}


def test_the_map_links_every_page_of_the_documentation() -> None:
    text = MAP.read_text("utf-8")
    assert _not_on_the_map(text) == set()
    assert _not_on_the_map(text.replace("](view.md)", "](start.md)")) == {"view.md"}
    assert MAP in linked_files(README, README.read_text("utf-8"))


def test_every_picture_is_shown_on_a_page() -> None:
    shown = {file for page in PAGES for file in linked_files(page, page.read_text("utf-8"))}
    pictures = set((ROOT / "docs/images").iterdir())
    assert pictures - shown == set()


def test_the_readme_is_read_in_two_minutes() -> None:
    assert len(README.read_text("utf-8").splitlines()) <= MOST_LINES


def _repeated(texts: dict[str, str]) -> set[str]:
    found = {name: sentences(text, LONG_SENTENCE) for name, text in texts.items()}
    return {s for one, other in combinations(found.values(), 2) for s in one & other}


def test_no_sentence_stands_on_two_pages() -> None:
    texts = {page.name: page.read_text("utf-8") for page in (README, *DOCS)}
    assert _repeated(texts) == set()
    copied = next(iter(sentences(texts["checks.md"], LONG_SENTENCE)))
    texts["view.md"] += f"\n\n{copied}\n"
    assert _repeated(texts) == {copied}


@pytest.mark.parametrize("page", [README, *DOCS], ids=_name)
def test_lines_fit_an_editor(page: Path) -> None:
    assert long_lines(page.read_text("utf-8"), MOST_CHARACTERS) == []


def test_a_long_line_is_found_and_a_table_is_none() -> None:
    long = "x" * (MOST_CHARACTERS + 1)
    text = f"{long}\n| {long} |\n[a]({long})\n```text\n{long}\n```\n```sh\n{long}\n```\n"
    assert long_lines(text, MOST_CHARACTERS) == [1, 8]
