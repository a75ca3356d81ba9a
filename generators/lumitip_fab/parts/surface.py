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
