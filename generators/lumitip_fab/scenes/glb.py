"""Coloured bodies to the bytes of a binary glTF file, in metres."""

import json
import struct
from dataclasses import dataclass, field
from typing import Any

from lumitip_fab.design.frames import Matrix
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.text import table_of

Colour = tuple[float, float, float, float]
"""Red, green, blue as seen on a screen (sRGB) and opacity, each 0 to 1."""


def colour_of(kind: str) -> Colour:
    """Colour of a body, by `colours.toml`."""
    red, green, blue, opacity = table_of("scenes/colours.toml")["colours"][kind]
    return red, green, blue, opacity


def tints(table: str = "tints") -> dict[str, str]:
    """Tints of the exploded drawings, of layers or (`"part_tints"`) of parts."""
    return dict(table_of("scenes/colours.toml")[table])


_MAGIC, _VERSION, _JSON, _BINARY = 0x46546C67, 2, 0x4E4F534A, 0x004E4942
_FLOAT, _UNSIGNED, _VERTICES, _INDICES = 5126, 5125, 34962, 34963
_TO_M = 0.001


@dataclass(frozen=True, eq=False)
class Body:
    """A named body; bodies may share one mesh object, which is then stored once."""

    name: str
    mesh: Mesh
    colour: Colour
    at_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Group:
    """Bodies that move together."""

    name: str
    to_scene: Matrix
    """From the bodies' frame to the scene (4x4, mm)."""
    bodies: tuple[Body, ...]


def glb(scene: str, groups: tuple[Group, ...], extras: dict[str, float]) -> bytes:
    """A GLB file with a node for each group and each body.

    Args:
        scene: name of the root.
        groups: what is in it.
        extras: what else the file says of the scene.
    """
    store = _Store()
    nodes: list[dict[str, Any]] = []
    roots = []
    for group in groups:
        children = []
        for body in group.bodies:
            node: dict[str, Any] = {"name": body.name, "mesh": store.mesh(body)}
            if any(body.at_mm):
                node["translation"] = [v * _TO_M for v in body.at_mm]
            children.append(len(nodes))
            nodes.append(node)
        matrix = group.to_scene.copy()
        matrix[:3, 3] *= _TO_M
        roots.append(len(nodes))
        flat = [v + 0.0 for v in matrix.T.ravel().tolist()]
        nodes.append({"name": group.name, "matrix": flat, "children": children})
    document = {
        "asset": {"version": "2.0", "generator": "Lumitip"},
        "scene": 0,
        "scenes": [{"name": scene, "nodes": roots, "extras": extras}],
        "nodes": nodes,
        **store.tables(),
    }
    return _packed(document, b"".join(store.chunks))


@dataclass
class _Store:
    """Meshes, materials and their data, each once."""

    chunks: list[bytes] = field(default_factory=list)
    views: list[dict[str, Any]] = field(default_factory=list)
    accessors: list[dict[str, Any]] = field(default_factory=list)
    primitives: dict[int, tuple[int, int]] = field(default_factory=dict)
    materials: dict[Colour, int] = field(default_factory=dict)
    meshes: dict[tuple[int, Colour], int] = field(default_factory=dict)
    named: list[dict[str, Any]] = field(default_factory=list)

    def mesh(self, body: Body) -> int:
        """Index of the body's mesh in its colour."""
        key = (id(body.mesh), body.colour)
        if key not in self.meshes:
            points, corners = self._primitive(body.mesh)
            material = self.materials.setdefault(body.colour, len(self.materials))
            primitive = {
                "attributes": {"POSITION": points},
                "indices": corners,
                "material": material,
            }
            self.meshes[key] = len(self.named)
            self.named.append({"name": body.name, "primitives": [primitive]})
        return self.meshes[key]

    def tables(self) -> dict[str, Any]:
        """The file's tables."""
        return {
            "meshes": self.named,
            "materials": [_material(colour) for colour in self.materials],
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": sum(map(len, self.chunks))}],
        }

    def _primitive(self, mesh: Mesh) -> tuple[int, int]:
        if id(mesh) not in self.primitives:
            points = (mesh.points_mm * _TO_M).astype("<f4")
            extent = {"min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()}
            place = self._add(points.tobytes(), _VERTICES, _FLOAT, len(points), "VEC3", extent)
            corners = mesh.triangles.astype("<u4")
            data, count = corners.tobytes(), corners.size
            self.primitives[id(mesh)] = (
                place,
                self._add(data, _INDICES, _UNSIGNED, count, "SCALAR", {}),
            )
        return self.primitives[id(mesh)]

    def _add(
        self, data: bytes, target: int, kind: int, count: int, shape: str, extent: dict[str, Any]
    ) -> int:
        offset = sum(map(len, self.chunks))
        self.chunks.append(data)
        view = {"buffer": 0, "byteOffset": offset, "byteLength": len(data), "target": target}
        self.views.append(view)
        self.accessors.append(
            {
                "bufferView": len(self.views) - 1,
                "componentType": kind,
                "count": count,
                "type": shape,
                **extent,
            }
        )
        return len(self.accessors) - 1


def _material(colour: Colour) -> dict[str, Any]:
    linear = [round(_linear(c), 6) for c in colour[:3]]
    material: dict[str, Any] = {
        "pbrMetallicRoughness": {
            "baseColorFactor": [*linear, colour[3]],
            "metallicFactor": 0.0,
            "roughnessFactor": 0.6,
        }
    }
    if colour[3] < 1:
        material["alphaMode"] = "BLEND"
    return material


def _linear(c: float) -> float:
    """glTF wants colours linear in light."""
    return float(c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4)


def _packed(document: dict[str, Any], data: bytes) -> bytes:
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    length = 12 + 8 + len(text) + 8 + len(data)
    head = struct.pack("<III", _MAGIC, _VERSION, length)
    parts = (struct.pack("<II", len(text), _JSON), text, struct.pack("<II", len(data), _BINARY))
    return b"".join((head, *parts, data))
