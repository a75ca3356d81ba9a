"""Ways to hurt a GLB file of named bodies."""

import json
import struct
from collections.abc import Callable
from typing import Any

Told = dict[str, Any]


def node(told: Told, name: str) -> Told:
    """The node of a group or a body."""
    return next(n for n in told["nodes"] if n["name"] == name)


def move(told: Told, name: str, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> None:
    """Move a body in its group, mm."""
    at = node(told, name)
    before = at.get("translation", [0.0, 0.0, 0.0])
    at["translation"] = [a + b / 1000 for a, b in zip(before, (x, y, z), strict=True)]


def shift(told: Told, group: str, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> None:
    """Move a group in the scene, mm."""
    matrix = node(told, group)["matrix"]
    for place, by_mm in enumerate((x, y, z)):
        matrix[12 + place] += by_mm / 1000


def material(told: Told, name: str) -> Told:
    """The material of a body."""
    return told["materials"][primitive(told, name)["material"]]


def primitive(told: Told, name: str) -> Told:
    """The triangles of a body with their material."""
    return told["meshes"][node(told, name)["mesh"]]["primitives"][0]


def film_like_the_board(told: Told) -> None:
    """One colour for two layers."""
    of_board = material(told, "emitter.board")["pbrMetallicRoughness"]["baseColorFactor"]
    factors = material(told, "emitter.film")["pbrMetallicRoughness"]["baseColorFactor"]
    factors[:3] = of_board[:3]
    material(told, "emitter.film").pop("alphaMode")


def materials_lost(told: Told) -> None:
    """No body has one."""
    for mesh in told["meshes"]:
        del mesh["primitives"][0]["material"]


def colours_lost(told: Told) -> None:
    """Materials without what they look like."""
    for each in told["materials"]:
        del each["pbrMetallicRoughness"]


def opaque_silicone(told: Told) -> None:
    """What hides the board."""
    del material(told, "emitter.silicone")["alphaMode"]


def other_material(told: Told) -> None:
    """A backing that looks like the parts of a board."""
    primitive(told, "receiver.backing")["material"] = primitive(told, "emitter.D1")["material"]


COLOURS = (film_like_the_board, materials_lost, colours_lost, opaque_silicone, other_material)
"""Damages of what a viewer shows."""


def rewritten(data: bytes, damage: Callable[[Told], None]) -> bytes:
    """A GLB file with its tables changed."""
    size = struct.unpack_from("<I", data, 12)[0]
    told, rest = json.loads(data[20 : 20 + size]), data[20 + size :]
    damage(told)
    text = json.dumps(told).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest))
    return head + struct.pack("<I4s", len(text), b"JSON") + text + rest


def opened(data: bytes, body: str) -> bytes:
    """Make the first triangle of a body a corner."""
    size = struct.unpack_from("<I", data, 12)[0]
    told = json.loads(data[20 : 20 + size])
    primitive = told["meshes"][node(told, body)["mesh"]]["primitives"][0]
    view = told["bufferViews"][told["accessors"][primitive["indices"]]["bufferView"]]
    at = 28 + size + view["byteOffset"]
    return data[:at] + data[at + 4 : at + 8] + data[at + 4 :]
