"""Vertices of STL, STEP and VRML files, read without a mesh library, whose import takes half a
second."""

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.errors import OutputError

_HEADER = 84  # 80 bytes of text, and how many triangles follow
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_POINT = re.compile(r"#(\d+)=CARTESIAN_POINT\('[^']*',\(([^()]*)\)\)")
_VERTEX = re.compile(r"VERTEX_POINT\('[^']*',#(\d+)\)")
_POINTS = re.compile(r"\bpoint\s*\[([^\]]*)\]")
_FACES = re.compile(r"\bcoordIndex\s*\[([^\]]*)\]")
_VRML_MM = 2.54  # KiCad reads a unit of VRML as a tenth of an inch
_BLANK = re.compile(r"\s+")


def corners_mm(path: Path) -> NDArray[np.float64]:
    """Corners of all triangles, shape (3 · triangles, 3), in the file's frame.

    Raises:
        OutputError: if the file is missing, is no binary STL, or holds no or no finite corner.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise OutputError(f"cannot be read: {error.strerror}") from error
    count = int.from_bytes(data[_HEADER - 4 : _HEADER], "little")
    if not count or len(data) != _HEADER + count * _TRIANGLE.itemsize:
        raise OutputError(f"is no binary STL: {len(data)} bytes for {count} triangles")
    corners = np.frombuffer(data, _TRIANGLE, offset=_HEADER)["corners"].reshape(-1, 3)
    if not np.isfinite(corners).all():
        raise OutputError("has corners that are not finite")
    return corners.astype(float)


def step_mm(path: Path) -> NDArray[np.float64]:
    """All vertices of a STEP file, shape `(n, 3)`.

    Only for files whose bodies are not moved: those of single parts.

    Raises:
        OutputError: if the file is missing, is not in mm, or has no vertices.
    """
    try:
        text = _BLANK.sub("", path.read_text(encoding="ascii"))
        points = dict(_POINT.findall(text))
        found = [[float(v) for v in points[n].split(",")] for n in _VERTEX.findall(text)]
        if not found or "SI_UNIT(.MILLI.,.METRE.)" not in text:
            raise ValueError("no vertices in mm")
        return np.array(found, dtype=np.float64).reshape(-1, 3)
    except FileNotFoundError as error:
        raise OutputError(f"{path}: no such file") from error
    except (OSError, ValueError, KeyError) as error:
        raise OutputError(f"{path}: cannot be read as STEP: {error!r:.200}") from error


def vrml_mm(path: Path) -> NDArray[np.float64]:
    """Corners of all faces of a VRML file as KiCad reads it, shape `(n, 3)`.

    Raises:
        OutputError: if the file is missing, is no VRML 2.0, or has a face without corners.
    """
    try:
        text = path.read_text(encoding="ascii")
        points = [np.array(p.replace(",", " ").split(), float) for p in _POINTS.findall(text)]
        faces = [np.array(f.replace(",", " ").split(), int) for f in _FACES.findall(text)]
        if not text.startswith("#VRML V2.0 utf8\n") or not points or len(points) != len(faces):
            raise ValueError("no shapes of VRML 2.0")
        corners = [p.reshape(-1, 3)[f[f >= 0]] for p, f in zip(points, faces, strict=True)]
        found = _VRML_MM * np.concatenate(corners)
        if not len(found) or not np.isfinite(found).all():
            raise ValueError("no corners")
        return found
    except FileNotFoundError as error:
        raise OutputError(f"{path}: no such file") from error
    except (OSError, ValueError, IndexError) as error:
        raise OutputError(f"{path}: cannot be read as VRML: {error!r:.200}") from error
