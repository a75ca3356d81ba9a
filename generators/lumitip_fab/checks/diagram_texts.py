"""Words of `wiring.svg`, by where they stand: a reader takes the nearest for that of a pad."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from lumitip_fab.checks.cables import Row
from lumitip_fab.design import Cabling

_SVG = "{http://www.w3.org/2000/svg}"
_LINE_MM = 3.0  # height between a pad and the words of its line, at most
_EDGE_MM = 0.01
_COLUMN_MM = 1.0  # between words below each other
_CONNECTOR = re.compile(r"J\d+")
_OF_CABLE = re.compile(r"W\d+|[\d.]+ mm, [\d.]+ mm²")
_DIGITS, _CENT_MA = 0.006, 0.0051  # that three digits, or two decimals, of a current are off


@dataclass(frozen=True)
class Text:
    """Words with their place."""

    words: str
    x: float
    y: float


def misread(path: Path, rows: tuple[Row, ...], cabling: Cabling) -> Iterator[str]:
    """Pads, boards and cables beside which other words stand than their own."""
    root = ElementTree.parse(path).getroot()
    texts = [Text(t.text or "", *_at(t, "x", "y")) for t in root.iter(f"{_SVG}text")]
    boxes = [
        (*_at(r, "x", "y"), *_at(r, "width", "height")) for r in root.findall(f"{_SVG}rect")[1:]
    ]
    pads = {
        group.get("id", ""): _at(circle, "cx", "cy")
        for group in root.iter(f"{_SVG}g")
        for circle in group.findall(f"{_SVG}circle")
    }
    wires = [wire for cable in cabling.cables for wire in cable.wires]
    for end in (end for wire in wires for end in (wire.start, wire.end)):
        pad = f"{end.board}.{end.label}"
        if pad not in pads:
            yield f"{pad} is not drawn"
            continue
        x, y = pads[pad]
        wanted = list(dict.fromkeys((end.pin, end.name)))
        line = sorted((t for t in texts if abs(t.y - y) < _LINE_MM), key=lambda t: abs(t.x - x))
        if [text.words for text in line[: len(wanted)]] != wanted:
            yield f"{pad} is not called {' '.join(wanted)}"
            continue
        title = [_title(texts, box) for box in boxes if _on_edge(box, x, y)]
        if title != [end.board.capitalize()]:
            yield f"{pad} is on a board called {' and '.join(title)}"
        if end.connector and _above(texts, line[0], _CONNECTOR)[:1] != [end.connector]:
            yield f"{pad} is not below {end.connector}"
    yield from _labels(texts, rows)


def _labels(texts: list[Text], rows: tuple[Row, ...]) -> Iterator[str]:
    """Wires whose label has another current, or that are not below the name of their cable."""
    labels = {text.words.split()[0]: text for text in texts if text.words}
    for row in rows:
        label = labels.get(row.wire)
        if label is None:
            yield f"{row.wire} has no label"
            continue
        current = re.fullmatch(r"\S+ \S+ ([\d.e+]+) mA", label.words)
        stated = float(current[1]) if current else 0.0
        if abs(stated - row.current_ma) > max(_DIGITS * row.current_ma, _CENT_MA):
            yield f"{row.wire} carries {stated:g} mA"
        above = _above(texts, label, _OF_CABLE)
        if above[:2] != [f"{row.length_mm:g} mm, {row.section_mm2:g} mm²", row.cable]:
            yield f"{row.wire} is below {' and '.join(above[:2])}"


def _above(texts: list[Text], below: Text, kind: re.Pattern[str]) -> list[str]:
    """Words of a kind over others, the nearest first."""
    column = [t for t in texts if abs(t.x - below.x) < _COLUMN_MM and t.y < below.y]
    found = [t for t in column if kind.fullmatch(t.words)]
    return [t.words for t in sorted(found, key=lambda t: -t.y)]


def _title(texts: list[Text], box: tuple[float, ...]) -> str:
    """The highest words in a box."""
    x, y, wide, high = box
    inside = [t for t in texts if x < t.x < x + wide and y < t.y < y + high]
    return min(inside, key=lambda t: t.y).words if inside else "nothing"


def _on_edge(box: tuple[float, ...], x: float, y: float) -> bool:
    left, top, wide, high = box
    sides = min(abs(x - left), abs(x - left - wide))
    return sides < _EDGE_MM and top < y < top + high


def _at(element: ElementTree.Element, *names: str) -> tuple[float, ...]:
    return tuple(float(element.get(name, "")) for name in names)
