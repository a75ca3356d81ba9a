"""Layers of extruded lines, mass and time from a slicer's G-code."""

import re
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from lumitip_fab.errors import BuildError

_WORD = re.compile(r"([XYE])(-?\d*\.?\d+)")
_STEP_MM = 0.2  # between points of a line; finer than the widths of lines
_UNITS_S = {"d": 86400, "h": 3600, "m": 60, "s": 1}
_NO_PART = ("Skirt/Brim", "Custom", "Support")


@dataclass(frozen=True, eq=False)
class Layer:
    """Extrusion of one layer of the part, without brim and support."""

    z_mm: float
    points_mm: NDArray[np.float64]
    """Along the lines, at most 0.2 mm apart, shape `(n, 2)`."""
    length_mm: float
    """Length of all its lines."""


def seconds(text: str) -> int:
    """The slicer's own estimate of the time.

    Raises:
        BuildError: if the G-code has none.
    """
    found = re.search(r"^; estimated printing time \(normal mode\) = (.+)$", text, re.MULTILINE)
    if not found:
        raise BuildError("the slicer's G-code has no time")
    return sum(int(n) * _UNITS_S[unit] for n, unit in re.findall(r"(\d+)([dhms])", found[1]))


def grams(text: str) -> float:
    """Mass of all that is extruded, brim too.

    Raises:
        BuildError: if the G-code has none.
    """
    found = re.search(r"^; total filament used \[g\] = ([\d.]+)$", text, re.MULTILINE)
    if not found:
        raise BuildError("the slicer's G-code has no mass")
    return float(found[1])


def layers(text: str) -> tuple[Layer, ...]:
    """The layers from the bed up. Needs absolute coordinates, and PrusaSlicer's own comments."""
    lines: dict[float, list[NDArray[np.float64]]] = {}
    x = y = z = e = 0.0
    kind = ""
    for line in text.splitlines():
        if line.startswith(";TYPE:"):
            kind = line[6:]
        elif line.startswith(";Z:"):
            z = float(line[3:])
        elif line.startswith("G92 "):
            e = 0.0
        elif line.startswith(("G0 ", "G1 ")):
            words = {name: float(value) for name, value in _WORD.findall(line)}
            before, (x, y) = (x, y), (words.get("X", x), words.get("Y", y))
            pushed, e = words.get("E", e) - e, words.get("E", e)
            if pushed > 0 and (x, y) != before and not kind.startswith(_NO_PART):
                lines.setdefault(z, []).append(_along(before, (x, y)))
    return tuple(
        Layer(z, np.concatenate(lines[z]), sum(float(np.hypot(*(a[-1] - a[0]))) for a in lines[z]))
        for z in sorted(lines)
    )


def reach_mm(layers_of: tuple[Layer, ...]) -> tuple[float, float]:
    """How far at most a line is from the nearest one of the layer below it, and at what height
    (mm): what a bridge spans is up to twice as much."""
    worst, at_mm = 0.0, 0.0
    for below, layer in pairwise(layers_of):
        far = float(cKDTree(below.points_mm).query(layer.points_mm)[0].max())
        if far > worst:
            worst, at_mm = far, layer.z_mm
    return worst, at_mm


def _along(begin: tuple[float, float], end: tuple[float, float]) -> NDArray[np.float64]:
    a, b = np.array(begin), np.array(end)
    steps = max(1, int(np.ceil(np.linalg.norm(b - a) / _STEP_MM)))
    share = np.linspace(0.0, 1.0, steps + 1)[:, None]
    points: NDArray[np.float64] = a + share * (b - a)
    return points
