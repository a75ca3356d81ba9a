"""The room that a drawing takes, with its texts."""

import math
from collections.abc import Iterator, Mapping

from lumitip_fab.boards.kicad.schematic.sheet import Drawn, Sheet
from lumitip_fab.boards.kicad.schematic.text_size import GRID_MM, text_mm
from lumitip_fab.boards.kicad.sexpr import Node
from lumitip_fab.design import Point

_FLAG_MM = 2.54
"""Length of a label's outline beyond its letters."""


def bounds(sheet: Sheet, shapes: Mapping[str, Node]) -> tuple[Point, Point]:
    """Upper left and lower right corner of all that is drawn."""
    points = [
        *(end for wire in sheet.wires for end in wire),
        *(point for label in sheet.labels for point in _label(*label)),
        *(point for text in sheet.texts for point in _line(*text)),
        *(point for drawn in sheet.symbols for point in _symbol(drawn, shapes[drawn.symbol])),
    ]
    xs, ys = zip(*points, strict=True)
    return (min(xs), min(ys)), (max(xs), max(ys))


def _label(net: str, at: Point, angle_deg: int) -> Iterator[Point]:
    long, half = text_mm(net) + _FLAG_MM, GRID_MM
    turn = math.radians(angle_deg)
    cos, sin = round(math.cos(turn)), round(math.sin(turn))
    for along in (0.0, long):
        for across in (-half, half):
            yield at[0] + along * cos + across * sin, at[1] - along * sin + across * cos


def _line(words: str, at: Point, height_mm: float) -> Iterator[Point]:
    yield at[0], at[1] - height_mm
    yield at[0] + text_mm(words, height_mm), at[1]


def _symbol(drawn: Drawn, shape: Node) -> Iterator[Point]:
    turn = math.radians(drawn.angle_deg)
    cos, sin = round(math.cos(turn)), round(math.sin(turn))
    for x, y in _places(shape):
        yield drawn.x_mm + x * cos - y * sin, drawn.y_mm - x * sin - y * cos
    for words, beside in ((drawn.ref, drawn.ref_at), (drawn.value, drawn.value_at)):
        if beside is not None:
            x, y, half = drawn.x_mm + beside[0], drawn.y_mm + beside[1], text_mm(words) / 2
            yield x - half, y - GRID_MM / 2
            yield x + half, y + GRID_MM / 2


def _places(node: Node) -> Iterator[Point]:
    """Corners of a symbol's lines, and the outer ends of its pins."""
    for value in node[1:]:
        if not isinstance(value, tuple) or value[0] == "property":
            continue
        if value[0] in ("xy", "start", "end", "center", "at"):
            x, y = (float(v) for v in value[1:3] if isinstance(v, int | float))
            yield x, y
        else:
            yield from _places(value)
