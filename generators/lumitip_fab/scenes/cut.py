"""The cut of a mesh by the plane x = 0, as areas on a page: y to the right, z up."""

from collections.abc import Iterable
from functools import reduce

import numpy as np
import shapely
import trimesh

from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.drawing import Points

_ASIDE_MM = 0.0137  # of the plane from x = 0, where edges of symmetric parts lie
_GRID_MM = 1e-4  # of the ends of the cut's lines


def cut(mesh: Mesh) -> shapely.Geometry:
    """The material in the plane, in mm."""
    solid = trimesh.Trimesh(mesh.points_mm, mesh.triangles, process=False)
    lines = trimesh.intersections.mesh_plane(solid, [1.0, 0.0, 0.0], [_ASIDE_MM, 0.0, 0.0])
    if not len(lines):
        return shapely.Polygon()
    edges = shapely.set_precision(shapely.linestrings(lines[:, :, 1:]), _GRID_MM)
    faces = shapely.get_parts(shapely.polygonize([shapely.union_all(edges)]))
    # A ring inside another is a hole of it, and one inside that is material again.
    rings = [shapely.Polygon(face.exterior) for face in faces]
    return reduce(shapely.symmetric_difference, _largest_first(rings), shapely.Polygon())


def rings_of(area: shapely.Geometry) -> list[Points]:
    """Outer and inner contours of an area, to be filled."""
    return [
        np.array(ring.coords)
        for part in shapely.get_parts(area)
        if part.geom_type == "Polygon"
        for ring in (part.exterior, *part.interiors)
    ]


def _largest_first(rings: Iterable[shapely.Polygon]) -> list[shapely.Polygon]:
    return sorted(rings, key=lambda ring: -ring.area)
