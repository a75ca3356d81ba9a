"""Damages of a triangle mesh, whatever file it comes from."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from trimesh.triangles import closest_point

from mutations.amounts import distance_mm, factor
from mutations.damage import NotApplicableError

Corners = NDArray[np.float64]
AXES = "xyz"
ALIKE_MM = 0.2
_LOOKED_AT = 40
LEAST_MOMENT_MM4 = 0.5
"""Change by a hole of 1 mm in a wall of 2 mm that moves by 0.3 mm. A corner that slides along its
own edge, or within its own face, changes nothing: that leaves the body as it is."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """Corners in mm, shape (n, 3), and the numbers of three of them for each triangle, (m, 3)."""

    corners: Corners
    faces: NDArray[np.int64]

    @property
    def moments(self) -> Corners:
        """Volume and its first moments, mm³ and mm⁴, about the middle of the box; shape (4,)."""
        points = self.corners - (self.corners.min(axis=0) + self.corners.max(axis=0)) / 2
        a, b, c = (points[self.faces[:, i]] for i in range(3))
        volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
        return np.array([volumes.sum(), *(volumes[:, None] * (a + b + c) / 4).sum(axis=0)])


MeshDamage = Callable[[Mesh, Generator], tuple[Mesh, str]]


def moved(mesh: Mesh, rng: Generator) -> tuple[Mesh, str]:
    """The whole mesh along an axis."""
    axis, by = int(rng.integers(3)), distance_mm(rng)
    shift = np.eye(3)[axis] * by
    return Mesh(mesh.corners + shift, mesh.faces), f"all moved by {by:g} mm in {AXES[axis]}"


def scaled(mesh: Mesh, rng: Generator) -> tuple[Mesh, str]:
    """Larger or smaller, along one axis or all, by at least 0.2 mm over its whole size."""
    size, by = np.ptp(mesh.corners, axis=0), factor(rng)
    axes = [int(rng.integers(3))] if rng.random() < 0.5 else [0, 1, 2]
    if size[axes].max() * abs(by - 1) < ALIKE_MM:
        raise NotApplicableError
    scale = np.where(np.isin(range(3), axes), by, 1.0)
    named = "".join(AXES[a] for a in axes)
    return Mesh(mesh.corners * scale, mesh.faces), f"scaled by {by:g} along {named}"


def in_another_unit(mesh: Mesh, rng: Generator) -> tuple[Mesh, str]:
    """Written in inches, centimetres or metres."""
    name, by = [("inches", 1 / 25.4), ("cm", 0.1), ("m", 0.001)][int(rng.integers(3))]
    return Mesh(mesh.corners * by, mesh.faces), f"its numbers are {name}"


def mirrored(mesh: Mesh, rng: Generator) -> tuple[Mesh, str]:
    """Mirrored in its own middle. A mirror image that looks the same is no damage."""
    axis = int(rng.integers(3))
    corners = mesh.corners.copy()
    corners[:, axis] = corners[:, axis].min() + corners[:, axis].max() - corners[:, axis]
    if _farthest_mm(mesh, corners) < ALIKE_MM:
        raise NotApplicableError
    return Mesh(corners, mesh.faces[:, ::-1]), f"mirrored in {AXES[axis]}"


def _farthest_mm(mesh: Mesh, points: Corners) -> float:
    """Distance from a mesh's surface of the point farthest from it, nearly.

    Only points far from every corner are looked at: both sides of a rounded edge may have their
    corners at other places of one curve.
    """
    far = points[cKDTree(mesh.corners).query(points)[0].argsort()[-_LOOKED_AT:]]
    triangles = mesh.corners[mesh.faces]
    return max(
        float(
            np.linalg.norm(
                closest_point(triangles, np.tile(p, (len(triangles), 1))) - p, axis=1
            ).min()
        )
        for p in far
    )


def part_moved(mesh: Mesh, rng: Generator) -> tuple[Mesh, str]:
    """The corners within a cylinder, like those of a hole, moved across its axis."""
    for _ in range(20):
        seed = mesh.corners[int(rng.integers(len(mesh.corners)))]
        axis, reach = int(rng.integers(3)), rng.uniform(1, 4)
        across = [a for a in range(3) if a != axis]
        inside = np.hypot(*(mesh.corners - seed)[:, across].T) < reach
        shift = np.zeros(3)
        shift[across[int(rng.integers(2))]] = distance_mm(rng)
        changed = Mesh(mesh.corners + inside[:, None] * shift, mesh.faces)
        if not inside.all() and np.abs(changed.moments - mesh.moments).max() > LEAST_MOMENT_MM4:
            return changed, f"{inside.sum()} corners round {_place(seed)} moved by {_place(shift)}"
    raise NotApplicableError


def dented(mesh: Mesh, rng: Generator) -> tuple[Mesh, str]:
    """The corners within a ball, moved along the surface's normal."""
    a, b, c = (mesh.corners[mesh.faces[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    for _ in range(20):
        number = int(rng.integers(len(mesh.corners)))
        seed = mesh.corners[number]
        normal = normals[(mesh.faces == number).any(axis=1)].sum(axis=0)
        shift = distance_mm(rng) * normal / max(float(np.linalg.norm(normal)), 1e-12)
        inside = np.linalg.norm(mesh.corners - seed, axis=1) < rng.uniform(0.5, 5)
        changed = Mesh(mesh.corners + inside[:, None] * shift, mesh.faces)
        if np.abs(changed.moments - mesh.moments).max() > LEAST_MOMENT_MM4:
            return changed, f"{inside.sum()} corners at {_place(seed)} moved by {_place(shift)}"
    raise NotApplicableError


def halved(mesh: Mesh, rng: Generator) -> tuple[Mesh, str]:
    """Without the triangles on one side."""
    axis = int(rng.integers(3))
    middles = mesh.corners[mesh.faces].mean(axis=1)[:, axis]
    kept = middles < np.median(middles)
    if kept.all() or not kept.any():
        raise NotApplicableError
    return Mesh(mesh.corners, mesh.faces[kept]), f"the half towards +{AXES[axis]} is gone"


def opened(mesh: Mesh, rng: Generator) -> tuple[Mesh, str]:
    """Without the triangles round a place."""
    middles = mesh.corners[mesh.faces].mean(axis=1)
    seed = middles[int(rng.integers(len(middles)))]
    gone = np.linalg.norm(middles - seed, axis=1) < rng.uniform(0.5, 5)
    if gone.all():
        raise NotApplicableError
    return Mesh(mesh.corners, mesh.faces[~gone]), f"{gone.sum()} triangles at {_place(seed)} gone"


def doubled(mesh: Mesh, rng: Generator) -> tuple[Mesh, str]:
    """A second body of the same shape, beside the first or across it."""
    axis = int(rng.integers(3))
    shift = np.eye(3)[axis] * float(np.ptp(mesh.corners[:, axis])) * rng.uniform(0.3, 1.5)
    corners = np.vstack([mesh.corners, mesh.corners + shift])
    faces = np.vstack([mesh.faces, mesh.faces + len(mesh.corners)])
    return Mesh(corners, faces), f"a second body, moved by {_place(shift)}"


def turned_inside_out(mesh: Mesh, rng: Generator) -> tuple[Mesh, str]:
    """All triangles wound the other way, or some of them."""
    if rng.random() < 0.5:
        return Mesh(mesh.corners, mesh.faces[:, ::-1]), "inside out"
    middles = mesh.corners[mesh.faces].mean(axis=1)
    seed = middles[int(rng.integers(len(middles)))]
    near = np.linalg.norm(middles - seed, axis=1) < rng.uniform(1, 5)
    faces = np.where(near[:, None], mesh.faces[:, ::-1], mesh.faces)
    return Mesh(mesh.corners, faces), f"{near.sum()} triangles at {_place(seed)} inside out"


DAMAGES: dict[str, MeshDamage] = {
    "move": moved,
    "move a part": part_moved,
    "dent": dented,
    "scale": scaled,
    "mirror": mirrored,
    "unit": in_another_unit,
    "halve": halved,
    "remove": opened,
    "duplicate": doubled,
    "inside out": turned_inside_out,
}


def _place(point: Corners) -> str:
    return "(" + ", ".join(f"{v:.2f}" for v in point) + ") mm"
