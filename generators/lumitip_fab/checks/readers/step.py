"""A STEP file as the box round its vertices."""

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.errors import OutputError

_POINT = re.compile(r"#(\d+)=CARTESIAN_POINT\('[^']*',\(([^()]*)\)\)")
_VERTEX = re.compile(r"VERTEX_POINT\('[^']*',#(\d+)\)")
_BLANK = re.compile(r"\s+")


def bounds_mm(path: Path) -> NDArray[np.float64]:
    """Least and greatest x, y and z of all vertices, in the frame of the file; shape `(2, 3)`.

    Only for files whose bodies are not moved: those of single packages.

    Raises:
        OutputError: if the file is missing or has no vertices.
    """
    try:
        text = _BLANK.sub("", path.read_text(encoding="ascii"))
        points = dict(_POINT.findall(text))
        found = [[float(v) for v in points[n].split(",")] for n in _VERTEX.findall(text)]
        corners = np.array(found, dtype=np.float64).reshape(-1, 3)
        return np.array([corners.min(axis=0), corners.max(axis=0)])
    except FileNotFoundError as error:
        raise OutputError(f"{path}: no such file") from error
    except (OSError, ValueError, KeyError) as error:
        raise OutputError(f"{path}: cannot be read as STEP: {error!r:.200}") from error
