"""Both sides of a board while their silkscreen is drawn, and where it is free."""

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np
import shapely
from shapely import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from lumitip_fab.boards.model import SIDES, Placement, Stroke, Text, opening_mm
from lumitip_fab.boards.placed import placed, placed_pads
from lumitip_fab.boards.silk.bodies import Bodies
from lumitip_fab.boards.silk.strokes import text_strokes, upright
from lumitip_fab.design import Box, Point, Rules, Side
from lumitip_fab.errors import BuildError

_SHORTEST_MM = 0.5
_MOST_LATE = 32  # shapes beside the tree of those before, which are looked at one by one


Way = tuple[int, int]
LEFT, RIGHT, UP, DOWN = (-1, 0), (1, 0), (0, 1), (0, -1)


@dataclass
class Clear:
    """Occupied area on one side of a board while its silkscreen is drawn."""

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
        inner = shapely.box(*box.bounds_mm)
        rim = inner.buffer(board.corner_mm - gap_mm, quad_segs=16)
        taken: list[BaseGeometry] = [
            shapely.Point(at).buffer(diameter_mm / 2) for at, diameter_mm in board.unplated
        ]
        for part in board.components:
            open_mm = opening_mm(part)
            taken += [pad.area.buffer(open_mm) for pad in placed_pads(part) if side in pad.sides]
            if part.side == side:
                taken += [
                    LineString([placed(part, *p) for p in s.points]).buffer(s.width_mm / 2)
                    for s in part.outline
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
        reach_mm = self.gap_mm + self.line_mm / 2
        whole, taken = np.array(lines, dtype=object), np.array(self.taken, dtype=object)
        tree = shapely.STRtree(taken)
        # What is near each line alone: one area of all that is taken has many corners.
        line, shape = tree.query(whole, predicate="dwithin", distance=reach_mm)
        around = shapely.buffer(taken, reach_mm)
        keep_out = [shapely.union_all(around[shape[line == i]]) for i in range(whole.size)]
        rest = shapely.intersection(
            shapely.difference(whole, np.array(keep_out, dtype=object)),
            self.inside.buffer(-self.line_mm / 2),
        )
        pieces = [p for p in shapely.get_parts(rest) if p.length >= _SHORTEST_MM]
        return [shapely.set_precision(p, 1e-6) for p in pieces]


def extent(text: Text, side: Side) -> Polygon:
    """The upright rectangle round a text as it will be drawn."""
    at_origin = replace(text, x_mm=0.0, y_mm=0.0, angle_deg=upright(text.angle_deg, side))
    left, low, right, high = _bounds_mm(at_origin, side)
    x, y = text.x_mm, text.y_mm
    return shapely.box(x + left, y + low, x + right, y + high)


@lru_cache(maxsize=4096)
def _bounds_mm(text: Text, side: Side) -> tuple[float, float, float, float]:
    """Least and greatest x and y of a text: it is tried at many places."""
    strokes = text_strokes(text.text, text, (text.x_mm, text.y_mm), text.angle_deg, side)
    x, y = zip(*(point for stroke in strokes for point in stroke.points), strict=True)
    half = text.width_mm / 2
    return min(x) - half, min(y) - half, max(x) + half, max(y) + half


_STROKE = 0.15  # of a text's height
_ARROW_MM, _HEAD_MM = 2.4, 0.7
_LATTICE_MM = 1.0  # places tried for what may be anywhere
_AROUND_MM = 1.0  # kept free round arrows


class Page:
    """Where there is room, what is printed, and what finds no room."""

    def __init__(self, board: Placement, rules: Rules) -> None:
        self.board, self.rules = board, rules
        gap, line = rules.silk_gap_mm, rules.silk_line_mm
        self.sides: dict[Side, Clear] = {
            "front": Clear.of(board, "front", gap, line),
            "back": Clear.of(board, "back", gap, line),
        }
        self.bodies = {side: Bodies(board, side) for side in SIDES}
        self.strokes: list[tuple[Side, Stroke]] = []
        self.texts: list[tuple[Side, Text]] = []
        self.lost: list[str] = []

    def text(self, words: str, at: Point, height_mm: float = 0.0, angle_deg: float = 0.0) -> Text:
        """A text, at least as high and as bold as is legible; as small as that by itself."""
        height = max(height_mm, self.rules.silk_text_mm)
        stroke = max(_STROKE * height, self.rules.silk_line_mm)
        return Text(words, *at, height, stroke, angle_deg)

    def length_mm(self, words: str, height_mm: float = 0.0) -> float:
        """Length of a line of text."""
        low, _, high, _ = extent(self.text(words, (0.0, 0.0), height_mm), "front").bounds
        return float(high - low)

    def lines(self, side: Side, lines: Iterable[LineString]) -> None:
        """Print lines."""
        width = self.rules.silk_line_mm
        for line in lines:
            self.strokes.append((side, Stroke(tuple(line.coords), width)))
            self.sides[side].take(line.buffer(width / 2))

    def free(self, side: Side, texts: Sequence[Text], apart_mm: float = 0.0) -> bool:
        """Whether texts have room, and are this far from each other."""
        boxes = [extent(text, side) for text in texts]
        near = any(a.distance(b) < apart_mm for a, b in itertools.pairwise(boxes))
        return not near and all(map(self.sides[side].free, boxes))

    def put(self, side: Side, texts: Iterable[Text]) -> None:
        """Print texts."""
        for text in texts:
            self.texts.append((side, text))
            self.sides[side].take(extent(text, side))

    def first_free(self, side: Side, choices: Iterable[Text], apart_mm: float = 0.0) -> bool:
        """Print a text at the first of some places that is free, and this much more round it."""
        for text in choices:
            room = extent(text, side)
            if self.sides[side].free(room.buffer(apart_mm) if apart_mm else room):
                self.put(side, [text])
                return True
        return False

    def require(
        self, what: str, choices: Sequence[Text], side: Side = "front", apart_mm: float = 0.0
    ) -> None:
        """The same; if no place is free, that is noted."""
        if not self.first_free(side, choices, apart_mm):
            text = choices[0]
            long_mm = self.length_mm(text.text, text.height_mm)
            self.miss(what, text.height_mm, long_mm, (text.x_mm, text.y_mm))

    def beside(
        self,
        words: str,
        at: Point,
        half_mm: Point,
        way: Way,
        away_mm: float,
        upright: bool = False,
        height_mm: float = 0.0,
    ) -> Text:
        """A text beside the middle of a rectangle's side.

        Args:
            words: what it says.
            at: middle of the rectangle.
            half_mm: half its width and length.
            way: from the rectangle's middle to the text.
            away_mm: gap between both.
            upright: whether it is turned by a quarter.
            height_mm: of its letters; as small as is legible by default.
        """
        text = self.text(words, at, height_mm, 90.0 if upright else 0.0)
        lengthwise = bool(way[0]) != upright
        size = self.length_mm(words, height_mm) if lengthwise else text.height_mm
        x, y = (
            middle + sign * (half + away_mm + size / 2)
            for middle, sign, half in zip(at, way, half_mm, strict=True)
        )
        return replace(text, x_mm=x, y_mm=y)

    def arrow(self, side: Side, places: Iterable[Point]) -> bool:
        """Print an arrow to the tip with its word below, at the first free place of its head."""
        half = _HEAD_MM / 2
        for x, y in places:
            room = shapely.box(x - half, y - _ARROW_MM, x + half, y)
            below = y - _ARROW_MM - 0.5 - self.length_mm("TIP") / 2
            word = self.text("TIP", (x, below), angle_deg=90.0)
            if self.sides[side].free(room.buffer(self.rules.silk_line_mm)) and self.free(
                side, [word]
            ):
                head = LineString([(x - half, y - _HEAD_MM), (x, y), (x + half, y - _HEAD_MM)])
                self.lines(side, [head, LineString([(x, y - _ARROW_MM), (x, y)])])
                self.put(side, [word])
                self.sides[side].take(extent(word, side).buffer(_AROUND_MM))
                return True
        return False

    def block(self, side: Side, lines: Sequence[tuple[str, float]], near: Point) -> Box | None:
        """Print lines of text, each with its height, below each other, as near to a place and as
        large as there is room, in the end all of the least height; upright where they are too
        long. Tells the room that they took."""
        places = self.anywhere(near)
        least = min(height for _, height in lines)
        scales = sorted({1.0, 0.8, 0.65, self.rules.silk_text_mm / least, 0.0}, reverse=True)
        for angle, scale in itertools.product((0.0, 90.0), [s for s in scales if s <= 1.0]):
            texts = self._stack(lines, scale, angle)
            around = shapely.union_all([extent(text, side) for text in texts])
            free = [(x, y) for x, y in places if self._inside(around, x, y)]
            for x, y in free:
                moved = [
                    self.text(t.text, (t.x_mm + x, t.y_mm + y), t.height_mm, angle) for t in texts
                ]
                if self.free(side, moved):
                    self.put(side, moved)
                    left, low, right, high = around.bounds
                    return Box(left + x, right + x, low + y, high + y)
        return None

    def anywhere(self, near: Point) -> list[Point]:
        """Places all over the board, those near to one first."""
        box = self.board.outline
        x = np.arange(box.x_min_mm, box.x_max_mm, _LATTICE_MM)
        y = np.arange(box.y_min_mm, box.y_max_mm, _LATTICE_MM)
        all_ = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2).round(6)
        far = np.hypot(*(all_ - near).T).round(6)
        order = np.lexsort((all_[:, 0], all_[:, 1], far))
        return [near, *((px, py) for px, py in all_[order].tolist())]

    def miss(self, what: str, height_mm: float, length_mm: float, at: Point) -> None:
        """Note that something has found no room near a place."""
        self.lost.append(
            f"{what}, {height_mm:.2f} mm high and {length_mm:.2f} mm long, near "
            f"({at[0]:.2f}, {at[1]:.2f}) mm"
        )

    def refuse_losses(self, remedy: str) -> None:
        """Raise for all that has found no room, and say what helps.

        Raises:
            BuildError: with what, its size, and where.
        """
        if self.lost:
            raise BuildError(
                f"the {self.board.name} board has no room on its silkscreen for "
                f"{'; '.join(self.lost)}: {remedy}"
            )

    def _stack(self, lines: Sequence[tuple[str, float]], scale: float, angle: float) -> list[Text]:
        heights = [max(scale * height, self.rules.silk_text_mm) for _, height in lines]
        rest = 1.8 * sum(heights) / 2
        texts = []
        for (words, _), height in zip(lines, heights, strict=True):
            rest -= 0.9 * height
            at = (0.0, rest) if angle == 0.0 else (-rest, 0.0)
            texts.append(self.text(words, at, height, angle))
            rest -= 0.9 * height
        return texts

    def _inside(self, area: shapely.Geometry, x: float, y: float) -> bool:
        left, low, right, high = area.bounds
        box = self.board.outline
        wide = left + x >= box.x_min_mm and right + x <= box.x_max_mm
        return bool(wide and low + y >= box.y_min_mm and high + y <= box.y_max_mm)
