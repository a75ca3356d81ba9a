"""Read what a slicer would print from a 3MF file."""

import math
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.checks.readers import MALFORMED
from lumitip_fab.checks.readers.solids import Vectors
from lumitip_fab.checks.readers.tables import unpacked
from lumitip_fab.errors import OutputError

_MODEL = "3D/3dmodel.model"
_NAMESPACE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
_AXES, _CORNERS = "xyz", ("v1", "v2", "v3")


def three_mf_triangles(path: Path) -> Vectors:
    """Triangles of all items on the build plate, moved to their places, shape `(n, 3, 3)` (mm).

    Raises:
        OutputError: if it is missing, damaged, not in mm, or has no item, an item or an object of
            another kind, or numbers that are not finite.
    """
    try:
        package = unpacked(path)
        if package.keys() != {_MODEL, "[Content_Types].xml", "_rels/.rels"}:
            raise ValueError(f"holds other files than one model: {', '.join(sorted(package))}")
        model = ElementTree.fromstring(package[_MODEL])
        if model.get("unit") != "millimeter":
            raise ValueError(f"unit {model.get('unit')!r}, millimeter is needed")
        objects = {o.attrib["id"]: o for o in model.iter(f"{_NAMESPACE}object")}
        items = [item.attrib for item in model.iter(f"{_NAMESPACE}item")]
        found = np.concatenate([_item(objects[item["objectid"]], item) for item in items])
        if not np.isfinite(found).all():
            raise ValueError("a number that is not finite")
    except (OSError, SyntaxError, *MALFORMED) as error:
        raise OutputError(f"cannot be read: {error!r:.200}") from error
    return found


def _item(shape: ElementTree.Element, item: dict[str, str]) -> Vectors:
    """Triangles of an object where the build plate has it."""
    if shape.get("type", "model") != "model" or shape.find(f"{_NAMESPACE}components") is not None:
        raise ValueError("an object that is no single mesh")
    if item.get("printable", "1") in {"0", "false"}:
        raise ValueError("an item that is not printed")
    points = _table(shape, "vertex", _AXES, float)
    corners = _table(shape, "triangle", _CORNERS, int)
    if corners.size == 0 or corners.min() < 0:
        raise ValueError("no triangles, or corners below zero")
    if not _is_closed(corners):
        raise ValueError("a mesh that is open, or has triangles that are turned over")
    matrix = np.array((item.get("transform") or "1 0 0 0 1 0 0 0 1 0 0 0").split(), dtype=float)
    turn, shift = matrix[:9].reshape(3, 3), matrix[9:]
    if not math.isclose(float(np.linalg.det(turn)), 1.0, abs_tol=1e-6):
        raise ValueError("an item that is scaled or mirrored")
    return np.asarray((points @ turn + shift)[corners], dtype=np.float64)


def _is_closed(corners: NDArray[np.generic]) -> bool:
    """Whether each edge of a triangle is there once, and once the other way, as the format asks."""
    begin, end = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    there, back = (np.unique(a * (corners.max() + 1) + b) for a, b in ((begin, end), (end, begin)))
    return len(there) == len(begin) and bool(np.array_equal(there, back))


def _table(
    shape: ElementTree.Element, tag: str, names: tuple[str, ...] | str, kind: type
) -> np.ndarray[tuple[int, int], np.dtype[np.generic]]:
    rows = [[kind(e.attrib[name]) for name in names] for e in shape.iter(f"{_NAMESPACE}{tag}")]
    return np.array(rows).reshape(-1, 3)
