"""Printed parts as they lie on the bed, small enough for the page."""

import base64
from typing import Any

import numpy as np

from lumitip_fab.checks.readers.solids import read_mesh
from lumitip_fab.errors import OutputError
from lumitip_fab.site.folder import Folder

_STEPS = 65535  # of a coordinate over the part's size: 4 µm at 250 mm


def bed_mesh(folder: Folder, path: str) -> dict[str, Any]:
    """The mesh of an STL: `low` and `size` (mm) of its box, `points` as shares of that in
    16 bits, and `triangles` in 32 bits, both little-endian in base 64.

    Raises:
        OutputError: if the file holds no mesh.
    """
    try:
        mesh = read_mesh(folder.out / path)
    except OutputError as error:
        raise folder.damaged(path, error) from error
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    size = np.maximum(high - low, 1e-6)
    points = np.rint((mesh.vertices - low) / size * _STEPS).astype("<u2")
    return {
        "low": [round(float(v), 4) for v in low],
        "size": [round(float(v), 4) for v in size],
        "points": base64.b64encode(points.tobytes()).decode(),
        "triangles": base64.b64encode(np.asarray(mesh.faces, "<u4").tobytes()).decode(),
    }
