"""Ways to hurt a GLB file of named bodies."""

import json
import struct
from collections.abc import Callable
from typing import Any

Scene = dict[str, Any]


def node(scene: Scene, name: str) -> Scene:
    """The node of a group or a body."""
    return next(n for n in scene["nodes"] if n["name"] == name)


def move(scene: Scene, name: str, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> None:
    """Move a body in its group, mm."""
    at = node(scene, name)
    before = at.get("translation", [0.0, 0.0, 0.0])
    at["translation"] = [a + b / 1000 for a, b in zip(before, (x, y, z), strict=True)]


def shift(scene: Scene, group: str, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> None:
    """Move a group in the scene, mm."""
    matrix = node(scene, group)["matrix"]
    for place, by_mm in enumerate((x, y, z)):
        matrix[12 + place] += by_mm / 1000


def material(scene: Scene, name: str) -> Scene:
    """The material of a body."""
    return scene["materials"][primitive(scene, name)["material"]]


def primitive(scene: Scene, name: str) -> Scene:
    """The triangles of a body with their material."""
    return scene["meshes"][node(scene, name)["mesh"]]["primitives"][0]


def film_like_the_board(scene: Scene) -> None:
    """One colour for two layers."""
    of_board = material(scene, "emitter.board")["pbrMetallicRoughness"]["baseColorFactor"]
    factors = material(scene, "emitter.film")["pbrMetallicRoughness"]["baseColorFactor"]
    factors[:3] = of_board[:3]
    material(scene, "emitter.film").pop("alphaMode")


def materials_lost(scene: Scene) -> None:
    """No body has one."""
    for mesh in scene["meshes"]:
        del mesh["primitives"][0]["material"]


def colours_lost(scene: Scene) -> None:
    """Materials without what they look like."""
    for each in scene["materials"]:
        del each["pbrMetallicRoughness"]


def opaque_silicone(scene: Scene) -> None:
    """It hides the board."""
    del material(scene, "emitter.silicone")["alphaMode"]


def other_material(scene: Scene) -> None:
    """A backing that looks like the parts of a board."""
    primitive(scene, "receiver.backing")["material"] = primitive(scene, "emitter.D1")["material"]


COLOURS = (film_like_the_board, materials_lost, colours_lost, opaque_silicone, other_material)
"""Damages of what a viewer shows."""


def rewritten(data: bytes, damage: Callable[[Scene], None]) -> bytes:
    """A GLB file with its tables changed."""
    size = struct.unpack_from("<I", data, 12)[0]
    scene, rest = json.loads(data[20 : 20 + size]), data[20 + size :]
    damage(scene)
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest))
    return head + struct.pack("<I4s", len(text), b"JSON") + text + rest


def opened(data: bytes, body: str) -> bytes:
    """Make the first triangle of a body a corner."""
    size = struct.unpack_from("<I", data, 12)[0]
    scene = json.loads(data[20 : 20 + size])
    primitive = scene["meshes"][node(scene, body)["mesh"]]["primitives"][0]
    view = scene["bufferViews"][scene["accessors"][primitive["indices"]]["bufferView"]]
    at = 28 + size + view["byteOffset"]
    return data[:at] + data[at + 4 : at + 8] + data[at + 4 :]
