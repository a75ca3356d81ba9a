"""Words in the manual's drawings of the work: each contact of the coupling at the end of its
leader, and each flap's number on the flap."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import shapely

from lumitip_fab.checks.result import Measurement, count, unreadable
from lumitip_fab.design import Design, Flange

_SVG = "{http://www.w3.org/2000/svg}"
_PLACE = re.compile(r"(-?[\d.]+),(-?[\d.]+)")
_UP_MM = 1.3  # from the line that letters stand on to their middle
_LINE_MM = 2.0  # height between a leader's end and its words, at most
_AT_MM = 0.1
_PIN = ("hole for the locating pin",)
_CONTACTS = "manual/contacts.svg"


@dataclass(frozen=True)
class _Drawing:
    words: tuple[tuple[str, float, float], ...]
    """Each with its start or middle, in mm; y points down."""
    leaders: tuple[shapely.LineString, ...]
    areas: tuple[shapely.Polygon, ...]
    """In the order of drawing, without those of a body."""


def measure_words(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Read the drawing of the coupling and those of the folded masks."""
    drawings = [(_CONTACTS, "contacts", flange) for flange in design.flanges]
    folded = [(f"manual/{finger.name}_folded.svg", "flaps", None) for finger in design.fingers]
    for path, check, flange in (*drawings, *folded):
        name = f"manual_pages.{check}"
        try:
            drawing = _read(outputs / path)
            wrong = list(_astray(drawing, flange) if flange else _misnumbered(drawing))
        except (OSError, ElementTree.ParseError, ValueError, LookupError) as error:
            yield unreadable(name, path, f"cannot be read: {error!r:.120}")
            continue
        yield count(name, path, wrong, f"{check} with other words")


def _astray(drawing: _Drawing, flange: Flange) -> Iterator[str]:
    """Contacts, and the pin, from which a leader goes to other words than their own."""
    wanted = {contact.at: (contact.number, contact.carries) for contact in flange.contacts}
    (x, y), radius = flange.pin_at, flange.pin_mm / 2
    for start, words in (*wanted.items(), ((x, y), _PIN)):
        room = _AT_MM + (radius if words is _PIN else 0.0)
        place = shapely.Point(start[0], -start[1])
        ends = [
            line.coords[-1]
            for line in drawing.leaders
            if shapely.Point(line.coords[0]).distance(place) < room
        ]
        if [_beside(drawing, *end) for end in ends] != [words]:
            yield " ".join(words)
    if len(drawing.leaders) != len(wanted) + 1:
        yield f"{len(drawing.leaders)} leaders"


def _beside(drawing: _Drawing, x: float, y: float) -> tuple[str, ...]:
    """Words on the line of a leader's end, the nearest first."""
    line = [w for w in drawing.words if w[1] > x and abs(w[2] - _UP_MM - y) < _LINE_MM]
    return tuple(words for words, _, _ in sorted(line, key=lambda w: w[1]))


def _misnumbered(drawing: _Drawing) -> Iterator[str]:
    """Flaps, laid one on the other in the order of folding, whose number is not on what is seen of
    them."""
    areas = drawing.areas
    numbers = {words: shapely.Point(x, y - _UP_MM) for words, x, y in drawing.words}
    if len(numbers) != len(drawing.words) or len(numbers) != len(areas) or not areas:
        yield f"{len(drawing.words)} numbers of {len(areas)} flaps"
        return
    for k, area in enumerate(areas):
        seen = area.difference(shapely.union_all(list(areas[k + 1 :])))
        number = numbers.get(str(k + 1))
        if number is None or not seen.covers(number):
            yield str(k + 1)


def _read(path: Path) -> _Drawing:
    root = ElementTree.parse(path).getroot()
    words = [
        (t.text or "", float(t.get("x", "")), float(t.get("y", "")))
        for t in root.iter(f"{_SVG}text")
    ]
    leaders, areas = [], []
    for line in root.findall(f"{_SVG}path"):
        places = np.array(_PLACE.findall(line.get("d", "")), dtype=np.float64)
        if line.get("fill") == "none":
            drawn = shapely.LineString(places) if line.get("d", "").count("M") == 1 else None
            leaders += [drawn] if drawn and not drawn.is_closed else []
        elif len(places) > 2:
            areas.append(shapely.Polygon(places))
    return _Drawing(tuple(words), tuple(leaders), tuple(areas))
