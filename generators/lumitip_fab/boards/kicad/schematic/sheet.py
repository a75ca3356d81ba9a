"""Symbols, wires and blocks of a sheet with their places, text sizes, joints and papers. mm, y
down, 1.27 mm grid."""

import itertools
import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from lumitip_fab.boards.kicad.sexpr import Node
from lumitip_fab.design import Component, Point


@dataclass(frozen=True)
class Drawn:
    """A symbol on the sheet."""

    symbol: str
    ref: str
    value: str
    x_mm: float
    y_mm: float
    angle_deg: int = 0
    """Counter-clockwise."""
    pins: tuple[str, ...] = ("1", "2")
    ref_at: Point | None = None
    """Where its reference stands, from its own place; hidden if None."""
    value_at: Point | None = None
    unit: int = 1
    """Which of the part's equal units it is."""


@dataclass
class Sheet:
    """A drawing while it grows."""

    symbols: list[Drawn] = field(default_factory=list)
    wires: list[tuple[Point, Point]] = field(default_factory=list)
    junctions: list[Point] = field(default_factory=list)
    labels: list[tuple[str, Point, int]] = field(default_factory=list)
    """Net, place, and angle to which the flag points: 0 right, 90 up, 180 left."""
    texts: list[tuple[str, Point, float]] = field(default_factory=list)
    """Text, place of its lower left, height."""
    frames: list[tuple[Point, Point]] = field(default_factory=list)
    """Upper left and lower right corners."""
    powers: int = 0

    def part(
        self,
        symbol: str,
        part: Component,
        at: Point,
        angle_deg: int = 0,
        pins: tuple[str, ...] = (),
        ref_at: Point | None = None,
        value_at: Point | None = None,
        unit: int = 1,
    ) -> None:
        """A part of the board, by default with all its pads that have a net."""
        pins = pins or tuple(pad for pad, _ in part.nets)
        called = symbol, part.ref, part.value
        self.symbols.append(Drawn(*called, *at, angle_deg, pins, ref_at, value_at, unit))

    def power(self, net: str, at: Point, angle_deg: int = 0, value_at: Point | None = None) -> None:
        """A symbol that gives a wire's end the name of a supply; ground hangs below it."""
        self.powers += 1
        beyond = (0.0, 4.572) if net == "GND" else (0.0, -3.81)
        shown = value_at or beyond if net != "PWR_FLAG" else None
        self.symbols.append(
            Drawn(net, f"#PWR{self.powers:03d}", net, *at, angle_deg, ("1",), value_at=shown)
        )

    def wire(self, *points: Point) -> None:
        """A wire along some corners."""
        self.wires += pairwise(points)

    def flag(self, net: str, at: Point, angle_deg: int) -> None:
        """The name of the net that passes a place."""
        self.labels.append((net, at, angle_deg))


MARGIN_MM = 20.32
TITLE_MM = 35.0  # of the title block, at the bottom right
PAPERS = {
    "A4": (297, 210),
    "A3": (420, 297),
    "A2": (594, 420),
    "A1": (841, 594),
    "A0": (1189, 841),
}


def paper_for(width_mm: float, height_mm: float) -> tuple[str, int]:
    """The smallest paper for a drawing, and its place among them; A0 for what is larger."""
    for place, (name, (wide, high)) in enumerate(PAPERS.items()):
        if width_mm + 2 * MARGIN_MM <= wide and height_mm + MARGIN_MM + TITLE_MM <= high:
            return name, place
    return "A0", len(PAPERS)


@dataclass(frozen=True)
class Block:
    """Parts that are drawn together, and the room that they take."""

    width_mm: float
    height_mm: float
    draw: Callable[[Sheet, Point], None]
    """Draws them; the place is that of their upper left corner."""
    shapes: Mapping[str, Node] = field(default_factory=dict)
    """Their symbols, by name."""


def beside(left: Block, right: Block) -> Block:
    """Two blocks side by side."""

    def draw(sheet: Sheet, at: Point) -> None:
        left.draw(sheet, at)
        right.draw(sheet, (at[0] + left.width_mm, at[1]))

    return Block(
        left.width_mm + right.width_mm,
        max(left.height_mm, right.height_mm),
        draw,
        {**left.shapes, **right.shapes},
    )


def columns(blocks: Iterable[Block]) -> tuple[str, Sheet]:
    """Blocks below each other: name of the paper, and the drawing."""
    blocks, sheet = list(blocks), Sheet()
    wide, y = max(block.width_mm for block in blocks), MARGIN_MM
    for block in blocks:
        block.draw(sheet, (MARGIN_MM, y))
        y += block.height_mm
    paper, _ = paper_for(wide, y - MARGIN_MM)
    return paper, sheet


def grid(first: Block, others: Sequence[Block]) -> tuple[str, Sheet]:
    """Equal blocks in rows to the right of a first one, on the smallest paper that takes them."""
    wide = max(block.width_mm for block in others)
    tall = max(block.height_mm for block in (first, *others))
    shapes = [(across, -(-len(others) // across)) for across in range(1, len(others) + 1)]
    choices = [
        (paper_for(first.width_mm + across * wide, down * tall), across) for across, down in shapes
    ]
    (paper, _), across = min(
        choices, key=lambda choice: (choice[0][1], -len(others) % choice[1], -choice[1])
    )
    sheet = Sheet()
    first.draw(sheet, (MARGIN_MM, MARGIN_MM))
    for i, block in enumerate(others):
        down, right = divmod(i, across)
        x = MARGIN_MM + first.width_mm + right * wide
        block.draw(sheet, (x, MARGIN_MM + down * tall))
    return paper, sheet


GRID_MM = 1.27
_LETTER = 0.95
"""Width of a letter by its height, with the gap to the next: the mean of capitals and digits."""


def text_mm(words: str, height_mm: float = GRID_MM) -> float:
    """Width of a text."""
    return len(words) * _LETTER * height_mm


def up_to_grid(length_mm: float) -> float:
    """The next length of the grid."""
    return math.ceil(round(length_mm / GRID_MM, 6)) * GRID_MM


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


Wire = tuple[Point, Point]


def jointed(wires: Iterable[Wire], pins: Iterable[Point]) -> tuple[list[Wire], list[Point]]:
    """Wires cut at each end and pin that they pass, and the places where three or more meet.

    Args:
        wires: along x or y.
        pins: places of all pins.
    """
    whole = [(_rounded(start), _rounded(end)) for start, end in wires]
    ends = [_rounded(pin) for pin in pins]
    cuts = {end for wire in whole for end in wire} | set(ends)
    pieces: dict[Wire, None] = {}
    for start, end in whole:
        passed = sorted(at for at in cuts if _between(start, at, end))
        for one, other in itertools.pairwise(passed):
            pieces[one, other] = None
    met = Counter([*(end for piece in pieces for end in piece), *ends])
    return list(pieces), [at for at, count in met.items() if count > 2]


def _between(start: Point, at: Point, end: Point) -> bool:
    """Whether a place is on a wire, its ends among it."""
    (x0, x1), (y0, y1) = (sorted((start[i], end[i])) for i in (0, 1))
    return x0 <= at[0] <= x1 and y0 <= at[1] <= y1


def _rounded(at: Point) -> Point:
    return round(at[0], 3), round(at[1], 3)
