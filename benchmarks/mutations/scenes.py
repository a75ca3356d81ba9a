"""GLB scenes and PNG pictures."""

import io
import json
import struct
from typing import Any

import numpy as np
from numpy.random import Generator
from PIL import Image

from mutations.amounts import cut_short, distance_mm, factor
from mutations.damage import Mutators, NotApplicableError
from mutations.meshes import AXES

_PREFIX = 20  # header of the file and of its first chunk
_MM = 0.001
_SEEN = 24  # of 255
_LEAST_PIXELS = 50


def _read(data: bytes) -> tuple[dict[str, Any], bytearray]:
    size = struct.unpack("<I", data[12:16])[0]
    return json.loads(data[_PREFIX : _PREFIX + size]), bytearray(data[_PREFIX + size + 8 :])


def _written(scene: dict[str, Any], body: bytearray) -> bytes:
    text = json.dumps(scene, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    whole = 12 + 8 + len(text) + 8 + len(body)
    return b"".join(
        (
            struct.pack("<4sII", b"glTF", 2, whole),
            struct.pack("<I4s", len(text), b"JSON"),
            text,
            struct.pack("<I4s", len(body), b"BIN\0"),
            bytes(body),
        )
    )


def _vertices(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """The corners of one mesh moved or scaled."""
    scene, body = _read(data)
    mesh = scene["meshes"][int(rng.integers(len(scene["meshes"])))]
    accessor = scene["accessors"][mesh["primitives"][0]["attributes"]["POSITION"]]
    view = scene["bufferViews"][accessor["bufferView"]]
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    corners = np.frombuffer(body, "<f4", accessor["count"] * 3, start).reshape(-1, 3).copy()
    axis = int(rng.integers(3))
    if rng.random() < 0.5:
        by = distance_mm(rng)
        corners[:, axis] += by * _MM
        done = f"moved by {by:g} mm in {AXES[axis]}"
    else:
        by = factor(rng)
        if np.ptp(corners[:, axis]) * abs(by - 1) < 0.2 * _MM:
            raise NotApplicableError
        corners[:, axis] *= by
        done = f"scaled by {by:g} in {AXES[axis]}"
    body[start : start + corners.nbytes] = corners.tobytes()
    accessor["min"], accessor["max"] = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    return _written(scene, body), f"mesh {mesh['name']} {done}"


def _node(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """A node moved, by its matrix."""
    scene, body = _read(data)
    node = scene["nodes"][int(rng.integers(len(scene["nodes"])))]
    matrix = np.array(node.get("matrix", np.eye(4).ravel()), dtype=np.float64)
    axis, by = int(rng.integers(3)), distance_mm(rng)
    matrix[12 + axis] += by * _MM
    node["matrix"] = matrix.tolist()
    return _written(scene, body), f"node {node.get('name')} moved by {by:g} mm in {AXES[axis]}"


def _node_removed(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """A node that its parent no longer has."""
    scene, body = _read(data)
    parents = [n["children"] for n in scene["nodes"] if n.get("children")]
    parents += [s["nodes"] for s in scene["scenes"]]
    children = parents[int(rng.integers(len(parents)))]
    gone = children.pop(int(rng.integers(len(children))))
    for node in scene["nodes"]:
        if node.get("children") == []:
            del node["children"]
    return _written(scene, body), f"node {scene['nodes'][gone].get('name')} is gone"


def _meshes_swapped(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """Two nodes with each other's mesh."""
    scene, body = _read(data)
    nodes = [n for n in scene["nodes"] if "mesh" in n]
    one = nodes[int(rng.integers(len(nodes)))]
    others = [n for n in nodes if n["mesh"] != one["mesh"]]
    other = others[int(rng.integers(len(others)))]
    one["mesh"], other["mesh"] = other["mesh"], one["mesh"]
    return _written(scene, body), f"{one['name']} and {other['name']} have each other's mesh"


GLB: Mutators = {
    "move a part": _vertices,
    "move": _node,
    "remove": _node_removed,
    "swap meshes": _meshes_swapped,
    "truncate": cut_short,
}


def _picture(data: bytes) -> Image.Image:
    return Image.open(io.BytesIO(data)).convert("RGB")


def _saved(picture: Image.Image, before: Image.Image, done: str) -> tuple[bytes, str]:
    """The picture as a file, unless it looks as before."""
    if picture.size == before.size:
        apart = np.abs(np.int16(np.asarray(picture)) - np.int16(np.asarray(before))).max(axis=2)
        if np.count_nonzero(apart > _SEEN) < _LEAST_PIXELS:
            raise NotApplicableError
    target = io.BytesIO()
    picture.save(target, "PNG")
    return target.getvalue(), done


def _flipped(data: bytes, rng: Generator) -> tuple[bytes, str]:
    before = _picture(data)
    hows = (
        Image.Transpose.FLIP_LEFT_RIGHT,
        Image.Transpose.FLIP_TOP_BOTTOM,
        Image.Transpose.ROTATE_180,
    )
    how = hows[int(rng.integers(3))]
    return _saved(before.transpose(how), before, how.name.lower().replace("_", " "))


def _painted(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """A block in its opposite colour."""
    before = _picture(data)
    pixels = np.asarray(before).copy()
    high, wide = (max(int(s * rng.uniform(0.05, 0.3)), 8) for s in pixels.shape[:2])
    top, left = (int(rng.integers(s - n)) for s, n in zip(pixels.shape, (high, wide), strict=False))
    pixels[top : top + high, left : left + wide] = (
        255 - pixels[top : top + high, left : left + wide]
    )
    done = f"{wide} x {high} pixels at {left}, {top} in the opposite colour"
    return _saved(Image.fromarray(pixels), before, done)


def _shifted(data: bytes, rng: Generator) -> tuple[bytes, str]:
    before = _picture(data)
    by = max(int(before.width * rng.uniform(0.02, 0.2)), 4)
    return _saved(
        Image.fromarray(np.roll(np.asarray(before), by, axis=1)), before, f"shifted by {by}"
    )


PNG: Mutators = {
    "mirror": _flipped,
    "paint over": _painted,
    "move": _shifted,
    "truncate": cut_short,
}
