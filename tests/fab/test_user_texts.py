"""Names of a parameter file are shown as they are written, in every page that prints them."""

import dataclasses
import re
from html import unescape
from pathlib import Path

import pytest

from lumitip_fab.design import Design, Title
from lumitip_fab.design.encoding import read_design
from lumitip_fab.docs.chapters import manual_text
from lumitip_fab.docs.page import html_page, markdown
from lumitip_fab.docs.wiring import wiring_files
from lumitip_fab.docs.wrapping import wrapping_note
from lumitip_fab.mask.files import mask_files
from lumitip_fab.parts.settings import print_settings
from lumitip_fab.pipeline import manifest
from lumitip_fab.pipeline.artefact import Artefact, Files, Made
from lumitip_fab.text import as_written

NAMES = [
    "left_hand_2",
    "_A_ and __B__, *c* **d**",
    "[e](f) ![g](h) <i>j</i> `k`",
    "a|b & &amp; ~~l~~ # ## \\_ \\",
    "1. - + > \"q\" 'r' {s} ${t} %u @v",
    "Палец",
    "指尖",
    "😀 шлифованный",
]


def _headings(text: str) -> list[str]:
    """Every heading as it is shown; nothing but plain text may be in it."""
    tokens = markdown().enable("strikethrough").parse(text)
    after = [tokens[at + 1] for at, token in enumerate(tokens) if token.type == "heading_open"]
    parts = [child for token in after for child in token.children or ()]
    assert {child.type for child in parts} <= {"text", "text_special", "code_inline"}
    return ["".join(child.content for child in token.children or ()) for token in after]


def _notes(design: Design) -> dict[str, str]:
    d = design
    made: list[Artefact] = [*print_settings(d)]
    made += wiring_files(d)
    (facts,) = (a.facts for a in mask_files(d, d.receiver) if a.facts)
    notes = {a.path: a.data.decode() for a in made if a.path.endswith(".md")}
    return notes | {"mask/receiver_wrapping.md": wrapping_note(d, d.receiver, facts)}


@pytest.mark.slow_cases
@pytest.mark.parametrize("name", NAMES)
def test_notes_show_a_name_as_it_is_written(name: str, designs: dict[str, Design]) -> None:
    named = dataclasses.replace(designs["published"], title=Title(name, "A"))
    notes = _notes(named)
    assert sorted(notes) == [
        "mask/receiver_wrapping.md",
        "print/printing.md",
        "wiring/cables.md",
    ]
    assert _headings(notes["print/printing.md"])[0] == f"Printing {name} A"
    assert _headings(notes["wiring/cables.md"])[0] == f"Wiring {name} A"
    told = f"{name} A: printing and wrapping the receiver mask"
    assert _headings(notes["mask/receiver_wrapping.md"])[0] == told


def test_a_name_with_an_underscore_stays_as_it_is_in_the_file_too() -> None:
    assert as_written("left_hand_2") == "left_hand_2"


@pytest.mark.parametrize("name", NAMES)
def test_the_manual_shows_a_name_as_it_is_written(name: str, outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    entries = manifest.read(outputs).files
    files = Files(outputs, {p: Made(e.sha256, e.facts) for p, e in entries.items()})
    text = manual_text(dataclasses.replace(design, title=Title(name, "A")), files)
    assert _headings(text)[0] == f"{name} A: build manual"
    title = re.search("<title>(.*)</title>", html_page(name, text, files))
    assert title is not None
    assert unescape(title[1]) == name
