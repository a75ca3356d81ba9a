"""What the twin shows at an address: scenes that move, each a pure function of its way."""

from dataclasses import dataclass, replace

import numpy as np

from lumitip.layout import Layout
from lumitip.twin.scene import Cable, Corner, Disc, HalfPlane, Scene, Sheet, Thing

SHAPES = ("demo", "disc", "edge", "corner", "cable", "sheet", "empty")
_SHOWN = ("disc", "edge", "corner", "cable")
_DEMO_MM = 60.0  # way of each shape before the demonstration shows the next


@dataclass(frozen=True)
class Matter:
    """What the shapes are made of."""

    diameter_mm: float = 3.0
    """Of cables."""
    clear: float = 0.0
    diffuse: float = 0.0
    height: float = 0.5


OPAQUE = Matter()


def shown(shape: str, layout: Layout, way_mm: float, matter: Matter) -> Scene:
    """The scene of a shape that has moved this far.

    Args:
        shape: one of `SHAPES`.
        layout: the cells, over which it moves.
        way_mm: how far it has moved (mm).
        matter: what it is made of.
    """
    if shape == "demo":
        turn = int(way_mm // _DEMO_MM)
        return shown(_SHOWN[turn % len(_SHOWN)], layout, way_mm, matter)
    if shape == "empty":
        return ()
    thing = _placed(shape, layout, way_mm, matter.diameter_mm)
    return replace(thing, clear=matter.clear, diffuse=matter.diffuse, height=matter.height)


def _placed(shape: str, layout: Layout, way_mm: float, diameter_mm: float) -> Thing:
    if shape == "sheet":
        return Sheet()
    reach_mm = float(np.hypot(np.ptp(layout.x_mm), np.ptp(layout.y_mm))) / 2.0
    reach_mm = max(reach_mm, layout.pitch_mm)  # a cell alone reaches nowhere
    there = _to_and_fro(way_mm, reach_mm)
    if shape == "disc":
        x_mm = 0.7 * reach_mm * float(np.sin(way_mm / reach_mm))
        y_mm = 0.7 * reach_mm * float(np.sin(1.4 * way_mm / reach_mm))
        return Disc(x_mm, y_mm, 2.4 * layout.pitch_mm)
    if shape == "cable":
        turn_deg = 25.0 * float(np.sin(way_mm / (2.0 * reach_mm))) - 20.0
        return Cable(0.6 * there, turn_deg, diameter_mm=diameter_mm)
    if shape == "edge":
        return HalfPlane(0.6 * there, 20.0 * float(np.sin(way_mm / (3.0 * reach_mm))) - 90.0)
    turn_deg = way_mm / reach_mm * 10.0
    inward = np.radians(turn_deg + 45.0)
    away_mm = 0.4 * np.sqrt(2.0) * there
    return Corner(
        float(away_mm * np.cos(inward)), float(away_mm * np.sin(inward)), turn_deg + 225.0
    )


def _to_and_fro(way_mm: float, reach_mm: float) -> float:
    """A place between -reach and +reach that moves at constant speed."""
    return float(abs((way_mm + reach_mm) % (4.0 * reach_mm) - 2.0 * reach_mm) - reach_mm)
