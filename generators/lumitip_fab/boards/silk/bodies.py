"""Bodies of parts over the silkscreen: what lies under one cannot be read on a mounted board, and a
reference belongs to the part that it is nearest to."""

import math
from functools import cached_property

import numpy as np
import shapely
from shapely import LineString
from shapely.geometry.base import BaseGeometry

from lumitip_fab.boards.model import PlacedComponent, Placement, Text
from lumitip_fab.boards.placed import placed_box, placed_pads
from lumitip_fab.design import Side

_LETTER = 0.6  # width of a letter at least, of its height
_NEARER_MM, _NEARER_TO_CONTACTS_MM = 0.2, 0.02
"""That a reference is nearer to its own part than to others, and than to rows of contacts, which
look different."""
_UNNAMED = ("fiducial", "test point")


class Bodies:
    """The parts of one side of a board as they are seen from there.

    Args:
        board: parts in their places.
        side: the side.
    """

    def __init__(self, board: Placement, side: Side) -> None:
        self.side = side
        self.parts = [part for part in board.components if part.kind not in _UNNAMED]

    def hide(self, area: BaseGeometry, but: str = "") -> bool:
        """Whether an area lies under a body; that of the part `but` is not looked at."""
        return any(ref != but and area.intersects(body) for ref, body in self.over.items())

    def misleads(self, text: Text) -> bool:
        """Whether a reference is not nearer to its own part than to all others."""
        refs = [part.ref for part in self.parts]
        apart = shapely.distance(self._seen, _middle(text))
        own = refs.index(text.text)
        nearer = [_NEARER_TO_CONTACTS_MM if p.contacts else _NEARER_MM for p in self.parts]
        return bool(np.any(np.delete(apart - nearer, own) < apart[own]))

    @cached_property
    def over(self) -> dict[str, BaseGeometry]:
        """Bodies, with shrouds, by reference."""
        return {
            part.ref: _body(part) for part in self.parts if part.side == self.side and part.part
        }

    @cached_property
    def _seen(self) -> list[BaseGeometry]:
        """Body and pads of each part on this side; nothing of parts that are not seen."""
        empty = shapely.Polygon()
        return [
            shapely.union_all(
                [
                    self.over.get(part.ref, empty),
                    *(pad.area for pad in placed_pads(part) if self.side in pad.sides),
                ]
            )
            for part in self.parts
        ]


def _body(part: PlacedComponent) -> BaseGeometry:
    shape = part.footprint
    boxes = [shape.body, *([shape.shroud.box] if shape.shroud else [])]
    return shapely.union_all([shapely.box(*placed_box(part, box).bounds_mm) for box in boxes])


def _middle(text: Text) -> LineString:
    """Along the middle of a text, from its first letter to its last."""
    turn, half = math.radians(text.angle_deg), _LETTER * text.height_mm * len(text.text) / 2
    dx, dy = half * math.cos(turn), half * math.sin(turn)
    return LineString([(text.x_mm - dx, text.y_mm - dy), (text.x_mm + dx, text.y_mm + dy)])
