"""Thickness of walls by casting rays inward from the surface of a mesh."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray

from lumitip_fab.checks.readers.solids import Vectors, cast
from lumitip_fab.checks.result import Measurement

Mask = NDArray[np.bool_]

SAMPLES = 3000
MESH_MM = 0.02  # two chord errors: a wall of exactly the limit must pass
_FACING = -np.cos(np.radians(30.0))  # less than that is an edge, not a wall
_SEED = 1


@dataclass(frozen=True)
class Exempt:
    """A region that may be thinner than other walls, for a reason."""

    name: str
    least_mm: float
    holds: Callable[[Vectors], Mask]
    """Which points of shape `(n, 3)` lie in it."""


def thicknesses(mesh: Any, reach_mm: float) -> tuple[Vectors, Vectors]:
    """Points on the surface with a wall behind them, and its thickness.

    A wall is two faces within 30° of facing away from each other, nearer than `reach_mm`.
    """
    spread, on = trimesh.sample.sample_surface(mesh, SAMPLES, seed=_SEED)
    points = np.concatenate([spread, mesh.triangles_center])
    owner = np.concatenate([on, np.arange(len(mesh.faces))])
    inward = -mesh.face_normals[owner]
    distance, far = cast(mesh, points + inward * 1e-4, inward, reach_mm).first(len(points))
    found = far >= 0
    facing = np.einsum("ij,ij->i", mesh.face_normals[far], mesh.face_normals[owner]) < _FACING
    wall = found & facing
    return points[wall], distance[wall] + 1e-4


def walls(
    check: str, subject: str, mesh: Any, least_mm: float, exempt: Sequence[Exempt]
) -> Iterator[Measurement]:
    """The thinnest wall, and the thinnest in each exempt region with its own limit."""
    reach_mm = 2 * max((least_mm, *(region.least_mm for region in exempt)))
    points, thickness = thicknesses(mesh, reach_mm)
    free = np.ones(len(points), dtype=np.bool_)
    for region in exempt:
        held = region.holds(points)
        free &= ~held
        thin = float(thickness[held].min(initial=reach_mm))
        yield Measurement(
            check, f"{subject}: {region.name}", thin, region.least_mm - MESH_MM, unit="mm"
        )
    thin, note = reach_mm, ""
    if free.any():
        at = int(np.flatnonzero(free)[thickness[free].argmin()])
        thin, (x, y, z) = float(thickness[at]), points[at]
        note = f"at ({x:.1f}, {y:.1f}, {z:.1f}) of the file's frame"
    yield Measurement(check, subject, thin, least_mm - MESH_MM, unit="mm", note=note)
