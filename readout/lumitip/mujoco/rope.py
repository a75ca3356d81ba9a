"""`Rope`: a line of any form with a width, as an object of the twin."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from lumitip.grid import Floats
from lumitip.twin import Shape
from lumitip.twin.lines import Numbers


@dataclass(frozen=True, eq=False, kw_only=True)
class Rope(Shape):
    """A flat strip with round ends along a line of points, shape `(n, 2)` (mm).

    It takes no account of slanting light: a round cable that crosses the sensor in a straight line
    is a `Cable`.
    """

    points_mm: Floats
    diameter_mm: float

    def signed_distance_mm(self, x_mm: Numbers, y_mm: Numbers) -> Numbers:
        """See `Shape`."""
        shape = np.broadcast_shapes(np.shape(x_mm), np.shape(y_mm))
        nearest = np.full(shape, np.inf, np.result_type(x_mm, y_mm, np.float32))
        points = self.points_mm.tolist()  # plain numbers keep single precision
        for (ax, ay), (bx, by) in pairwise(points):
            dx, dy, x, y = bx - ax, by - ay, x_mm - ax, y_mm - ay
            share = np.clip((x * dx + y * dy) / max(dx * dx + dy * dy, 1e-18), 0.0, 1.0)
            nearest = np.minimum(nearest, (x - share * dx) ** 2 + (y - share * dy) ** 2)
        away: Numbers = np.sqrt(nearest) - self.diameter_mm / 2.0
        return away
