"""Read a printed part's mesh and measure it: edges, rays, sections, overhang, shared volume."""

from dataclasses import dataclass
from functools import reduce
from pathlib import Path
from typing import Any

import manifold3d
import numpy as np
import shapely
import trimesh
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from lumitip_fab.design.frames import Matrix
from lumitip_fab.errors import OutputError

Vectors = NDArray[np.float64]
Solid = Any  # manifold3d.Manifold

_TOUCH_MM = 1e-6
_PLANE_MM = 1e-5  # a section is taken this far above the plane asked for, off every corner
_STEEPEST = -np.cos(np.radians(44.0))  # 45° with a degree for the mesh


@dataclass(frozen=True, eq=False)
class Hits:
    """Where rays cross a mesh: one entry for each crossing, sorted by ray, then distance."""

    ray: NDArray[np.int64]
    distance_mm: Vectors
    triangle: NDArray[np.int64]

    def first(self, rays: int) -> tuple[Vectors, NDArray[np.int64]]:
        """Distance and triangle of each ray's first crossing; infinity and -1 without one."""
        which, at = np.unique(self.ray, return_index=True)
        distance, triangle = np.full(rays, np.inf), np.full(rays, -1)
        distance[which], triangle[which] = self.distance_mm[at], self.triangle[at]
        return distance, triangle


def read_mesh(path: Path) -> Any:
    """A mesh file with equal corners joined.

    Raises:
        OutputError: if it is missing or holds no mesh.
    """
    if not path.is_file():
        raise OutputError("no such file")
    try:
        mesh = trimesh.load(path, force="mesh")
        usable = len(mesh.faces) > 0 and bool(np.isfinite(mesh.vertices).all())
    except Exception as error:  # readers raise whatever they stumble over
        raise OutputError(f"cannot be read: {error!r:.200}") from error
    if not usable:
        raise OutputError("holds no mesh")
    return mesh


def moved(mesh: Any, matrix: Matrix) -> Any:
    """A copy of a mesh in another frame."""
    return mesh.copy().apply_transform(matrix)


def open_edges(mesh: Any) -> int:
    """Edges that do not join exactly two triangles of the same sense."""
    edges = mesh.edges.astype(np.int64)
    size = len(mesh.vertices)
    forward, times = np.unique(edges[:, 0] * size + edges[:, 1], return_counts=True)
    backward = edges[:, 1] * size + edges[:, 0]
    return int((times > 1).sum() + (~np.isin(backward, forward)).sum())


def bodies(mesh: Any) -> int:
    """Pieces that share no edge with each other."""
    return int(mesh.body_count)


def cast(mesh: Any, origins: Vectors, directions: Vectors, reach_mm: float) -> Hits:
    """Every crossing of rays with a mesh.

    Args:
        mesh: the mesh.
        origins: starts, shape `(n, 3)`.
        directions: unit vectors, shape `(n, 3)` or `(3,)`.
        reach_mm: length of the rays.
    """
    directions = np.broadcast_to(directions, origins.shape)
    ends = origins + directions * reach_mm
    corners = np.asarray(mesh.triangles)
    ray, triangle = _near(corners, np.minimum(origins, ends), np.maximum(origins, ends))
    a, b, c = (corners[triangle, k] for k in range(3))
    heading, start = directions[ray], origins[ray]
    across = np.cross(heading, c - a)
    scale = np.einsum("ij,ij->i", b - a, across)
    kept = np.abs(scale) > 1e-12
    inverse = 1.0 / np.where(kept, scale, 1.0)
    offset = start - a
    u = np.einsum("ij,ij->i", offset, across) * inverse
    over = np.cross(offset, b - a)
    v = np.einsum("ij,ij->i", heading, over) * inverse
    distance = np.einsum("ij,ij->i", c - a, over) * inverse
    kept &= (u >= 0) & (v >= 0) & (u + v <= 1) & (distance > _TOUCH_MM) & (distance <= reach_mm)
    ray, distance, triangle = ray[kept], distance[kept], triangle[kept]
    order = np.lexsort((distance, ray))
    return Hits(ray[order], distance[order], triangle[order])


def _near(corners: Vectors, low: Vectors, high: Vectors) -> tuple[Any, Any]:
    """Pairs of ray and triangle whose bounding boxes meet."""
    least, most = corners.min(axis=1), corners.max(axis=1)
    lowest, highest = low.min(axis=0, initial=np.inf), high.max(axis=0, initial=-np.inf)
    local = np.flatnonzero(((most >= lowest) & (least <= highest)).all(axis=1))
    least, most = least[local], most[local]
    spread = (high - low).max(axis=0, initial=0.0)
    i, j, k = np.argsort(spread)  # a tree over the two axes along which the rays are shortest
    tree = shapely.STRtree(shapely.box(least[:, i], least[:, j], most[:, i], most[:, j]))
    boxes = shapely.box(low[:, i], low[:, j], high[:, i], high[:, j])
    ray, triangle = tree.query(boxes)
    meet = (low[ray, k] <= most[triangle, k]) & (high[ray, k] >= least[triangle, k])
    return ray[meet], local[triangle[meet]]


def inside(mesh: Any, points: Vectors) -> NDArray[np.bool_]:
    """Whether points lie in the material, by the crossings above them."""
    reach = float(np.ptp(mesh.bounds[:, 2])) + 1.0
    hits = cast(mesh, points, np.array([0.0, 0.0, 1.0]), reach)
    return np.asarray(np.bincount(hits.ray, minlength=len(points)) % 2 == 1)


def section(mesh: Any, z_mm: float) -> BaseGeometry:
    """The material cut at a height, as polygons in x and y."""
    plane = np.array([0.0, 0.0, z_mm + _PLANE_MM])
    cut = trimesh.intersections.mesh_plane(mesh, np.array([0.0, 0.0, 1.0]), plane)
    if not len(cut):
        return shapely.Polygon()
    lines = shapely.linestrings(np.round(cut[:, :, :2], 5))
    lines = lines[shapely.length(lines) > 0]
    merged = shapely.get_parts(shapely.line_merge(shapely.multilinestrings(lines)))
    rings = [shapely.Polygon(line.coords) for line in merged if line.is_closed]
    nothing: BaseGeometry = shapely.Polygon()
    return reduce(shapely.symmetric_difference, map(shapely.make_valid, rings), nothing)


def moments(cut: BaseGeometry) -> tuple[float, Vectors, Vectors]:
    """Area, centre, and second moments about the centre, of polygons with holes."""
    area, first, second = 0.0, np.zeros(2), np.zeros((2, 2))
    for part in shapely.get_parts(cut):
        if part.geom_type != "Polygon":
            continue
        whole = shapely.geometry.polygon.orient(part)  # holes turn the other way, and count less
        for ring in (whole.exterior, *whole.interiors):
            corners = shapely.get_coordinates(ring)
            a, b = corners[:-1], corners[1:]
            cross = a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1]
            area += float(cross.sum()) / 2
            first += ((a + b) * cross[:, None]).sum(axis=0) / 6
            mixed = np.einsum("n,ni,nj->ij", cross, a, b)
            own = np.einsum("n,ni,nj->ij", cross, a, a) + np.einsum("n,ni,nj->ij", cross, b, b)
            second += (2 * own + mixed + mixed.T) / 24
    middle = first / area if area > 0 else first
    return area, middle, second - area * np.outer(middle, middle)


def overhang_mm2(mesh: Any) -> float:
    """Area that a printer must lay over air: steeper than 45°, standing on z = 0."""
    hangs = (mesh.face_normals[:, 2] < _STEEPEST) & (mesh.triangles[:, :, 2].max(axis=1) > 0.01)
    return float(mesh.area_faces[hangs].sum())


def bed_contact_mm2(mesh: Any) -> float:
    """Area that lies on the bed, z = 0."""
    on_bed = np.abs(mesh.triangles[:, :, 2]).max(axis=1) < 0.01
    return float(mesh.area_faces[on_bed].sum())


def solid(mesh: Any, name: str) -> Solid:
    """A mesh as a body with an inside.

    Raises:
        OutputError: if it is not closed.
    """
    body = manifold3d.Manifold(
        manifold3d.Mesh64(mesh.vertices.astype(np.float64), mesh.faces.astype(np.uint64))
    )
    if body.status() != manifold3d.Error.NoError or body.is_empty():
        raise OutputError(f"{name} is not a closed body: {body.status()}")
    return body


def placed(body: Solid, matrix: Matrix) -> Solid:
    """A body in another frame."""
    return body.transform(matrix[:3])


def shared_mm3(a: Solid, b: Solid) -> float:
    """Volume that two bodies both fill."""
    low_a, high_a = np.array(a.bounding_box()).reshape(2, 3)
    low_b, high_b = np.array(b.bounding_box()).reshape(2, 3)
    if (low_a > high_b).any() or (low_b > high_a).any():
        return 0.0
    return abs(float((a ^ b).volume()))


def united(bodies: list[Solid]) -> Solid:
    """Several bodies as one."""
    return manifold3d.Manifold.batch_boolean(bodies, manifold3d.OpType.Add)
