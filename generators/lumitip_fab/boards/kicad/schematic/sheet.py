"""Symbols and wires of a sheet with their places, and the paper sizes. mm, y down, 1.27 mm grid."""

from collections.abc import Callable, Iterable, Mapping, Sequence
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
