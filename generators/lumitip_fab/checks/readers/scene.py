"""Read the named bodies of a GLB file."""

import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray

from lumitip_fab.checks.readers.solids import Vectors
from lumitip_fab.design.frames import Matrix, applied, translation
from lumitip_fab.errors import OutputError

_M_TO_MM = 1000.0
_CHUNK = 8
_START = 12
_TYPES = {5126: np.dtype("<f4"), 5125: np.dtype("<u4")}
_WIDTH = {"VEC3": 3, "SCALAR": 1}


@dataclass(frozen=True, eq=False)
class Node:
    """A body in the frame of its group, mm."""

    group: str
    points_mm: Vectors
    triangles: NDArray[np.int64]
    to_scene: Matrix
    """From the group's frame to the scene, mm."""
    colour: tuple[float, ...] | None
    """Of its material, with its opacity, as a viewer shows it; none without a material."""

    @property
    def mesh(self) -> Any:
        """The body in its group's frame."""
        return trimesh.Trimesh(self.points_mm, self.triangles, process=False)

    @property
    def in_scene_mm(self) -> Vectors:
        """The body's corners in the scene."""
        return applied(self.to_scene, self.points_mm)

    @property
    def centre_mm(self) -> Vectors:
        """Middle of its bounding box, in the scene."""
        middle = (self.points_mm.min(axis=0) + self.points_mm.max(axis=0)) / 2
        return np.asarray(applied(self.to_scene, middle[None])[0])


@dataclass(frozen=True, eq=False)
class Scene:
    """Contents of a GLB file."""

    nodes: dict[str, Node]
    extras: dict[str, object]


def read_scene(path: Path) -> Scene:
    """Groups of named bodies, two levels deep.

    Raises:
        OutputError: if the file is missing, cut short, or not such a scene.
    """
    try:
        return _scene(path.read_bytes())
    except FileNotFoundError as error:
        raise OutputError("no such file") from error
    except (OSError, ValueError, KeyError, IndexError, TypeError, struct.error) as error:
        raise OutputError(f"cannot be read: {error!r:.200}") from error


def _scene(data: bytes) -> Scene:
    magic, _, length = struct.unpack_from("<4sII", data)
    if magic != b"glTF" or length != len(data):
        raise ValueError(f"{len(data)} bytes where the file says {length}")
    size = struct.unpack_from("<I", data, _START)[0]
    document = json.loads(data[_START + _CHUNK : _START + _CHUNK + size])
    binary = data[_START + 2 * _CHUNK + size :]
    nodes: dict[str, Node] = {}
    scene = document["scenes"][document["scene"]]
    for root in scene["nodes"]:
        group = document["nodes"][root]
        to_scene = np.array(group["matrix"], dtype=np.float64).reshape(4, 4).T
        to_scene[:3, 3] *= _M_TO_MM
        for child in group["children"]:
            body = document["nodes"][child]
            nodes[body["name"]] = _node(document, binary, group["name"], body, to_scene)
    return Scene(nodes, scene.get("extras", {}))


def _node(
    document: dict[str, Any], binary: bytes, group: str, body: dict[str, Any], to_scene: Matrix
) -> Node:
    primitive = document["meshes"][body["mesh"]]["primitives"][0]
    points = _values(document, binary, primitive["attributes"]["POSITION"]).astype(np.float64)
    corners = _values(document, binary, primitive["indices"]).reshape(-1, 3).astype(np.int64)
    if not np.isfinite(points).all() or corners.max(initial=-1) >= len(points):
        raise ValueError(f"{body['name']} is not a mesh")
    x, y, z = (value * _M_TO_MM for value in body.get("translation", (0.0, 0.0, 0.0)))
    moved = applied(translation(x, y, z), points * _M_TO_MM)
    return Node(group, moved, corners, to_scene, _colour(document, primitive))


def _colour(document: dict[str, Any], primitive: dict[str, Any]) -> tuple[float, ...] | None:
    if "material" not in primitive:
        return None
    material = document["materials"][primitive["material"]]
    colour = material.get("pbrMetallicRoughness", {}).get("baseColorFactor")
    if colour is None:
        return None
    opacity = float(colour[3]) if material.get("alphaMode") == "BLEND" else 1.0
    return (*map(float, colour[:3]), opacity)


def _values(document: dict[str, Any], binary: bytes, which: int) -> NDArray[Any]:
    accessor = document["accessors"][which]
    view = document["bufferViews"][accessor["bufferView"]]
    width = _WIDTH[accessor["type"]]
    kind = _TYPES[accessor["componentType"]]
    values = np.frombuffer(binary, kind, accessor["count"] * width, view["byteOffset"])
    return values.reshape(-1, width)
