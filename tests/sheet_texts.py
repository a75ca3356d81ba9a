"""Texts of a `.kicad_sch` that are written over other texts, symbols or wires. mm, y down."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import combinations, pairwise
from pathlib import Path

from lumitip_fab.checks.readers.kicad_shapes import (
    Node,
    child,
    children,
    numbers,
    read_nodes,
    words,
)

LETTER = 1.0
"""Width of a letter by its height: a little more than the mean of KiCad's font."""
Point = tuple[float, float]


@dataclass(frozen=True)
class Box:
    """The room of a thing on the sheet."""

    name: str
    kind: str
    """`"field"`, `"text"`, `"body"` or `"wire"`."""
    x0: float
    y0: float
    x1: float
    y1: float

    def meets(self, other: "Box") -> bool:
        """Whether the two overlap."""
        return (
            min(self.x1, other.x1) - max(self.x0, other.x0) > 0.01
            and min(self.y1, other.y1) - max(self.y0, other.y0) > 0.01
        )

    def holds(self, other: "Box") -> bool:
        """Whether the other is within this one."""
        x = self.x0 <= other.x0 and other.x1 <= self.x1
        return x and self.y0 <= other.y0 and other.y1 <= self.y1


def overlaps(sheet: Path) -> list[str]:
    """Each reference or value that is written over something, and each label or other text over a
    text or a symbol.

    A chip's value may stand inside its own box.
    """
    boxes = list(_boxes(read_nodes(sheet)))
    return [
        f"{one.name} over {other.name}"
        for one, other in combinations(boxes, 2)
        if one.meets(other) and _matters(one, other)
    ]


def _matters(one: Box, other: Box) -> bool:
    kinds = {one.kind, other.kind}
    inside = kinds == {"field", "body"} and other.name == one.name.replace("value", "body")
    return ("field" in kinds or kinds in ({"text"}, {"text", "body"})) and not (
        inside and other.holds(one)
    )


def _boxes(whole: Node) -> Iterator[Box]:
    library = {words(s)[0]: s for s in children(child(whole, "lib_symbols") or [], "symbol")}
    for symbol in children(whole, "symbol"):
        yield from _symbol(symbol, library[words(child(symbol, "lib_id"))[0]])
    for label in children(whole, "global_label"):
        x, y, angle = numbers(child(label, "at"))
        long = _wide(words(label)[0], 1.27) + 1.27
        along = {0: (long, 0), 90: (0, -long), 180: (-long, 0), 270: (0, long)}[int(angle)]
        yield _around(f"label {words(label)[0]}", "text", [(x, y), (x + along[0], y + along[1])], 1)
    for text in children(whole, "text"):
        x, y, _ = numbers(child(text, "at"))
        high = _high(text)
        corners = [(x, y - high), (x + _wide(words(text)[0], high), y)]
        yield _around(f"text {words(text)[0]}", "text", corners)
    for kind in ("wire", "polyline"):
        for line in children(whole, kind):
            for start, end in pairwise(_points(line)):
                yield _around(f"{kind} at {start}", "wire", [start, end], 0.05)


def _symbol(symbol: Node, shape: Node) -> Iterator[Box]:
    x, y, angle = numbers(child(symbol, "at"))
    turn = math.radians(angle)
    cos, sin = round(math.cos(turn)), round(math.sin(turn))

    def placed(at: Point) -> Point:
        return x + at[0] * cos - at[1] * sin, y - at[0] * sin - at[1] * cos

    fields = {words(field)[0]: field for field in children(symbol, "property")}
    ref = words(fields["Reference"])[1]
    for name, field in fields.items():
        if "hide" not in words(child(field, "effects")):
            at = numbers(child(field, "at"))
            high = _high(field)
            half = _wide(words(field)[1], high) / 2
            corners = [(at[0] + side * half, at[1] + side * high / 2) for side in (-1, 1)]
            yield _around(f"{name.lower()} of {ref}", "field", corners)
    for unit in children(shape, "symbol"):
        drawn = [point for part in unit[1:] for point in _outline(part)]
        if drawn:
            yield _around(f"body of {ref}", "body", list(map(placed, drawn)))
        for pin in children(unit, "pin"):
            yield _pin(ref, pin, placed)


def _pin(ref: str, pin: Node, placed: Callable[[Point], Point]) -> Box:
    x, y, angle = numbers(child(pin, "at"))
    (long,) = numbers(child(pin, "length"))
    turn = math.radians(angle)
    inner = x + long * math.cos(turn), y + long * math.sin(turn)
    name = f"pin {words(child(pin, 'number'))[0]} of {ref}"
    return _around(name, "wire", [placed((x, y)), placed(inner)], 0.05)


def _outline(part: Node | str) -> Iterator[Point]:
    """Corners of what is drawn of a symbol."""
    if not isinstance(part, list):
        return
    if part[0] == "rectangle":
        yield from (_point(child(part, key)) for key in ("start", "end"))
    elif part[0] == "polyline":
        yield from _points(part)
    elif part[0] == "circle":
        (x, y), (r,) = _point(child(part, "center")), numbers(child(part, "radius"))
        yield from ((x - r, y - r), (x + r, y + r))


def _around(name: str, kind: str, points: list[Point], more: float = 0.0) -> Box:
    xs, ys = zip(*points, strict=True)
    return Box(name, kind, min(xs) - more, min(ys) - more, max(xs) + more, max(ys) + more)


def _wide(text: str, high: float) -> float:
    return len(text) * LETTER * high


def _high(node: Node) -> float:
    return numbers(child(child(child(node, "effects") or [], "font") or [], "size"))[0]


def _point(node: Node | None) -> Point:
    x, y, *_ = numbers(node)
    return x, y


def _points(line: Node) -> list[Point]:
    return [_point(xy) for xy in children(child(line, "pts") or [], "xy")]
