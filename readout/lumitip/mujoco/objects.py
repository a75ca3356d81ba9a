"""`View`: objects between the fingers as those of the twin, by what the cells see of them."""

import numpy as np

from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.mujoco.bodies import Body
from lumitip.mujoco.outlines import beside, border, turns
from lumitip.mujoco.rope import Rope
from lumitip.twin import Cable, Corner, Disc, Polygon, Thing

REACH_MM = 8.0
"""Distance around the cells within which objects are looked for (mm)."""
_NEAR_MM = 5.0  # around the cells; what is farther away changes their light by few counts
_SMOOTH, _BENT = np.radians(10.0), np.radians(90.0)  # largest turn at a point, and in all
_STRAIGHT = np.radians(1.0)


class View:
    """What the cells of a layout see."""

    def __init__(self, layout: Layout) -> None:
        self._places = np.stack([layout.x_mm, layout.y_mm], axis=1)
        self.low, self.high = self._places.min(axis=0), self._places.max(axis=0)
        """Corners of the rectangle around the cells' centres, shape `(2,)` (mm)."""
        self._seen = self.low - _NEAR_MM, self.high + _NEAR_MM

    def line(self, body: Body) -> tuple[Floats, Floats] | None:
        """Distance of each cell left of a rope or an edge (mm), and its direction there (degrees),
        each of shape `(cells,)`, if the cells see one smooth line. The twin's tables need it."""
        points = body.points_mm
        if body.form == "disc" or body.material[1]:
            return None
        if body.form == "outline":
            crossing = border(points, *self._seen)
            if crossing is None:
                return None
            points = crossing
        elif self._end_seen(points):
            return None
        turn = np.abs(turns(points))
        if turn.max(initial=0.0) > _SMOOTH or turn.sum() > _BENT:
            return None
        return beside(points, self._places)

    def thing(self, body: Body, height: float) -> Thing:
        """The object of the twin at a height in the gap, 0 to 1."""
        clear, diffuse = body.material
        common = {"clear": clear, "diffuse": diffuse, "height": height}
        points, wide_mm = body.points_mm, 2.0 * body.radius_mm
        if body.form == "disc":
            x, y = points[0].tolist()
            return Disc(x_mm=x, y_mm=y, diameter_mm=wide_mm, **common)
        if body.form == "line":
            if self._end_seen(points) or np.abs(turns(points)).sum() > _STRAIGHT:
                return Rope(points_mm=points, diameter_mm=wide_mm, **common)
            along, up = points[-1] - points[0]
            angle = np.arctan2(up, along)
            offset_mm = float(points[0] @ (-np.sin(angle), np.cos(angle)))
            return Cable(offset_mm, float(np.degrees(angle)), diameter_mm=wide_mm, **common)
        crossing = border(points, *self._seen)
        if crossing is None or len(crossing) != 3:
            return Polygon(points_mm=points, **common)
        return _corner(crossing, common)

    def _end_seen(self, points: Floats) -> bool:
        ends = points[[0, -1]]
        return bool(((ends > self._seen[0]) & (ends < self._seen[1])).all(axis=1).any())


def _corner(line: Floats, common: dict[str, float]) -> Corner:
    """A corner between two straight sides, the covered side right of both."""
    opening = np.pi + float(turns(line)[0])
    (x, y), (along, up) = line[1].tolist(), line[2] - line[1]
    angle = np.arctan2(up, along) - opening / 2.0
    angles = {"angle_deg": float(np.degrees(angle)), "opening_deg": float(np.degrees(opening))}
    return Corner(x_mm=x, y_mm=y, **angles, **common)
