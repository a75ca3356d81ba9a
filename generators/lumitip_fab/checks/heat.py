"""No step heats a part beyond what its material bears: design, notes and manual."""

import re
from collections.abc import Iterator
from pathlib import Path

from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.design import Design

READS = ("mask/*_wrapping.md", "mould/*_casting.md", "wiring/cables.md", "manual/manual.html")
_MANUAL = "manual/manual.html"
_NOTES = {
    "mask/{}_wrapping.md": "cure",
    "mould/{}_casting.md": "cure",
    "wiring/cables.md": "solder",
}
"""Notes, and the step whose parts lie there while one works by them."""
_FILM_ALONE = (
    "Make the printer true",
    "Print on the film",
    "Test, cut and crease the film",
    "Cut",
    "Crease the folds",
)
"""Sections of the wrapping note in which the film is away from the finger."""
_SECTION = re.compile(r"^#+ (?:\d+\. )?(.*)$", re.MULTILINE)
_DEGREES = re.compile(r"(?<![\w.])(-?\d+(?:\.\d+)?)\s+°C")
_TO_HEAT = re.compile(r"\b(?:warm|heat|bake|oven|hot air|heat gun|hot plate)\b", re.IGNORECASE)
_ROW = re.compile(r"([\d.]+) °C")
_CHAPTER = re.compile(r"<h\d[^>]*>(.*?)</h\d>", re.DOTALL)
_LINE = re.compile(r"<tr[^>]*>(.*?)</tr>", re.DOTALL)
_CELL = re.compile(r"<td[^>]*>(.*?)</td>", re.DOTALL)


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Each step of the design, what the notes tell to heat, and the manual's table of steps."""
    for step in design.heat:
        for part in step.parts:
            subject = f"design.json: {step.name}, {part.name} of {part.material}"
            yield Measurement(
                "heat.limit", subject, step.temperature_c, high=part.limit_c, unit="°C"
            )
    names = [name.format(finger.name) for name in _NOTES for finger in design.fingers]
    for file in dict.fromkeys(names):
        try:
            text = (outputs / file).read_text(encoding="utf-8")
        except (OSError, ValueError) as error:
            yield unreadable("heat.notes", file, f"cannot be read: {error!r:.120}")
            continue
        yield from _note(file, text, design)
    yield _table(outputs, design)


def _note(file: str, text: str, design: Design) -> Iterator[Measurement]:
    """The hottest figure of each section, and orders to heat where nothing may be heated."""
    folder = file.partition("/")[0]
    usual = next(step for name, step in _NOTES.items() if name.startswith(folder))
    sections = list(_sections(text))
    steps = {heading: "crease" if heading in _FILM_ALONE else usual for heading, _ in sections}
    for heading, words in sections:
        limit = design.heat_steps[steps[heading]].limit_c
        figures = [float(value) for value in _DEGREES.findall(words)]
        if figures:
            note = f"hottest of {len(figures)} figures"
            yield Measurement(
                "heat.notes", f"{file}: {heading}", max(figures), high=limit, unit="°C", note=note
            )
    orders = [
        f"{found[0]!r} in {heading!r}"
        for heading, words in sections
        if steps[heading] == "cure"
        for found in _TO_HEAT.finditer(words)
    ]
    yield Measurement(
        "heat.orders", file, len(orders), 0, 0, "orders to heat the finger", "; ".join(orders[:4])
    )


def _sections(text: str) -> Iterator[tuple[str, str]]:
    """Heading and text of each section."""
    pieces = _SECTION.split(text)
    yield from zip(pieces[1::2], pieces[2::2], strict=True)


def _table(outputs: Path, design: Design) -> Measurement:
    """The manual's table of steps against the design: each once, with its figures."""
    try:
        text = (outputs / _MANUAL).read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        return unreadable("heat.steps", _MANUAL, f"cannot be read: {error!r:.120}")
    split = _CHAPTER.split(text)  # heading and contents in turn
    chapters = zip(split[1::2], split[2::2], strict=True)
    here = "".join(contents for heading, contents in chapters if heading == "Heat")
    rows = [_CELL.findall(row) for row in _LINE.findall(here)]
    listed = {(row[0], *_ROW.findall(" ".join(row[1:]))) for row in rows if row}
    wanted = {(s.name, f"{s.temperature_c:g}", f"{s.limit_c:g}") for s in design.heat}
    wrong = sorted(" ".join(row) for row in listed ^ wanted)
    return Measurement("heat.steps", _MANUAL, len(wrong), 0, 0, "wrong rows", "; ".join(wrong[:4]))
