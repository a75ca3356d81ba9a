"""An estimate as the page shows it: numbers with their error, and what to draw on the grid.

All errors are those that the fit states, times `NORMAL_95`: ± of a number, and the half width of a
band at each place along its line. An area about a point is the ellipse of 95 %.
"""

import math
from typing import Any

import numpy as np

from lumitip.estimation import Estimate
from lumitip.grid import Floats
from lumitip.layout import Layout

NORMAL_95 = 1.96
"""Standard deviations within which 95 % of a normal distribution lies."""
ELLIPSE_95 = 2.448
"""The same in two dimensions: the root of the 95 % quantile of chi² with two degrees."""
WORDS = {
    "misfit": "misfit: no edge, cable or corner explains these cells; the error may be larger",
    "weak": "weak: the cells hardly show this line",
    "astray": "astray: the fit left the fingertip",
    "unfinished": "unfinished: the fit did not converge",
    "bright": "bright: more light than at the tare; tare again with nothing between the fingers",
    "ambiguous": "ambiguous: another line explains the cells nearly as well",
    "dead": "dead: found without cells {left_out}, which have no value or may be dead",
}
"""Flags of `Estimate` for the reader of the page."""
_PLACES = 9  # along a line, of its band
_AROUND = 25  # points of an ellipse
_KEPT_DEG = 120.0  # a line keeps the direction of the frames before up to this angle
_FAR = 1e4  # no number on the page is larger

Polygon = list[list[float]]


def described(
    estimate: Estimate, reach_mm: float, before_deg: float | None = None
) -> dict[str, Any]:
    """The estimate for JSON; numbers in mm, degrees and counts of 255, `None` if not known.

    Args:
        estimate: of a frame.
        reach_mm: length of the lines to each side (mm).
        before_deg: angle shown for the frame before. A line has two directions; the page keeps
            the one of before, so that the numbers do not jump at ± 90°.
    """
    offset_mm, angle_deg = steady(estimate.offset_mm, estimate.angle_deg, before_deg)
    lines, bands = _drawn(estimate, reach_mm)
    left_out = ", ".join(map(str, estimate.left_out))
    return {
        "kind": estimate.kind,
        "flags": list(estimate.flags),
        "words": [WORDS[flag].format(left_out=left_out) for flag in estimate.flags],
        "offset_mm": _number(offset_mm),
        "angle_deg": _number(angle_deg),
        "width_mm": _number(estimate.width_mm),
        "vertex_mm": [_number(at) for at in estimate.vertex_mm] if estimate.vertex_mm else None,
        "opening_deg": _number(estimate.opening_deg),
        "rms_counts": _number(estimate.rms_counts),
        "error": {
            name: _number(NORMAL_95 * _deviation(estimate, name))
            for name in ("offset_mm", "angle_deg", "width_mm", "opening_deg")
        },
        "lines": [_rounded(line) for line in lines],
        "bands": [_rounded(band) for band in bands],
    }


def steady(offset_mm: float, angle_deg: float, before_deg: float | None) -> tuple[float, float]:
    """The same line, in the direction that is nearer to the one of before."""
    turned_deg = angle_deg - math.copysign(180.0, angle_deg)
    if (
        before_deg is not None
        and abs(turned_deg) < _KEPT_DEG
        and abs(turned_deg - before_deg) < abs(angle_deg - before_deg)
    ):
        return -offset_mm, turned_deg
    return offset_mm, angle_deg


def _deviation(estimate: Estimate, name: str) -> float:
    if name not in estimate.parameters:
        return math.nan
    at = estimate.parameters.index(name)
    return math.sqrt(max(float(estimate.covariance[at, at]), 0.0))


def _drawn(estimate: Estimate, reach_mm: float) -> tuple[list[Floats], list[Floats]]:
    """Borders of the object, for a cable its axis last; and their areas of uncertainty."""
    to_and_fro = np.linspace(-reach_mm, reach_mm, _PLACES)
    offset_mm, angle_deg = estimate.offset_mm, estimate.angle_deg
    if estimate.kind == "edge":
        return _border(estimate, to_and_fro, angle_deg, _foot(angle_deg, offset_mm))
    if estimate.kind == "cable":
        lines, bands = list[Floats](), list[Floats]()
        for side in (0.5, -0.5):
            foot = _foot(angle_deg, offset_mm + side * estimate.width_mm)
            line, band = _border(estimate, to_and_fro, angle_deg, foot, side)
            lines, bands = lines + line, bands + band
        axis, _ = _border(estimate, to_and_fro, angle_deg, _foot(angle_deg, offset_mm))
        return lines + axis, bands
    if estimate.kind == "corner" and estimate.vertex_mm:
        lines, bands = [], [_ellipse(estimate)]
        for side in (0.5, -0.5):
            turn_deg = estimate.direction_deg + side * estimate.opening_deg
            ahead = np.linspace(0.0, 2.0 * reach_mm, _PLACES)
            line, band = _border(estimate, ahead, turn_deg, np.array(estimate.vertex_mm), side)
            lines, bands = lines + line, bands + band
        return lines, bands
    return [], []


def _foot(angle_deg: float, offset_mm: float) -> Floats:
    """The point of a line nearest the origin (mm)."""
    return offset_mm * _normal(angle_deg)


def _normal(angle_deg: float) -> Floats:
    angle = math.radians(angle_deg)
    return np.array((-math.sin(angle), math.cos(angle)))


def _border(
    estimate: Estimate, along_mm: Floats, angle_deg: float, start_mm: Floats, side: float = 0.0
) -> tuple[list[Floats], list[Floats]]:
    """A line through a point as its two ends, and its band.

    Args:
        estimate: has the covariance.
        along_mm: places on the line, from the point (mm).
        angle_deg: of the line.
        start_mm: the point.
        side: share of the width, or of the opening, by which the line is beside the middle.
    """
    left = _normal(angle_deg)
    way = np.array((left[1], -left[0]))
    line = start_mm + along_mm[:, None] * way
    turn = np.radians(1.0) * along_mm
    slopes = {
        "edge": {"angle_deg": turn, "offset_mm": 1.0},
        "cable": {"angle_deg": turn, "offset_mm": 1.0, "width_mm": side},
        "corner": {
            "direction_deg": turn,
            "opening_deg": side * turn,
            "x_mm": left[0],
            "y_mm": left[1],
        },
    }[estimate.kind]
    at = [estimate.parameters.index(name) for name in slopes]
    by_place = np.stack([np.broadcast_to(slope, along_mm.shape) for slope in slopes.values()], 1)
    spread = estimate.covariance[np.ix_(at, at)]
    variance = np.einsum("pi,ij,pj->p", by_place, spread, by_place)
    half = NORMAL_95 * np.sqrt(np.maximum(variance, 0.0))[:, None] * left
    return [line[[0, -1]]], [np.concatenate([line + half, (line - half)[::-1]])]


def _ellipse(estimate: Estimate) -> Floats:
    """The area about a corner's vertex (mm)."""
    at = [estimate.parameters.index(name) for name in ("x_mm", "y_mm")]
    size, axes = np.linalg.eigh(estimate.covariance[np.ix_(at, at)])
    turn = np.linspace(0.0, math.tau, _AROUND)
    circle = np.stack((np.cos(turn), np.sin(turn)))
    points = axes @ (np.sqrt(np.maximum(size, 0.0))[:, None] * circle)
    return np.asarray(np.array(estimate.vertex_mm) + ELLIPSE_95 * points.T)


def _number(value: float) -> float | None:
    return round(float(value), 3) if abs(value) < _FAR else None


def _rounded(points: Floats) -> Polygon:
    kept: Polygon = np.clip(np.round(points, 3), -_FAR, _FAR).tolist()
    return kept


def reach_of(layout: Layout) -> float:
    """Length with which a line crosses all cells to each side of its middle (mm)."""
    return 1.5 * math.hypot(np.ptp(layout.x_mm), np.ptp(layout.y_mm)) + layout.pitch_mm
