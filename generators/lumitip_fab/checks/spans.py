"""Lines of a standing part that are laid over nothing, layer by layer."""

import math
from typing import Any

import numpy as np
import shapely

from lumitip_fab.checks.readers.solids import section
from lumitip_fab.design import Printing

_DOWN = -math.cos(math.radians(44.0))  # what faces down more than 45°, with a degree for the mesh
_BED_MM = 0.01


def longest_span_mm(
    mesh: Any, printing: Printing, enough_mm: float = math.inf
) -> tuple[float, float]:
    """The longest line that the printer lays over nothing, and its height over the bed (mm).

    A line holds where at least half of it lies on the layer below, or where it leans out by no more
    than 45°. What does not hold is as long as the longer side of the rectangle round it: the slicer
    may lay its lines that way.

    Args:
        mesh: the part, standing on z = 0.
        printing: for the height of its layers and the width of its lines.
        enough_mm: length of a line at which to stop; layers with most faces over nothing come
            first.
    """
    layer, reach = printing.layer_mm, max(printing.layer_mm, printing.line_mm / 2)
    hangs = mesh.face_normals[:, 2] < _DOWN
    z, area = mesh.triangles[hangs][:, :, 2], mesh.area_faces[hangs]
    over = z.max(axis=1) > _BED_MM
    low, high = np.floor(z[over].min(axis=1) / layer), np.ceil(z[over].max(axis=1) / layer)
    found: dict[int, float] = {}
    for a, b, mm2 in zip(low, high, area[over], strict=True):
        for n in range(int(a), int(b) + 1):
            found[n] = found.get(n, 0.0) + float(mm2)
    worst = 0.0, 0.0
    for number in sorted(found.keys() - {0}, key=lambda n: (-found[n], n)):
        middle = (number + 0.5) * layer
        below = section(mesh, middle - layer).buffer(reach, join_style="mitre")
        for piece in shapely.get_parts(section(mesh, middle).difference(below)):
            if piece.area > printing.line_mm**2 / 4:
                worst = max(worst, (_length_mm(piece), middle))
        if worst[0] > enough_mm:
            break
    return worst


def _length_mm(piece: shapely.Geometry) -> float:
    """Longer side of the least rectangle round a piece."""
    corners = shapely.get_coordinates(shapely.minimum_rotated_rectangle(piece))
    return float(np.hypot(*np.diff(corners, axis=0).T).max())
