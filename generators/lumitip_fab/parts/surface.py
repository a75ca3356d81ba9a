"""`Mesh`: a surface of triangles, for what is drawn and stored without the CAD kernel."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Mesh:
    """A closed surface of triangles."""

    points_mm: NDArray[np.float64]
    """Corners, shape `(n, 3)`, each once."""
    triangles: NDArray[np.int64]
    """Indices of the corners of each triangle, shape `(m, 3)`, counter-clockwise from outside."""

    def moved(self, matrix: NDArray[np.float64]) -> "Mesh":
        """The surface in another frame (4x4, mm)."""
        return Mesh(self.points_mm @ matrix[:3, :3].T + matrix[:3, 3], self.triangles)
