"""`Rope`: a line of any form with a width, as an object of the twin."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from lumitip.grid import Floats
from lumitip.twin import Shape
from lumitip.twin.lines import Numbers, square_from_segment


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
        for begin, end in pairwise(self.points_mm.tolist()):
            nearest = np.minimum(nearest, square_from_segment(x_mm, y_mm, begin, end))
        away: Numbers = np.sqrt(nearest) - self.diameter_mm / 2.0
        return away
