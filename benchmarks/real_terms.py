"""The twin with additional terms, as values of the three published frames.

Numbers of a frame belong to its object and grasp: pose, transmittance, gap, and the light beside
the object. Shared numbers belong to the sensor, so all frames have the same.
"""

import numpy as np

from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Cable, HalfPlane, Model
from lumitip.twin.optics import FULL, values_of_drive
from lumitip.twin.scene import covered
from real_light import DIAMETER_MM, Parts, RealLight

Numbers = dict[str, float]

PLAIN: dict[str, Numbers] = {
    "cloth_edge": {
        "offset_mm": 0.07,
        "angle_deg": 182.4,
        "clear": 0.05,
        "gap_mm": 3.0,
        "light": 0.88,
    },
    "cloth_corner": {
        "x_mm": -5.4,
        "y_mm": -6.2,
        "angle_deg": 44.7,
        "clear": 0.07,
        "gap_mm": 3.0,
        "light": 0.9,
    },
    "cable": {"offset_mm": -0.87, "angle_deg": 29.7, "gap_mm": 3.0, "light": 0.97},
}
"""Numbers of each frame where its fit starts: a plain cloth, a corner of 90°, a straight cable."""
MADE: dict[str, Numbers] = {
    "cloth_corner": {"hem_mm": 6.0, "other_hem_mm": 12.0, "hem_clear": 0.3},
    "cable": {"bend": 0.3, "bend_growth": 0.0},
}
"""More numbers of the objects: hems along both borders of the corner; a cable that bends, and
bends differently at its two ends."""
TERMS: dict[str, Numbers] = {
    "scattered share": {"alpha": 0.6},
    "crosstalk of neighbouring LEDs": {"crosstalk": 1.3},
    "blur between neighbouring cells": {"blur": 0.05},
    "constant floor of scattered light": {"floor": 0.05},
    "saturation": {"gain": 0.95},
    "exponent of the response": {"exponent": 1.0},
    "ambient light": {"ambient": 0.02},
    "slope of the light": {"slope_x": 0.0, "slope_y": 0.0},
    "gap of the calibration": {"calibration_gap_mm": 4.0},
    "blur and floor": {"blur": 0.05, "floor": 0.05},
    "crosstalk and saturation": {"crosstalk": 1.3, "gain": 0.95},
    "crosstalk, saturation and scattered share": {"crosstalk": 1.3, "gain": 0.95, "alpha": 0.6},
}
"""Candidates: shared numbers, where their fit starts."""
LIMITS = {
    "gap_mm": (2.0, 6.0),
    "calibration_gap_mm": (2.0, 6.0),
    "clear": (0.0, 0.6),
    "hem_clear": (0.0, 1.0),
    "hem_mm": (0.5, 25.0),
    "other_hem_mm": (0.5, 25.0),
    "light": (0.5, 1.5),
    "alpha": (0.0, 1.0),
    "crosstalk": (0.0, 8.0),
    "blur": (0.0, 0.6),
    "floor": (0.0, 0.5),
    "gain": (0.2, 3.0),
    "exponent": (0.5, 2.0),
    "ambient": (0.0, 0.3),
}
BEND_PER_MM, BEND_GROWTH_PER_MM2 = (
    0.01,
    1e-4,
)  # units of `bend` and `bend_growth`, so that all are of order 1


class RealTwin:
    """The twin of the published sensor with additional terms."""

    def __init__(self, layout: Layout, light: RealLight | None = None) -> None:
        self.layout = layout
        self._light = light or RealLight(layout)
        self._model = Model.from_layout(layout)
        distance = np.hypot(*(a[:, None] - a for a in (layout.x_mm, layout.y_mm)))
        beside = (distance > 0.0) & (distance < 1.1 * layout.pitch_mm)
        self._beside = beside / beside.sum(axis=1, keepdims=True)
        self._slope_x = layout.x_mm / np.abs(layout.x_mm).max()
        self._slope_y = layout.y_mm / np.abs(layout.y_mm).max()

    def light(self, name: str, own: Numbers, shared: Numbers) -> tuple[Floats, Floats]:
        """Share of the light of an empty grasp that each cell receives, and its drive there."""
        alpha, crosstalk = shared.get("alpha", self._model.alpha), shared.get("crosstalk", 1.0)
        full = self._light.full(own["gap_mm"], alpha).together(crosstalk)
        light = 1.0 - self._taken(name, own, alpha).together(crosstalk) / full
        blur, floor = shared.get("blur", 0.0), shared.get("floor", 0.0)
        light = (1.0 - blur) * light + blur * (self._beside @ light)
        light = (1.0 - floor) * light + floor * light.mean()
        light = np.maximum(light, 1e-9) ** shared.get("exponent", 1.0) * own["light"]
        tilted = (
            shared.get("slope_x", 0.0) * self._slope_x + shared.get("slope_y", 0.0) * self._slope_y
        )
        light = light * (1.0 + tilted)
        if "calibration_gap_mm" in shared:
            empty = self._light.full(shared["calibration_gap_mm"], alpha).together(crosstalk)
            light, full = light * (full / full.mean()) / (empty / empty.mean()), empty
        return light, shared.get("gain", self._model.gain) * full / full.max()

    def values(self, light: Floats, drive: Floats, shared: Numbers) -> Floats:
        """Values of shares of light, calibrated with the empty grasp and clipped at 255."""
        ambient = shared.get("ambient", 0.0) * shared.get("gain", self._model.gain)
        read = values_of_drive(light * drive + ambient, self._model)
        clipped: Floats = np.minimum(read * (FULL / values_of_drive(drive, self._model)), FULL)
        return clipped

    def _taken(self, name: str, own: Numbers, alpha: float) -> Parts:
        """Light that the object of a frame takes."""
        at = self._light
        if name == "cable":
            return at.cable(*self._beside_cable(own), own["gap_mm"], alpha)
        if name == "cloth_edge":
            cloth = HalfPlane(own["offset_mm"], own["angle_deg"])
            coverage = np.asarray(cloth.coverage(at.x_mm, at.y_mm, at.pixel_mm), np.float64)
            through = 1.0 - (1.0 - own["clear"]) * coverage
        else:
            through = self._through_corner(own)
        return at.covered(1.0 - through, own["gap_mm"], alpha)

    def _beside_cable(self, own: Numbers) -> tuple[Floats, Floats]:
        """Direction of the cable beside each cell (degrees), and the cell's distance (mm)."""
        axis = Cable(own["offset_mm"], own["angle_deg"], diameter_mm=DIAMETER_MM)
        left_mm, _ = axis.left_of(self.layout.x_mm, self.layout.y_mm)
        turn = np.radians(own["angle_deg"])
        along_mm = self.layout.x_mm * np.cos(turn) + self.layout.y_mm * np.sin(turn)
        bend = BEND_PER_MM * own.get("bend", 0.0)
        bend_growth = BEND_GROWTH_PER_MM2 * own.get("bend_growth", 0.0)
        away_mm = bend * along_mm**2 / 2.0 + bend_growth * along_mm**3
        steeper = np.arctan(bend * along_mm + 3.0 * bend_growth * along_mm**2)
        return own["angle_deg"] + np.degrees(steeper), left_mm - away_mm

    def _through_corner(self, own: Numbers) -> Floats:
        """Light that passes a corner of 90° with a hem along each border."""
        at = self._light
        first, second = np.radians(own["angle_deg"] + 45.0), np.radians(own["angle_deg"] - 45.0)
        x, y = at.x_mm - own["x_mm"], at.y_mm - own["y_mm"]
        one = y * np.cos(first) - x * np.sin(first)
        two = x * np.sin(second) - y * np.cos(second)
        cloth = covered(np.maximum(one, two), at.pixel_mm)
        through = 1.0 - (1.0 - own["clear"]) * cloth
        if "hem_mm" in own:
            for away, wide in ((one, own["other_hem_mm"]), (two, own["hem_mm"])):
                hem = cloth * (1.0 - covered(away + wide, at.pixel_mm))
                through = through * (1.0 - (1.0 - own["hem_clear"]) * hem)
        return np.asarray(through, np.float64)
