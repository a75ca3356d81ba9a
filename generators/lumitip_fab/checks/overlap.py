"""Volumes of bodies read from meshes, and of what two bodies share."""

from typing import Any

import manifold3d
import numpy as np

from lumitip_fab.design.frames import Matrix
from lumitip_fab.errors import OutputError

Solid = Any  # manifold3d.Manifold


def solid(mesh: Any, what: str) -> Solid:
    """A mesh as a body with an inside.

    Raises:
        OutputError: if it is not closed.
    """
    made = manifold3d.Manifold(
        manifold3d.Mesh64(mesh.vertices.astype(np.float64), mesh.faces.astype(np.uint64))
    )
    if made.status() != manifold3d.Error.NoError or made.is_empty():
        raise OutputError(f"{what} is not a closed body: {made.status()}")
    return made


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


def joined(bodies: list[Solid]) -> Solid:
    """Several bodies as one."""
    return manifold3d.Manifold.batch_boolean(bodies, manifold3d.OpType.Add)
