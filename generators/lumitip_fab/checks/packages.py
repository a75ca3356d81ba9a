"""The same part in its other files: 3MF and STEP against the STL that was measured."""

import re
import zipfile
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from lumitip_fab.checks.printed import Printed
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.checks.solids import Vectors

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
    prefix: str, outputs: Path, stl: str, standing: Vectors, sensor: Vectors
) -> Iterator[Measurement]:
    """How far the boxes round 3MF and STEP differ from the STL's, and what else they hold.

    Args:
        prefix: of the checks' names.
        outputs: the output folder.
        stl: the part's STL file in it; the others lie beside it.
        standing: bounds of the part in the printer, shape `(2, 3)`.
        sensor: its bounds in the sensor frame.
    """
    for kind, read, bounds in (("three_mf", _three_mf, standing), ("step", _step, sensor)):
        path = stl.replace(".stl", ".3mf" if kind == "three_mf" else ".step")
        try:
            points = read(outputs / path)
        except (OSError, ValueError, LookupError, SyntaxError, zipfile.BadZipFile) as error:
            yield unreadable(f"{prefix}.{kind}", path, f"cannot be read: {error!r:.200}")
            continue
        off = np.abs(np.array([points.min(axis=0), points.max(axis=0)]) - bounds).max()
        yield Measurement(f"{prefix}.{kind}", path, float(off), 0.0, AGREE_MM, "mm")


def _three_mf(path: Path) -> Vectors:
    with zipfile.ZipFile(path) as package:
        model = ElementTree.fromstring(package.read("3D/3dmodel.model"))
    if model.get("unit") != "millimeter":
        raise ValueError(f"unit {model.get('unit')!r}, millimeter is needed")
    vertices = model.iter(f"{_NAMESPACE}vertex")
    return np.array([[float(v.attrib[axis]) for axis in "xyz"] for v in vertices])


def _step(path: Path) -> Vectors:
    text = re.sub(r"\n\s*", "", path.read_text(encoding="ascii"))
    solids = text.count("MANIFOLD_SOLID_BREP(")
    if solids != 1 or "SI_UNIT(.MILLI.,.METRE.)" not in text:
        raise ValueError(f"{solids} solids, one in mm is needed")
    points = {n: (float(x), float(y), float(z)) for n, x, y, z in _POINT.findall(text)}
    return np.array([points[n] for n in _VERTEX.findall(text)])
