"""Where one side of a board is free for silkscreen."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
import shapely
from shapely import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from lumitip_fab.boards.geometry import placed, placed_pads
from lumitip_fab.boards.model import Placement, Side, Text
from lumitip_fab.boards.openings import opening_mm
from lumitip_fab.boards.strokes import text_strokes, upright

_SHORTEST_MM = 0.5
_MOST_LATE = 32  # shapes beside the tree of those before, which are looked at one by one


@dataclass
class Clear:
    """What is taken on one side of a board while its silkscreen is drawn."""

    inside: Polygon
    """Where silkscreen may be at all."""
    gap_mm: float
    """Silkscreen to openings of the mask, to holes, to the board's edge and to other silkscreen."""
    line_mm: float
    """Width of lines."""
    taken: list[BaseGeometry] = field(default_factory=list)
    _tree: shapely.STRtree | None = None
    _in_tree: int = 0

    @classmethod
    def of(cls, board: Placement, side: Side, gap_mm: float, line_mm: float) -> "Clear":
        """A side with its pads, its holes and the lines of its footprints."""
        box = board.outline.grown(-board.corner_mm)
        inner = shapely.box(box.x_min_mm, box.y_min_mm, box.x_max_mm, box.y_max_mm)
        rim = inner.buffer(board.corner_mm - gap_mm, quad_segs=16)
        taken: list[BaseGeometry] = [
            shapely.Point(at).buffer(board.hole_mm / 2) for at in board.holes
        ]
        for part in board.components:
            open_mm = opening_mm(part)
            taken += [pad.area.buffer(open_mm) for pad in placed_pads(part) if side in pad.sides]
            if part.side == side:
                taken += [
                    LineString([placed(part, *p) for p in s.points]).buffer(s.width_mm / 2)
                    for s in part.footprint.silk
                ]
        return cls(rim, gap_mm, line_mm, taken)

    def free(self, shape: BaseGeometry) -> bool:
        """Whether a shape keeps its gap to all that is taken."""
        if not self.inside.contains(shape):
            return False
        if self._tree is None or len(self.taken) > self._in_tree + _MOST_LATE:
            self._tree, self._in_tree = shapely.STRtree(self.taken), len(self.taken)
        if self._tree.query(shape, predicate="dwithin", distance=self.gap_mm).size:
            return False
        late = self.taken[self._in_tree :]
        return not late or float(np.min(shapely.distance(shape, late))) > self.gap_mm

    def take(self, *shapes: BaseGeometry) -> None:
        """Take room."""
        self.taken += shapes

    def taking(self, shapes: Iterable[BaseGeometry]) -> "Clear":
        """The same side, with less room, to try what fits."""
        return Clear(self.inside, self.gap_mm, self.line_mm, [*self.taken, *shapes])

    def clipped(self, lines: Sequence[LineString]) -> list[LineString]:
        """The free pieces of lines that are long enough to see."""
        keep_out = shapely.union_all(
            shapely.buffer(np.array(self.taken, dtype=object), self.gap_mm + self.line_mm / 2)
        )
        rest = shapely.intersection(
            shapely.difference(np.array(lines, dtype=object), keep_out),
            self.inside.buffer(-self.line_mm / 2),
        )
        pieces = [p for p in shapely.get_parts(rest) if p.length >= _SHORTEST_MM]
        return [shapely.set_precision(p, 1e-6) for p in pieces]


def extent(text: Text, side: Side) -> Polygon:
    """The upright rectangle round a text as it will be drawn."""
    at, angle = (text.x_mm, text.y_mm), upright(text.angle_deg, side)
    strokes = text_strokes(text.text, text, at, angle, side)
    points = [point for stroke in strokes for point in stroke.points]
    x, y = zip(*points, strict=True)
    half = text.width_mm / 2
    return shapely.box(min(x) - half, min(y) - half, max(x) + half, max(y) + half)
