"""Words exchanged in the manual's drawings of the work, and the check sees it."""

import re
from pathlib import Path

import pytest

from damages import excerpt
from lumitip_fab.checks.work_words import measure_words
from lumitip_fab.design.encoding import read_design

pytestmark = pytest.mark.slow
CONTACTS, FOLDED = "manual/contacts.svg", "manual/emitter_folded.svg"


@pytest.fixture
def copied(outputs: Path, tmp_path: Path) -> Path:
    """The manual of the published design, to damage."""
    return excerpt(outputs, tmp_path / "drawn", "manual")


def failing(folder: Path) -> set[str]:
    found = measure_words(folder, read_design(folder / "design.json"))
    return {m.check.removeprefix("manual_pages.") for m in found if not m.passed}


def exchanged(path: Path, one: str, other: str) -> None:
    """Two words in each other's places."""
    text = path.read_text(encoding="utf-8")
    words = {f">{one}</text>": f">{other}</text>", f">{other}</text>": f">{one}</text>"}
    assert all(word in text for word in words)
    swapped = re.sub("|".join(map(re.escape, words)), lambda found: words[found[0]], text)
    path.write_text(swapped, encoding="utf-8")


def test_nothing_fails_as_it_is_drawn(copied: Path) -> None:
    assert failing(copied) == set()


@pytest.mark.parametrize(
    ("file", "one", "other", "check"),
    [
        (CONTACTS, "24V", "GND", "contacts"),
        (CONTACTS, "1", "3", "contacts"),
        (CONTACTS, "hole for the locating pin", "Von", "contacts"),
        (FOLDED, "4", "21", "flaps"),
        (FOLDED, "1", "2", "flaps"),
    ],
)
def test_words_exchanged(copied: Path, file: str, one: str, other: str, check: str) -> None:
    exchanged(copied / file, one, other)
    assert failing(copied) == {check}


def test_a_leader_or_a_flap_lost(copied: Path) -> None:
    for file, line in ((CONTACTS, r'<path fill="none" stroke="#5a6b7a".*\n'), (FOLDED, "<text.*")):
        text = (copied / file).read_text(encoding="utf-8")
        (copied / file).write_text(re.sub(line, "", text, count=1), encoding="utf-8")
    assert failing(copied) == {"contacts", "flaps"}


def test_drawings_that_cannot_be_read(copied: Path) -> None:
    (copied / CONTACTS).unlink()
    (copied / FOLDED).write_bytes(b"\xff")
    assert failing(copied) == {"contacts", "flaps"}
