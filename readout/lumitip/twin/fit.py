"""Fit of the twin to a real frame of a cloth edge, with nine numbers.

Offset, angle and curvature of the edge; clear transmittance of the cloth; gap; scattered share
alpha; gain; slopes of the light across the fingertip in x and y. The frame is not calibrated, so
differences between single cells remain in the residual.
"""

from dataclasses import dataclass

import numpy as np

from lumitip import arguments
from lumitip.grid import Floats, collinear
from lumitip.layout import Layout
from lumitip.twin.optics import Model, TwinError, values_of_drive
from lumitip.twin.scene import HalfPlane
from lumitip.twin.twin import Twin

NAMES = (
    "offset_mm",
    "angle_deg",
    "curvature_per_mm",
    "clear",
    "gap_mm",
    "alpha",
    "gain",
    "slope_x",
    "slope_y",
)
# Limits and differentiation steps; steps of gap and alpha need new tables.
_LEAST = np.array([-30.0, -360.0, -0.05, 0.0, 1.0, 0.0, 0.3, -0.5, -0.5])
_MOST = np.array([30.0, 360.0, 0.05, 0.5, 8.0, 1.0, 1.5, 0.5, 0.5])
_STEPS = np.array([0.02, 0.2, 1e-4, 1e-3, 0.05, 0.05, 1e-3, 1e-3, 1e-3])


@dataclass(frozen=True, eq=False)
class Fitted:
    """The twin that comes closest to a frame."""

    numbers: dict[str, float]
    """The fitted numbers by `NAMES`: lengths in mm, slopes as rise of the light over half of the
    fingertip."""
    values: Floats
    """Values of that twin before calibration, 0 to 255, shape `(cells,)`."""
    rms: float
    """Root mean square of the residual (counts of 255)."""


def read(layout: Layout, numbers: Floats) -> Floats:
    """Values before calibration of a twin with these numbers, in the order of `NAMES`."""
    offset, angle, curvature, clear, gap, alpha, gain, slope_x, slope_y = map(float, numbers)
    twin = Twin(layout, Model.from_layout(layout, gap, alpha=alpha, gain=gain))
    light = twin.light(HalfPlane(offset, angle, curvature, clear=clear))
    slope = 1.0 + slope_x * _of_half(layout.x_mm) + slope_y * _of_half(layout.y_mm)
    return values_of_drive(light * twin.drive * slope, twin.model)


def _of_half(places_mm: Floats) -> Floats:
    """Places relative to half of the fingertip; 0 if it has no extent."""
    return places_mm / (np.abs(places_mm).max() or 1.0)


def fit_edge(layout: Layout, values: Floats, offset_mm: float, angle_deg: float) -> Fitted:
    """Fit an edge to a frame with the Levenberg–Marquardt method.

    It finds the nearest minimum: start within about two degrees.

    Args:
        layout: the cells.
        values: of a real frame, before calibration, 255 is full light, shape `(cells,)`.
        offset_mm: of the edge, about: signed distance from the origin along its left normal, with
            the cloth to the right (mm).
        angle_deg: of the edge, about.

    Raises:
        LayoutError: if `layout` is no layout.
        TwinError: if the values or the start are invalid, or all cells lie on one line.
    """
    values = arguments.numbers(values, "values", TwinError)
    if values.shape != (len(arguments.layout(layout)),) or not np.isfinite(values).all():
        raise TwinError(f"values has shape {values.shape}; {len(layout)} finite numbers are needed")
    if collinear(layout.x_mm, layout.y_mm):
        raise TwinError("layout has all cells in one line; they do not show an edge's direction")
    offset_mm = arguments.number(offset_mm, "offset_mm", error=TwinError)
    angle_deg = arguments.number(angle_deg, "angle_deg", error=TwinError)
    place = np.array([offset_mm, angle_deg, 0.0, 0.05, 2.5, 0.6, 0.9, 0.0, 0.0])
    error = read(layout, place) - values
    damping, small_steps = 1.0, 0
    while small_steps < 3 and damping < 1e6:
        slopes = np.stack(
            [(read(layout, place + s) - values - error) / s.sum() for s in np.diag(_STEPS)], axis=1
        )
        normal = slopes.T @ slopes
        while damping < 1e6:
            try:
                step = np.linalg.solve(
                    normal + damping * np.diag(np.diag(normal)), -slopes.T @ error
                )
            except np.linalg.LinAlgError:
                raise TwinError(
                    f"offset_mm is {offset_mm:g} and angle_deg is {angle_deg:g}; no cell sees an "
                    "edge there. Start within about two degrees of it."
                ) from None
            tried = np.clip(place + step, _LEAST, _MOST - _STEPS)
            new = read(layout, tried) - values
            if new @ new < error @ error:
                break
            damping *= 4.0
        else:
            break
        small_steps = small_steps + 1 if error @ error - new @ new < 1e-3 * (error @ error) else 0
        place, error, damping = tried, new, damping / 6.0
    numbers = dict(zip(NAMES, place.tolist(), strict=True))
    return Fitted(numbers, error + values, float(np.sqrt(np.mean(error**2))))
