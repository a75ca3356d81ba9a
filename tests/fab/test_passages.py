"""Texts in passages: each has its own name."""

from pathlib import Path

import pytest

import lumitip_fab
from lumitip_fab import text

ROOT = Path(lumitip_fab.__file__).parent
FILES = sorted(
    path.relative_to(ROOT).as_posix()
    for path in ROOT.rglob("*.md")
    if "\n=== " in "\n" + path.read_text(encoding="utf-8")
)


@pytest.mark.parametrize("file", FILES)
def test_no_name_stands_for_two_passages(file: str) -> None:
    written = text.data_file(file)
    first = written.partition("\n")[0].removeprefix("=== ")
    assert text.passage(file, first) in written


def test_two_passages_of_one_name_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(text, "data_file", lambda _: "=== wired\na\n=== other\nb\n=== wired\nc\n")
    with pytest.raises(ValueError, match=r"notes\.md: two passages each for wired"):
        text.passage("notes.md", "wired")


def test_the_texts_are_found() -> None:
    assert {"docs/chapters.md", "docs/wrapping.md", "docs/wiring.md"} <= {*FILES}
