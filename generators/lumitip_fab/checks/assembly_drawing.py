"""Assembly drawings: every part of the board's file is drawn in its place, with its reference on it
and its mark at pad 1."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree as XmlTree

import shapely

from lumitip_fab.checks.board_read import ReadBoard, names_of, read_closed
from lumitip_fab.checks.readers import MALFORMED
from lumitip_fab.checks.readers.kicad_board import Part
from lumitip_fab.checks.result import Measurement, Subject, unreadable
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError

READS = ("boards/*/*.kicad_pcb", "boards/*/*_assembly_*.svg")
_SVG = "{http://www.w3.org/2000/svg}"
_RING = re.compile(r"M([^MZ]+)Z")
_PLACE = re.compile(r"translate\((-?[\d.]+) (-?[\d.]+)\)")
_OFF_MM = 0.05
"""A drawn middle, of a part with two terminals and of the board's sides."""
_POLAR = re.compile(r"(D|LED|VD|Z|Q|U)\d+")
"""References of parts that work one way round only."""


@dataclass(frozen=True)
class _Drawn:
    body: shapely.Polygon
    mark: shapely.Polygon | None
    words: str
    at: shapely.Point
    """Of the words."""


@dataclass(frozen=True)
class _Drawing:
    board: shapely.Polygon
    parts: dict[str, _Drawn]


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """The drawings of every board."""
    for name in names_of(design):
        yield from measure_board(outputs, design, name)


def measure_board(outputs: Path, design: Design, name: str) -> Iterator[Measurement]:
    """Both drawings of a board; one of the back only where it has parts."""
    try:
        read = read_closed(outputs, design, name)
    except OutputError as error:
        yield unreadable("assembly_drawing.readable", f"boards/{name}", str(error))
        return
    for side in ("front", "back"):
        mounted = [p for p in read.board.parts if p.bought and p.front == (side == "front")]
        if mounted or side == "front":
            yield from _side(outputs, read, side, mounted)


def _side(outputs: Path, read: ReadBoard, side: str, mounted: list[Part]) -> Iterator[Measurement]:
    path = f"boards/{read.name}/{read.name}_assembly_{side}.svg"
    of = Subject("assembly_drawing", path)
    try:
        drawing = _read(outputs / path)
    except (OSError, XmlTree.ParseError, *MALFORMED) as error:
        yield unreadable("assembly_drawing.readable", path, f"cannot be read: {error!s:.120}")
        return
    sizes = [
        (right - left, low - high)
        for left, high, right, low in (drawing.board.bounds, read.outline.bounds)
    ]
    yield of.figure("outline", math.dist(*sizes), 0, _OFF_MM, "mm", "off the board's size")
    refs = {part.ref for part in mounted}
    yield of.count("parts", sorted(refs ^ drawing.parts.keys()), "missing or not on this side")
    seen = [(part, drawing.parts[part.ref]) for part in mounted if part.ref in drawing.parts]
    place = _Placed(read, drawing, side)
    yield of.count("places", [p.ref for p, d in seen if place.is_off(p, d)], "elsewhere")
    words = [p.ref for p, d in seen if d.words != p.ref or not d.body.contains(d.at)]
    yield of.count("words", words, "with another reference, or one beside it")
    yield of.count("marks", [p.ref for p, d in seen if place.is_turned(p, d)], "turned")


class _Placed:
    """Places of the board's file in a drawing."""

    def __init__(self, read: ReadBoard, drawing: _Drawing, side: str) -> None:
        self.of_file = shapely.box(*read.outline.bounds).centroid
        self.of_drawing = shapely.box(*drawing.board.bounds).centroid
        self.sign = 1 if side == "front" else -1

    def at(self, place: tuple[float, float]) -> shapely.Point:
        """Where a place of the file is drawn."""
        return shapely.Point(
            self.of_drawing.x + self.sign * (place[0] - self.of_file.x),
            self.of_drawing.y + place[1] - self.of_file.y,
        )

    def is_off(self, part: Part, drawn: _Drawn) -> bool:
        """Whether a body is elsewhere than its terminals."""
        ends = shapely.MultiPoint([self.at(terminal.at) for terminal in part.terminals])
        middle = drawn.body.centroid
        if len(part.terminals) == 2:
            return bool(middle.distance(shapely.box(*ends.bounds).centroid) > _OFF_MM)
        return not shapely.box(*ends.bounds).buffer(_OFF_MM).contains(middle)

    def is_turned(self, part: Part, drawn: _Drawn) -> bool:
        """Whether a mark is missing or nearer to another terminal than to number 1."""
        if drawn.mark is None:
            return bool(_POLAR.fullmatch(part.ref))
        middle = drawn.mark.centroid
        nearest = min(part.terminals, key=lambda each: middle.distance(self.at(each.at)))
        return nearest.number != "1"


def _read(path: Path) -> _Drawing:
    root = XmlTree.parse(path).getroot()
    board = next(each for each in root.iter(f"{_SVG}path") if each.get("id") == "board")
    groups = [each for each in root.iter(f"{_SVG}g") if "id" in each.attrib]
    parts = {each.attrib["id"]: _drawn(each) for each in groups}
    if len(parts) < len(groups):
        raise ValueError("a part is drawn twice")
    return _Drawing(_area(board), parts)


def _drawn(group: XmlTree.Element) -> _Drawn:
    first, *others = group.iter(f"{_SVG}path")
    marks = [_area(each) for each in others if each.get("class") == "mark"]
    (held,) = group.findall(f"{_SVG}g")
    (words,) = held.iter(f"{_SVG}text")
    found = _PLACE.match(held.attrib["transform"])
    if found is None:
        raise ValueError("a reference has no place")
    at = shapely.Point(float(found[1]), float(found[2]))
    return _Drawn(_area(first), marks[0] if marks else None, words.text or "", at)


def _area(path: XmlTree.Element) -> shapely.Polygon:
    """The outer ring of a path."""
    rings = _RING.findall(path.attrib["d"])
    corners = [[tuple(map(float, c.split())) for c in ring.split("L")] for ring in rings]
    return max((shapely.Polygon(ring) for ring in corners), key=lambda area: area.area)
