"""A card over the cells of a finger, and the picture of it that the live view must show."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
import shapely

from lumitip_fab.design import Finger
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.cut import rings_of
from lumitip_fab.scenes.dimensions import circle
from lumitip_fab.scenes.drawing import Points, Sheet, View
from lumitip_fab.scenes.finger_views import paint

ANGLE_DEG = 25.0
"""Of the card's edge."""
_WAY = np.array([math.cos(math.radians(ANGLE_DEG)), math.sin(math.radians(ANGLE_DEG))])
LIGHT, DARK = (240, 229, 115), (3, 32, 77)  # as in the live view
_FRONT = View(np.eye(3)).enlarged(1.1)
_WORDS = 1.3
_CARD, _EDGE_MM = "#f3ead2", 60.0
_BESIDE_MM, _PAST_MM, _NAME_MM = 14.0, 12.0, 6.5
_TURNS = np.arange(6) * math.pi / 3
_HEXAGON = 2 / math.sqrt(3) * np.column_stack([np.cos(_TURNS), np.sin(_TURNS)])
"""Of the width 2, two of its corners on x."""
_SHARE = 0.94  # of the room of a cell in the picture


def card_view(finger: Finger, layers: Mapping[str, Mesh], holes_mm: Sequence[float]) -> str:
    """The finger from the front, its tip up, under a card; beside it the cells as they are read.

    Args:
        finger: for its cells.
        layers: interface, backing, film and so on in the sensor frame, from the back.
        holes_mm: size of the hole at each cell.
    """
    sheet, cells = Sheet(words_scale=_WORDS), np.array(finger.cells)
    seen = {k: layers[k] for k in ("interface", "backing", "film") if k in layers}
    view = _FRONT.fitted(seen.values())
    scale = view.scale
    with sheet.group("finger"):
        paint(sheet, view, seen)
        for cell, hole_mm in zip(cells, holes_mm, strict=True):
            sheet.area([scale * circle((cell[0], cell[1]), hole_mm / 2)], "part", "#fff")
    left, right = float(sheet.low[0]), float(sheet.high[0])
    middle, radius = cells.mean(axis=0), _room_mm(cells) / 2
    card = _below(middle) & shapely.box(
        left / scale - _PAST_MM, cells[:, 1].min() - _PAST_MM, right / scale + 2.0, 999.0
    )
    with sheet.group("card"):
        sheet.area([scale * ring for ring in rings_of(card)], "body", _CARD)
    aside = np.array([right + _BESIDE_MM + scale * (radius - float(cells[:, 0].min())), 0.0])
    with sheet.group("picture"):
        for cell in cells:
            room = shapely.Polygon(cell + _SHARE * radius * _HEXAGON)
            free = 1.0 - (room & card).area / room.area
            sheet.area([scale * np.array(room.exterior.coords) + aside], "part", _colour(free))
    half = scale * (np.ptp(cells[:, 0]) / 2 + 2 * radius) / _WAY[0]
    at = scale * middle + aside
    sheet.lines([np.array([at - half * _WAY, at + half * _WAY])], "estimate")
    foot = float(sheet.low[1]) - _NAME_MM
    for x, name in ((scale * middle[0], "The card, seen from the front"), (at[0], "The picture")):
        sheet.words(float(x), foot, name, "name", "middle")
    sheet.cover(float(at[0]), foot - 1.0)
    return sheet.svg({"data-scale": scale, "data-angle-deg": ANGLE_DEG})


def _below(middle: Points) -> shapely.Polygon:
    """What lies under a slanted line through a place."""
    ends = [middle - _EDGE_MM * _WAY, middle + _EDGE_MM * _WAY]
    down = 2 * _EDGE_MM * np.array([_WAY[1], -_WAY[0]])
    return shapely.Polygon([*ends, *(end + down for end in reversed(ends))])


def _room_mm(cells: Points) -> float:
    """The least distance of two cells."""
    apart = np.linalg.norm(cells[:, None] - cells, axis=2)
    return float(apart[apart > 0].min())


def _colour(free: float) -> str:
    """Between dark and light by the share of a cell that is free."""
    mixed = (round(dark + free * (light - dark)) for dark, light in zip(DARK, LIGHT, strict=True))
    return "#" + "".join(f"{value:02x}" for value in mixed)
