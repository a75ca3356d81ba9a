"""The same part in its other files: 3MF and STEP against the STL that was measured."""

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from scipy.spatial import cKDTree

from lumitip_fab.checks.printed import Printed
from lumitip_fab.checks.readers.solids import Vectors
from lumitip_fab.checks.readers.tables import unpacked
from lumitip_fab.checks.result import Measurement, unreadable

AGREE_MM = 0.02
_NAMESPACE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
_VERTEX = re.compile(r"VERTEX_POINT\('',#(\d+)\)")
_POINT = re.compile(r"#(\d+) = CARTESIAN_POINT\('',\(([^,()]+),([^,()]+),([^,()]+)\)\)")


def measure_files(outputs: Path, part: Printed) -> Iterator[Measurement]:
    """How far the boxes round a backing's 3MF and STEP differ from the STL's."""
    yield from measure_boxes(
        "backing", outputs, part.subject, part.standing.bounds, part.sensor.bounds
    )


def measure_boxes(
    prefix: str, outputs: Path, stl: str, standing: Vectors, sensor: Vectors, solids: int = 1
) -> Iterator[Measurement]:
    """How far the boxes round 3MF and STEP differ from the STL's, and what else they hold.

    Args:
        prefix: of the checks' names.
        outputs: the output folder.
        stl: the part's STL file in it; the others lie beside it.
        standing: bounds of the part in the printer, shape `(2, 3)`.
        sensor: its bounds in the sensor frame.
        solids: how many the STEP file has to hold.
    """
    yield _measured(
        f"{prefix}.three_mf", outputs, stl.replace(".stl", ".3mf"), _three_mf, _from_box(standing)
    )
    yield _measured(
        f"{prefix}.step",
        outputs,
        stl.replace(".stl", ".step"),
        lambda path: _step(path, solids),
        _from_box(sensor),
    )


def measure_corners(
    prefix: str, outputs: Path, stl: str, standing: Vectors, corners: Vectors
) -> Iterator[Measurement]:
    """The same of a part whose widest places are round, where a STEP file has no corner: how far
    its corners lie from those of the STL.

    Args:
        prefix: of the checks' names.
        outputs: the output folder.
        stl: the part's STL file in it; the others lie beside it.
        standing: bounds of the part in the printer, shape `(2, 3)`.
        corners: the STL's corners in the STEP file's frame, shape `(n, 3)`.
    """
    tree = cKDTree(corners)

    def off_mm(points: Vectors) -> float:
        return float(tree.query(points)[0].max())

    yield _measured(
        f"{prefix}.three_mf", outputs, stl.replace(".stl", ".3mf"), _three_mf, _from_box(standing)
    )
    yield _measured(f"{prefix}.step", outputs, stl.replace(".stl", ".step"), _step, off_mm)


def _from_box(bounds: Vectors) -> Callable[[Vectors], float]:
    """How far the box round some points differs from this one."""
    return lambda points: float(
        np.abs(np.array([points.min(axis=0), points.max(axis=0)]) - bounds).max()
    )


def _measured(
    check: str,
    outputs: Path,
    path: str,
    read: Callable[[Path], Vectors],
    off_mm: Callable[[Vectors], float],
) -> Measurement:
    try:
        points = read(outputs / path)
    except (OSError, ValueError, LookupError, SyntaxError) as error:
        return unreadable(check, path, f"cannot be read: {error!r:.200}")
    return Measurement(check, path, off_mm(points), 0.0, AGREE_MM, "mm")


def _three_mf(path: Path) -> Vectors:
    model = ElementTree.fromstring(unpacked(path)["3D/3dmodel.model"])
    if model.get("unit") != "millimeter":
        raise ValueError(f"unit {model.get('unit')!r}, millimeter is needed")
    vertices = model.iter(f"{_NAMESPACE}vertex")
    return np.array([[float(v.attrib[axis]) for axis in "xyz"] for v in vertices])


def _step(path: Path, solids: int = 1) -> Vectors:
    text = re.sub(r"\n\s*", "", path.read_text(encoding="ascii"))
    found = text.count("MANIFOLD_SOLID_BREP(")
    if found != solids or "SI_UNIT(.MILLI.,.METRE.)" not in text:
        raise ValueError(f"{found} solids, {solids} in mm needed")
    points = {n: (float(x), float(y), float(z)) for n, x, y, z in _POINT.findall(text)}
    return np.array([points[n] for n in _VERTEX.findall(text)])
