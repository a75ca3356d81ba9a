"""Volumes that only one of two designs fills, for every printed part."""

from base64 import b64encode
from collections.abc import Iterator

import numpy as np

from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.solids import Solid
from lumitip_fab.design.frames import Matrix
from lumitip_fab.diff.folder import Folder, frame_change
from lumitip_fab.diff.render import pictures
from lumitip_fab.diff.values import Shape
from lumitip_fab.errors import OutputError
from lumitip_fab.parts.surface import Mesh

LEAST_MM3 = 0.01
"""Volumes below are not drawn: STL keeps 24 bits of a coordinate."""


def part_differences(a: Folder, b: Folder) -> Iterator[Shape]:
    """Every printed part whose file differs, or that one alone has.

    Raises:
        OutputError: if a file is no closed body.
    """
    for path in sorted(a.paths(".stl") | b.paths(".stl")):
        if a.sha256.get(path) == b.sha256.get(path):
            continue
        first, second = _body(a, path), _body(b, path)
        if first is None or second is None:
            sizes = (None if body is None else float(body.volume()) for body in (first, second))
            yield Shape.alone(path, "mm3", *sizes)
        else:
            yield _difference(path, first, second, frame_change(a, b, path))


def _body(folder: Folder, path: str) -> Solid | None:
    if path not in folder.sha256:
        return None
    try:
        return solids.solid(solids.read_mesh(folder.out / path), "it")
    except OutputError as error:
        raise folder.damaged(path, error) from error


def _difference(path: str, a: Solid, b: Solid, change: Matrix | None) -> Shape:
    """Both as they are written, or in their place in the design: where more is common."""
    placed = [b] if change is None else [b, solids.placed(b, change)]
    other, both = max(((p, a ^ p) for p in placed), key=lambda pair: float(pair[1].volume()))
    bodies = {"both": both, "a": a - other, "b": other - a}
    only = float(bodies["a"].volume()), float(bodies["b"].volume())
    picture = ""
    if max(only) >= LEAST_MM3:
        meshes = {name: _mesh(body) for name, body in bodies.items() if not body.is_empty()}
        coded = (b64encode(png).decode() for png in pictures(meshes))
        images = (f'<img alt="" src="data:image/png;base64,{data}">' for data in coded)
        picture = f'<div class="pair">{"".join(images)}</div>'
    return Shape(path, "mm3", (float(a.volume()), float(b.volume())), only, picture)


def _mesh(body: Solid) -> Mesh:
    mesh = body.to_mesh64()
    return Mesh(np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts, dtype=np.int64))
