"""Text and shapes of KiCad's board files, on its page: mm, y down, angles counter-clockwise."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Union

import shapely
from shapely import LineString, Polygon, affinity, box
from shapely import Point as Dot
from shapely.geometry.base import BaseGeometry

from lumitip_fab.errors import OutputError

Node = list[Union["Node", str]]
_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|[()]|[^\s()"]+')
_ESCAPE = re.compile(r"\\(.)", re.DOTALL)


def read_nodes(path: Path) -> Node:
    """The file's one expression: `["kicad_pcb", ["version", "20211014"], …]`.

    Raises:
        OutputError: if it cannot be read or is no such expression.
    """
    try:
        return nodes(read_text(path))
    except ValueError as error:
        raise OutputError(f"{path}: {error}") from error


def read_text(path: Path) -> str:
    """The text of a file.

    Raises:
        OutputError: if it cannot be read.
    """
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise OutputError(f"{path}: cannot be read: {error}") from error


def nodes(text: str) -> Node:
    """The one expression of a text.

    Raises:
        ValueError: if it is no such expression.
    """
    whole: Node = []
    open_: list[Node] = [whole]
    for token in _TOKEN.findall(text):
        if token == "(":
            open_.append([])
            open_[-2].append(open_[-1])
        elif token == ")":
            if len(open_) == 1:
                raise ValueError("is no KiCad file: a ')' too many")
            open_.pop()
        else:
            open_[-1].append(_ESCAPE.sub(r"\1", token[1:-1]) if token[0] == '"' else token)
    if len(open_) != 1 or len(whole) != 1 or not isinstance(whole[0], list) or not whole[0]:
        raise ValueError("is no KiCad file, or is cut short")
    return whole[0]


def children(node: Node, *names: str) -> Iterator[Node]:
    """The nodes below one that have any of these names."""
    for child in node:
        if isinstance(child, list) and child and child[0] in names:
            yield child


def child(node: Node, name: str) -> Node | None:
    """The first node below one that has a name."""
    return next(children(node, name), None)


def words(node: Node | None) -> list[str]:
    """The plain values of a node, without its name."""
    return [value for value in (node or [])[1:] if isinstance(value, str)]


def title_block(root: Node) -> dict[str, str]:
    """Texts of a page's title block by name, a comment by its number: `{"rev": "A", "1": …}`."""
    block = child(root, "title_block") or []
    texts = {str(node[0]): words(node) for node in children(block, "title", "date", "rev")}
    comments = (words(node) for node in children(block, "comment"))
    return {
        name: "".join(text) for name, text in (*texts.items(), *((w[0], w[1:]) for w in comments))
    }


def numbers(node: Node | None) -> tuple[float, ...]:
    """The values of a node that are numbers."""
    return tuple(float(value) for value in words(node) if _is_number(value))


def _is_number(value: str) -> bool:
    try:
        float(value)
    except ValueError:
        return False
    return True


Point = tuple[float, float]
STEPS = 32
"""Chords of a quarter circle: within 0.4 µm at a radius of 1 mm."""


@dataclass(frozen=True)
class Place:
    """Where a footprint is."""

    at: Point
    angle_deg: float

    @classmethod
    def of(cls, node: Node) -> "Place":
        """The position of a node."""
        x, y, *turn = numbers(child(node, "at"))
        return cls((x, y), turn[0] if turn else 0.0)

    def of_pad(self, node: Node) -> Point:
        """The middle of one of its pads."""
        x, y, *_ = numbers(child(node, "at"))
        dx, dy = turned((x, y), self.angle_deg)
        return self.at[0] + dx, self.at[1] + dy


def turned(point: Point, angle_deg: float) -> Point:
    """A point turned about the origin."""
    turn = math.radians(angle_deg)
    c, s = math.cos(turn), math.sin(turn)
    return point[0] * c + point[1] * s, point[1] * c - point[0] * s


def disc(at: tuple[float, ...], diameter_mm: float) -> Polygon:
    """A round spot."""
    return Dot(at[:2]).buffer(diameter_mm / 2, quad_segs=STEPS)


def polygon(points: Node) -> BaseGeometry:
    """An area by its corners; cuts to its holes are closed again."""
    corners = [p for node in children(points, "xy", "arc") for p in _corners(node)]
    return Polygon(corners).buffer(0) if len(corners) > 2 else Polygon()


def outline(node: Node) -> BaseGeometry:
    """The line that a drawing or a track follows."""
    kind = str(node[0])
    if kind.endswith("poly"):
        ring = polygon(child(node, "pts") or [])
        return ring.boundary
    if kind.endswith("circle"):
        centre, edge = (numbers(child(node, name)) for name in ("center", "end"))
        return disc(centre, 2 * math.dist(centre, edge)).exterior
    start, end = (numbers(child(node, name)) for name in ("start", "end"))
    if kind.endswith("rect"):
        return box(*start, *end).exterior
    if middle := numbers(child(node, "mid")):
        return _arc(start, middle, end)
    if angle := numbers(child(node, "angle")):  # KiCad 5: about `start`, from `end`
        return _swept(start, end, angle[0]) if kind.endswith("arc") else LineString((start, end))
    return LineString((start, end)) if start != end else Dot(start)


def inked(node: Node) -> BaseGeometry:
    """A drawing as its pen draws it, filled if it is."""
    line = outline(node)
    width = numbers(child(node, "width")) or numbers(child(child(node, "stroke") or [], "width"))
    drawn = line.buffer((width or (0.0,))[0] / 2, quad_segs=STEPS)
    fill = words(child(node, "fill"))
    solid = str(node[0]).endswith("poly") if not fill else fill[0] not in {"none", "no"}
    if solid and not str(node[0]).endswith(("line", "arc")):
        drawn = shapely.union_all([drawn, *shapely.get_parts(shapely.polygonize([line]))])
    return drawn


def pad(node: Node, at: Point) -> BaseGeometry:
    """The copper of a pad."""
    shape, angle = str(node[3]), (*numbers(child(node, "at")), 0.0)[2]
    width, height = (*numbers(child(node, "size")), 0.0)[:2]
    if shape == "circle":
        flat: BaseGeometry = disc((0.0, 0.0), width)
    elif shape == "oval":
        flat = _rounded(width, height, min(width, height) / 2)
    elif shape == "roundrect":
        ratio = (numbers(child(node, "roundrect_rratio")) or (0.25,))[0]
        flat = _rounded(width, height, ratio * min(width, height))
    else:
        flat = box(-width / 2, -height / 2, width / 2, height / 2)
    if shape == "custom":
        drawn = (inked(n) for n in child(node, "primitives") or [] if isinstance(n, list))
        flat = shapely.union_all([flat, *drawn])
    offset = numbers(child(child(node, "drill") or [], "offset")) or (0.0, 0.0)
    flat = affinity.translate(flat, *offset)
    # y points down, so that a turn that looks counter-clockwise is a negative one.
    return affinity.translate(affinity.rotate(flat, -angle, origin=(0, 0)), *at)


def _rounded(width: float, height: float, radius: float) -> Polygon:
    x, y = width / 2 - radius, height / 2 - radius
    core = box(-x, -y, x, y) if x > 0 and y > 0 else LineString(((-x, -y), (x, y)))
    return core.buffer(radius, quad_segs=STEPS)


def _corners(node: Node) -> list[Point]:
    if node[0] == "xy":
        x, y = numbers(node)
        return [(x, y)]
    ends = (numbers(child(node, name)) for name in ("start", "mid", "end"))
    return [(x, y) for x, y in shapely.get_coordinates(_arc(*ends)).tolist()]


def _arc(start: tuple[float, ...], middle: tuple[float, ...], end: tuple[float, ...]) -> LineString:
    """The arc through three points."""
    (ax, ay), (bx, by), (cx, cy) = start, middle, end
    twice = 2 * ((ax - cx) * (by - cy) - (bx - cx) * (ay - cy))
    if abs(twice) < 1e-12:
        return LineString((start, middle, end))
    p = (ax - cx) * (ax + cx) + (ay - cy) * (ay + cy)
    q = (bx - cx) * (bx + cx) + (by - cy) * (by + cy)
    centre = ((p * (by - cy) - q * (ay - cy)) / twice, (q * (ax - cx) - p * (bx - cx)) / twice)
    first, past, last = (math.atan2(y - centre[1], x - centre[0]) for x, y in (start, middle, end))
    sweep = (last - first) % math.tau
    if (past - first) % math.tau > sweep:
        sweep -= math.tau
    return _swept(centre, start, math.degrees(sweep))


def _swept(centre: tuple[float, ...], start: tuple[float, ...], sweep_deg: float) -> LineString:
    """An arc about a centre, from a point, by an angle in which y down is positive."""
    radius, first = math.dist(centre, start), math.atan2(start[1] - centre[1], start[0] - centre[0])
    steps = max(2, math.ceil(abs(sweep_deg) / 90 * STEPS))
    angles = [first + math.radians(sweep_deg) * i / steps for i in range(steps + 1)]
    return LineString(
        [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]
    )
