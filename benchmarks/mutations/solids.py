"""STL and 3MF: damages of the mesh, and of what a 3MF has round it."""

import io
import re
import zipfile
from collections.abc import Callable

import numpy as np
from numpy.random import Generator

from mutations.amounts import distance_mm, factor, replaced
from mutations.damage import Mutator, Mutators, NotApplicableError
from mutations.meshes import DAMAGES, Mesh, MeshDamage

_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")])
_HEADER = 84
_MODEL = "3D/3dmodel.model"
_VERTEX = re.compile(r'<vertex x="([^"]+)" y="([^"]+)" z="([^"]+)"\s*/>')
_TRIANGLE = re.compile(r'<triangle v1="(\d+)" v2="(\d+)" v3="(\d+)"\s*/>')


def read_stl(data: bytes) -> Mesh:
    """The mesh of a binary STL, equal corners joined."""
    facets = np.frombuffer(data, _FACET, offset=_HEADER)
    corners, faces = np.unique(facets["corners"].reshape(-1, 3), axis=0, return_inverse=True)
    return Mesh(corners.astype(np.float64), faces.reshape(-1, 3))


def write_stl(mesh: Mesh, header: bytes) -> bytes:
    """A binary STL with this text (80 bytes) before its mesh."""
    facets = np.zeros(len(mesh.faces), _FACET)
    facets["corners"] = mesh.corners[mesh.faces]
    a, b, c = (mesh.corners[mesh.faces[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    facets["normal"] = normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None]
    return header[:80] + np.uint32(len(facets)).tobytes() + facets.tobytes()


def of_stl(damage: MeshDamage) -> Mutator:
    """A mesh's damage as a mutator of STL files."""

    def mutate(data: bytes, rng: Generator) -> tuple[bytes, str]:
        mesh, done = damage(read_stl(data), rng)
        return write_stl(mesh, data[:80]), done

    return mutate


def _shortened(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """A count of triangles, and fewer of them."""
    kept = _HEADER + _FACET.itemsize * int((len(data) - _HEADER) // 50 * rng.uniform(0.1, 0.95))
    return data[:kept], f"only {kept} of {len(data)} bytes"


STL: Mutators = {kind: of_stl(damage) for kind, damage in DAMAGES.items()} | {
    "truncate": _shortened
}


def in_zip(
    member: str, change: Callable[[bytes], tuple[bytes, str]], data: bytes
) -> tuple[bytes, str]:
    """A zip with one member changed; order, dates and compression stay."""
    target, done = io.BytesIO(), ""
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(target, "w") as new:
        for info in old.infolist():
            body = old.read(info)
            if info.filename == member:
                body, done = change(body)
            new.writestr(info, body, compress_type=info.compress_type)
    return target.getvalue(), done


def of_model(mutator: Mutator) -> Mutator:
    """A mutator of the model's XML as one of 3MF files."""

    def mutate(data: bytes, rng: Generator) -> tuple[bytes, str]:
        return in_zip(_MODEL, lambda body: mutator(body, rng), data)

    return mutate


def in_model(damage: MeshDamage) -> Mutator:
    """A mesh's damage as a mutator of the model's XML."""

    def mutate(data: bytes, rng: Generator) -> tuple[bytes, str]:
        text = data.decode()
        corners = np.array(_VERTEX.findall(text), dtype=np.float64)
        faces = np.array(_TRIANGLE.findall(text), dtype=np.int64)
        mesh, done = damage(Mesh(corners, faces), rng)
        vertices = "\n".join(
            f'<vertex x="{x:.5f}" y="{y:.5f}" z="{z:.5f}"/>' for x, y, z in mesh.corners
        )
        triangles = "\n".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in mesh.faces)
        for tag, body in (("vertices", vertices), ("triangles", triangles)):
            start, end = text.index(f"<{tag}>") + len(tag) + 2, text.index(f"</{tag}>")
            text = f"{text[:start]}\n{body}\n{text[end:]}"
        return text.encode(), done

    return mutate


def _transformed(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """The build item moved, scaled or turned by its transform."""
    axis = int(rng.integers(3))
    matrix = np.vstack([np.eye(3), np.zeros(3)])
    how = int(rng.integers(3))
    if how == 0:
        matrix[3, axis] = distance_mm(rng)
    elif how == 1:
        matrix[axis, axis] = factor(rng)
    else:
        matrix[:3] = np.roll(matrix[:3], 1, axis=0)  # z becomes x: it lies on its side
    values = " ".join(f"{v:g}" for v in matrix.ravel())
    done = f"item {('moved', 'scaled', 'turned')[how]}: {values}"
    return _item(data, f'<item objectid="1" transform="{values}"/>'), done


def _second_item(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """The object printed twice."""
    by = f"1 0 0 0 1 0 0 0 1 {rng.uniform(5, 80):.1f} 0 0"
    items = f'<item objectid="1"/>\n<item objectid="1" transform="{by}"/>'
    return _item(data, items), f"a second item: {by}"


def _emptied(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """No triangle, no item or no object is left."""
    tag = ("triangles", "build", "resources")[int(rng.integers(3))]
    text = re.sub(rf"(<{tag}>).*(</{tag}>)", r"\1\2", data.decode(), flags=re.DOTALL)
    return text.encode(), f"<{tag}> is empty"


def _item(data: bytes, items: str) -> bytes:
    text = data.decode()
    if '<item objectid="1"/>' not in text:
        raise NotApplicableError
    return text.replace('<item objectid="1"/>', items).encode()


_UNITS = replaced(
    *(('unit="millimeter"', f'unit="{unit}"') for unit in ("inch", "centimeter", "micron", "meter"))
)
THREEMF: Mutators = {kind: of_model(in_model(damage)) for kind, damage in DAMAGES.items()} | {
    "unit": of_model(_UNITS),
    "transform": of_model(_transformed),
    "second item": of_model(_second_item),
    "empty": of_model(_emptied),
}
