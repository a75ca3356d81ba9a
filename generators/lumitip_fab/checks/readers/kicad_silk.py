"""The silkscreen of a `.kicad_pcb`: lines and words. Places are on KiCad's page: mm, y down."""

from collections.abc import Iterator
from dataclasses import dataclass

from shapely import affinity
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.readers import kicad_shapes as shapes
from lumitip_fab.checks.readers.kicad_shapes import Node, child, children, numbers, words

_SIDES = {"F.SilkS": True, "F.Silkscreen": True, "B.SilkS": False, "B.Silkscreen": False}
_BODY = {"F.Fab": True, "B.Fab": False}
_DRAWN = ("line", "rect", "circle", "arc", "poly")
_NOWHERE = shapes.Place((0.0, 0.0), 0.0)


@dataclass(frozen=True, eq=False)
class Line:
    """Something drawn."""

    ref: str
    """Part that it belongs to; empty of the board's own."""
    front: bool
    path: BaseGeometry
    area: BaseGeometry
    """As the pen draws it."""
    width_mm: float


@dataclass(frozen=True, eq=False)
class Word:
    """A line of text."""

    ref: str
    """Part that it belongs to; empty of the board's own."""
    front: bool
    text: str
    at: shapes.Point
    """Its middle."""
    angle_deg: float
    height_mm: float
    stroke_mm: float


@dataclass(frozen=True, eq=False)
class Silk:
    """All that is printed on both sides."""

    lines: tuple[Line, ...]
    words: tuple[Word, ...]
    bodies: dict[str, list[BaseGeometry]]
    """Outlines on the assembly drawing, by part."""


def silk(root: Node) -> Silk:
    """The silkscreen of a board."""
    lines = [*_lines(root, "gr", "", _NOWHERE)]
    texts = [*_words(children(root, "gr_text"), "", _NOWHERE)]
    bodies: dict[str, list[BaseGeometry]] = {}
    for part in children(root, "footprint", "module"):
        ref, place = _reference(part), shapes.Place.of(part)
        lines += _lines(part, "fp", ref, place)
        texts += _words(children(part, "fp_text", "property"), ref, place)
        bodies[ref] = [line.path for line in _lines(part, "fp", ref, place, _BODY)]
    return Silk(tuple(lines), tuple(texts), bodies)


def _reference(part: Node) -> str:
    for node in children(part, "fp_text", "property"):
        if words(node)[0].lower() == "reference":
            return words(node)[1]
    return ""


def _side(node: Node, sides: dict[str, bool] = _SIDES) -> bool | None:
    """Whether something is on the front's layer or on the back's, by default of the silkscreen;
    none of other layers."""
    return sides.get((words(child(node, "layer")) or [""])[0])


def _lines(
    owner: Node, kind: str, ref: str, place: shapes.Place, sides: dict[str, bool] = _SIDES
) -> Iterator[Line]:
    for node in children(owner, *(f"{kind}_{shape}" for shape in _DRAWN)):
        if (front := _side(node, sides)) is None:
            continue
        path, area = (_at(place, s) for s in (shapes.outline(node), shapes.inked(node)))
        pen = numbers(child(node, "width")) or numbers(child(child(node, "stroke") or [], "width"))
        yield Line(ref, front, path, area, (pen or (0.0,))[0])


def _words(nodes: Iterator[Node], ref: str, place: shapes.Place) -> Iterator[Word]:
    for node in nodes:
        effects = child(node, "effects") or []
        font = child(effects, "font") or []
        hidden = any("hide" in words(n) or child(n, "hide") for n in (node, effects))
        if (front := _side(node)) is None or hidden or not font:
            continue
        text = words(node)[-1 if node[0] == "gr_text" else 1]
        angle = (*numbers(child(node, "at")), 0.0)[2]
        size, pen = numbers(child(font, "size")), numbers(child(font, "thickness"))
        yield Word(ref, front, text, place.of_pad(node), angle, size[0], (pen or (0.0,))[0])


def _at(place: shapes.Place, shape: BaseGeometry) -> BaseGeometry:
    """A shape of a footprint on the page."""
    turned = affinity.rotate(shape, -place.angle_deg, origin=(0, 0))
    return affinity.translate(turned, *place.at)
