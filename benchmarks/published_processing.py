"""The published way from a frame to line and corner, as a yardstick for speed and accuracy.

Largest gap, Python loops over the neighbours, and `scipy.optimize.curve_fit`: once for the line,
from several starts for a corner, which may point anywhere. Written from its description.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import curve_fit

from lumitip import Layout

Floats = NDArray[np.float64]


@dataclass
class Published:
    """Result of the published processing for one frame."""

    threshold: float
    centre: tuple[float, float]
    markers: list[tuple[float, float]]
    line: Floats
    """Slope and height of the line."""
    corner: Floats
    """Vertex, and the directions of both rays (rad)."""


def published(values: list[int], layout: Layout, starts: int) -> Published:
    """One frame.

    Args:
        values: one per cell, 255 is full light.
        layout: where the cells are.
        starts: how many starts the fit of the corner gets.
    """
    level = _threshold(values)
    x_mm, y_mm = layout.x_mm.tolist(), layout.y_mm.tolist()
    dark = [i for i, value in enumerate(values) if value < level]
    weights = [255 - values[i] for i in dark]
    centre = (
        sum(w * x_mm[i] for w, i in zip(weights, dark, strict=True)) / sum(weights),
        sum(w * y_mm[i] for w, i in zip(weights, dark, strict=True)) / sum(weights),
    )
    markers = []
    for a, b in layout.neighbours.tolist():
        if (values[a] < level) != (values[b] < level):
            share = (level - values[a]) / (values[b] - values[a])
            markers.append(
                (x_mm[a] + share * (x_mm[b] - x_mm[a]), y_mm[a] + share * (y_mm[b] - y_mm[a]))
            )
    x, y = np.array(markers).T
    line, _ = curve_fit(_line, x, y)
    return Published(level, centre, markers, line, _corner(np.array((x, y)), starts))


def _threshold(values: list[int]) -> float:
    ordered = sorted(values)
    gap, cut = 0, 0
    for i in range(len(ordered) - 1):
        if ordered[i + 1] - ordered[i] > gap:
            gap, cut = ordered[i + 1] - ordered[i], i
    low, high = ordered[: cut + 1], ordered[cut + 1 :]
    return (sum(low) / len(low) + sum(high) / len(high)) / 2


def _line(x: Floats, slope: float, height: float) -> Floats:
    return slope * x + height


def _to_rays(markers: Floats, x: float, y: float, one: float, other: float) -> Floats:
    """Distance of each marker to the nearer of two rays from a vertex."""
    across, along = markers[0] - x, markers[1] - y
    distances = []
    for angle in (one, other):
        ahead = np.maximum(across * np.cos(angle) + along * np.sin(angle), 0.0)
        distances.append(np.hypot(across - ahead * np.cos(angle), along - ahead * np.sin(angle)))
    return np.minimum(*distances)


def _corner(markers: Floats, starts: int) -> Floats:
    """The best of several fits, which begin at the mean with rays a right angle apart."""
    best, least = np.full(4, np.nan), np.inf
    mean, aim = markers.mean(axis=1), np.zeros(markers.shape[1])
    for middle in np.linspace(0.0, 2.0 * np.pi, starts, endpoint=False):
        begin = (*mean, middle - np.pi / 4.0, middle + np.pi / 4.0)
        try:
            found, _ = curve_fit(_to_rays, markers, aim, p0=begin)
        except RuntimeError:
            continue
        left = float((_to_rays(markers, *found) ** 2).sum())
        if left < least:
            best, least = found, left
    return best
