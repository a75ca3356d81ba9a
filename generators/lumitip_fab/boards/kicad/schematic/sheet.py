"""Symbols and wires of a sheet with their places, and the paper sizes. mm, y down, 1.27 mm grid."""

from dataclasses import dataclass, field
from itertools import pairwise

from lumitip_fab.design import Point


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
    powers: int = 0

    def power(self, net: str, at: Point, angle_deg: int = 0) -> None:
        """A symbol that gives a wire's end the name of a supply; ground hangs below it."""
        self.powers += 1
        beyond = (0.0, 4.572) if net == "GND" else (0.0, -3.81)
        shown = beyond if net != "PWR_FLAG" else None
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
_TITLE_MM = 35.0  # of the title block, at the bottom right
_PAPERS = {
    "A4": (297, 210),
    "A3": (420, 297),
    "A2": (594, 420),
    "A1": (841, 594),
    "A0": (1189, 841),
}


def paper_for(width_mm: float, height_mm: float) -> tuple[str, int]:
    """The smallest paper for a drawing, and its place among them; A0 for what is larger."""
    for place, (name, (wide, high)) in enumerate(_PAPERS.items()):
        if width_mm + 2 * MARGIN_MM <= wide and height_mm + MARGIN_MM + _TITLE_MM <= high:
            return name, place
    return "A0", len(_PAPERS)
