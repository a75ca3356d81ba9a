"""Words on the silkscreen of a board beside the fingers, with its parts mounted: under no body, and
each reference nearest to its own part."""

import re
from collections.abc import Iterator

import shapely
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.board_silk import contacts_of, middle_line
from lumitip_fab.checks.readers.kicad_board import Part
from lumitip_fab.checks.readers.kicad_silk import Word
from lumitip_fab.checks.result import Measurement

_HIDDEN_MM2 = 0.02  # of a word, under a body
_NOISE_MM = 0.01
_UNNAMED = re.compile(r"(FID|TP|H)\d+")  # marks, test points and holes have no references


def measure_bodies(read: ReadBoard) -> Iterator[Measurement]:
    """Words that a mounted part covers, but for names of contacts under the part that has them, and
    references that are not nearest to their own part."""
    if not read.auxiliary:
        return
    wrong: list[str] = []
    parts = [part for part in read.board.parts if not _UNNAMED.match(part.ref)]
    for front in (True, False):
        over = {part.ref: _body(read, part) for part in parts if part.front == front}
        areas = {part.ref: _seen(read, part, front) for part in parts}
        contacts = [contact for contact in contacts_of(read) if contact.front == front]
        for word in (word for word in read.board.silk.words if word.front == front):
            line = middle_line(read, word)
            named = [c for c in contacts if c.name == word.text]
            own = min(named, key=lambda c: line.distance(shapely.Point(c.at)), default=None)
            own_ref = own.pad.partition(".")[0] if own else ""
            wrong += _covering(word, line, {r: b for r, b in over.items() if r != own_ref})
            if word.text in areas and not own:
                wrong += _nearer(word.text, line, areas)
    yield read.count("silk_bodies", wrong, "words")


def _covering(word: Word, line: BaseGeometry, bodies: dict[str, BaseGeometry]) -> Iterator[str]:
    """The body that a word lies under."""
    area = line.buffer(word.height_mm / 2, cap_style="flat")
    for ref, body in bodies.items():
        if area.intersection(body).area > _HIDDEN_MM2:
            yield f"{word.text} is under {ref}"


def _nearer(ref: str, line: BaseGeometry, areas: dict[str, BaseGeometry]) -> Iterator[str]:
    """The part that a reference is nearer to than to its own."""
    apart = {other: area.distance(line) for other, area in areas.items() if not area.is_empty}
    nearest = min(apart, key=lambda other: apart[other], default=ref)
    if apart.get(ref, 0.0) > apart.get(nearest, 0.0) + _NOISE_MM:
        yield f"{ref} stands at {nearest}"


def _body(read: ReadBoard, part: Part) -> BaseGeometry:
    """The body as the board's file draws it, with a shroud; nothing of bare copper."""
    lines = read.board.silk.bodies.get(part.ref, ()) if part.bought else ()
    flat = [shapely.LineString(read.sensor(shapely.get_coordinates(line))) for line in lines]
    joined = shapely.union_all(shapely.set_precision(flat, 1e-4)) if flat else shapely.Polygon()
    return shapely.union_all(shapely.get_parts(shapely.polygonize([joined])))


def _seen(read: ReadBoard, part: Part, front: bool) -> BaseGeometry:
    """Body and pads of a part, as far as they are on a side."""
    layer = read.board.layers[0 if front else -1]
    coppers = [t.copper for t in part.terminals if t.copper and layer in t.copper.layers]
    pads = [shapely.transform(copper.area, read.sensor) for copper in coppers]
    return shapely.union_all([*pads, *([_body(read, part)] if part.front == front else [])])
