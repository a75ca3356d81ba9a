"""Reading a mask's SVG and DXF, in mm with y up; x is mirrored as on the page."""

import math
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as XmlTree

import ezdxf
import numpy as np
from ezdxf import units

from lumitip_fab.checks.mask_holes import Black, place, sort_out
from lumitip_fab.checks.readers import MALFORMED
from lumitip_fab.checks.readers.mask_page import PageError, Points, Subpath
from lumitip_fab.checks.readers.plain_dxf import read_plain_dxf
from lumitip_fab.design import Mask

_SVG = "{http://www.w3.org/2000/svg}"
_NONE = np.zeros((0, 2))
_HANDLE = 0.5522847498
_WORDS = {"M": 1, "L": 1, "C": 3, "Z": 0}
_NUMBER = r"-?\d+(?:\.\d+)?"


@dataclass(frozen=True, eq=False)
class Drawing:
    """Contents of both drawings, and the cut lines of the DXF."""

    black: tuple[Subpath, ...]
    marks: Points
    bands: tuple[Points, ...]
    folds: tuple[Points, ...]
    cut: Points = field(default_factory=lambda: _NONE)


def read_svg(path: Path) -> Drawing:
    """Read an SVG whose black is one path of absolute M, L, C and Z.

    Raises:
        PageError: if it is missing, damaged, not in mm or 1:1, or has no such path.
    """
    try:
        root = XmlTree.parse(path).getroot()
        _one_to_one(root)
        elements = {e.get("id"): e for e in root.iter() if e.get("id")}
        black = _path_data(elements["black"].attrib["d"])
        bands, folds = (_path_data(elements[e].attrib["d"]) for e in ("bands", "fold"))
        rings = elements["registration"].iter(f"{_SVG}circle")
        marks = [(float(e.attrib["cx"]), -float(e.attrib["cy"])) for e in rings]
    except FileNotFoundError as error:
        raise PageError("no such file") from error
    except (OSError, XmlTree.ParseError, *MALFORMED) as error:
        raise PageError(f"cannot be read: {error!r:.200}") from error
    return Drawing(
        black,
        np.array(marks).reshape(-1, 2),
        tuple(run.corners for run in bands),
        tuple(run.corners for run in folds),
    )


def _one_to_one(root: XmlTree.Element) -> None:
    box = [float(v) for v in root.attrib["viewBox"].split()]
    for name, units_wide in zip(("width", "height"), box[2:], strict=True):
        size = root.attrib[name]
        if not size.endswith("mm") or not math.isclose(float(size[:-2]), units_wide):
            raise ValueError(f"{name} {size} for {units_wide:g} units is not 1:1 in mm")


def _path_data(data: str) -> tuple[Subpath, ...]:
    runs = []
    for text in filter(None, map(str.strip, data.split("M"))):
        if not text.endswith("Z") or re.search(r"[^MLCZ\d.,\s-]", text):
            raise ValueError(f"path {text[:40]!r} is not closed, or not of M, L and C")
        words = re.findall(rf"([MLC])((?:[ ,]?{_NUMBER})*)", "M" + text)
        corners, controls = [], []
        for letter, numbers in words:
            points = np.array(re.findall(_NUMBER, numbers), dtype=float).reshape(-1, 2) * (
                1.0,
                -1.0,
            )
            if len(points) != _WORDS[letter]:
                raise ValueError(f"path {text[:40]!r}: {letter} with {len(points)} points")
            corners.append(points[-1])
            controls += list(points[:-1])
        runs.append(_closed(np.array(corners), np.array(controls).reshape(-1, 2)))
    return tuple(runs)


def _closed(corners: Points, controls: Points) -> Subpath:
    again = len(corners) > 1 and np.allclose(corners[0], corners[-1], atol=1e-6)
    return Subpath(corners[:-1] if again else corners, controls, True)


def read_dxf(path: Path) -> Drawing:
    """Read a DXF by its layers.

    Raises:
        PageError: if it is missing, damaged, not in mm, or lacks a layer's drawing.
    """
    try:
        document = read_plain_dxf(path)
        space = document.modelspace()
        layers: dict[str, list[Any]] = {}
        for entity in space:
            layers.setdefault(entity.dxf.layer, []).append(entity)
        if document.units != units.MM:
            raise PageError("its unit is not the millimetre")
        runs = [_run(e) for name in ("BLACK", "WINDOW", "APERTURES") for e in layers[name]]
        bands = [_run(e).corners for e in layers["BANDS"]]
        marks = [e.dxf.center for e in layers["MARKS"] if e.dxftype() == "CIRCLE"]
        cuts = [_run(e).corners for e in layers["CUT"]]
        folds = [np.array([(p.x, p.y) for p in (e.dxf.start, e.dxf.end)]) for e in layers["FOLD"]]
    except FileNotFoundError as error:
        raise PageError("no such file") from error
    except (OSError, ezdxf.DXFError, *MALFORMED) as error:
        raise PageError(f"cannot be read: {error!r:.200}") from error
    if len(cuts) != 1:
        raise PageError(f"{len(cuts)} paths on layer CUT, one is needed")
    places = np.array([(p.x, p.y) for p in marks]).reshape(-1, 2)
    return Drawing(tuple(runs), places, tuple(bands), tuple(folds), cuts[0])


@dataclass(frozen=True, eq=False)
class Film:
    """The film of a finger in its sensor frame, as its DXF has it."""

    black: Black
    cut: Points
    folds: tuple[Points, ...]


def read_film(outputs: Path, finger: str, mask: Mask) -> Film:
    """Read what the other routes of a mask share with its film.

    Raises:
        PageError: if the DXF is missing, damaged, or not a mask's.
    """
    drawing = read_dxf(outputs / f"mask/{finger}_mask.dxf")
    placed = place(drawing.marks, mask)
    black = sort_out(placed.subpath(run) for run in drawing.black)
    return Film(black, placed.points(drawing.cut), tuple(map(placed.points, drawing.folds)))


def _run(entity: Any) -> Subpath:
    """A closed polyline, or a circle as four cubics."""
    if entity.dxftype() == "LWPOLYLINE" and entity.closed:
        return _closed(np.array([p[:2] for p in entity.get_points()], dtype=float), _NONE)
    centre, r = np.array([entity.dxf.center.x, entity.dxf.center.y]), float(entity.dxf.radius)
    quarter = np.array([(1, 0), (1, _HANDLE), (_HANDLE, 1)])
    turn = np.array([(0.0, 1.0), (-1.0, 0.0)])
    turned = [centre + r * quarter @ np.linalg.matrix_power(turn, n) for n in range(4)]
    corners = np.array([q[0] for q in turned])
    return Subpath(corners, np.concatenate([q[1:] for q in turned]), True)
