"""Fingertips as their makers might draw them, and what is read from them."""

from pathlib import Path
from typing import Any

from build123d import Axis, Box, Cylinder, Location, Shape, Solid

from lumitip_fab.config.load import Input
from lumitip_fab.grippers.features import planes
from lumitip_fab.grippers.proposal import Proposal, propose
from lumitip_fab.grippers.ways import Named


def block(*cut: Shape) -> Solid:
    """A fingertip of 24 x 16 x 50 mm: it stands on z = 0, its pad is at y = -8."""
    body = box((-12, 12), (-8, 8), (0, 50))
    return body - list(cut) if cut else body


def box(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Solid:
    """A box between these places."""
    low, high = zip(x, y, z, strict=True)
    middle = [(a + b) / 2 for a, b in zip(low, high, strict=True)]
    return Box(*(b - a for a, b in zip(low, high, strict=True))).moved(Location(middle))


def bore(x: float, y: float, diameter: float, low: float, high: float) -> Shape:
    """A hole along z."""
    return Cylinder(diameter / 2, high - low).moved(Location((x, y, (low + high) / 2)))


def across(y: float, z: float, diameter: float) -> Shape:
    """A hole along x, through everything."""
    return Cylinder(diameter / 2, 90).rotate(Axis.Y, 90).moved(Location((0, y, z)))


def from_pad(x: float, z: float, diameter: float, low: float, high: float) -> Shape:
    """A hole along y."""
    turned = Cylinder(diameter / 2, high - low).rotate(Axis.X, 90)
    return turned.moved(Location((x, (low + high) / 2, z)))


def bolts(*places: float, y: float = 2.0, hole: float = 4.5, head: float = 8.0) -> list[Shape]:
    """Holes along z with counterbores from 6 mm on, at these x; plain ones without heads."""
    found = [bore(x, y, hole, -1, 51) for x in places]
    return found + [bore(x, y, head, 6, 51) for x in places if head]


def plain(*places: float, y: float = 2.0, hole: float = 4.5) -> list[Shape]:
    """Holes along z without counterbores."""
    return bolts(*places, y=y, hole=hole, head=0.0)


def proposal_of(shape: Shape, config: Input, **named: Any) -> Proposal:
    """What a fingertip shows; `bolts=(1, 2)`, `mount=3` and `pad=1` name holes and faces."""
    return propose(Path("part.step"), shape, config.catalogue.fasteners, Named(**named))


def figures_of(shape: Shape, config: Input, **named: Any) -> dict[str, Any]:
    """The figures that it shows, by name."""
    figures = proposal_of(shape, config, **named).figures
    return {name: figure.value for name, figure in figures.items()}


def face_at(shape: Shape, place: float, axis: int = 1) -> int:
    """Number of the face that is square to an axis of the file at this place."""
    return 1 + next(
        k
        for k, face in enumerate(planes(shape))
        if abs(face.normal[axis]) > 0.99 and abs(face.corners[:, axis].mean() - place) < 0.01
    )
