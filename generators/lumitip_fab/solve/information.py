"""Expected errors of poses by Fisher information, with optics and gains unknown.

A frame tells the pose, but also depends on gap, scattered share, exponent of the detectors and
hole, which nobody knows exactly of a built finger, and on the gains of its cells. The pose's
covariance is computed with all of these unknown within their deviations, so a design that tells
them apart is better than one whose light changes most. Derivatives are finite differences of the
twin's tables. A cable is taken as a flat opaque strip of its diameter: then one table of edges
serves all diameters.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import qmc

from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Model, Twin
from lumitip.twin.noise import dimness

COUNTS = float(np.hypot(1.5, np.sqrt(1.0 / 12.0)))
"""Standard deviation of a value: noise, and the rounding to whole counts (counts of 255)."""
GAIN_SD = 0.06
"""Spread of the cells' gains after the empty grasp."""
OPTICS_SD = {"gap_mm": 0.29, "alpha": 0.115, "detector_exponent": 0.35, "hole_mm": 0.029}
"""Standard deviations of the optics; of the hole relative to it. They are those of the uniform
deviations that `lumitip-fab explore` draws."""
_STEPS = {"gap_mm": 0.1, "alpha": 0.05, "detector_exponent": 0.15, "hole_mm": 0.02}
_LIGHT_SD, _CLEAR_SD = 0.1, 0.3
_WIDTH_SD = 0.1  # of a cable's diameter, relative to it
POSE_SD = (1.0, 5.0)
"""Of a line that no cell sees: offset (mm) and angle (degrees); no expected error is larger."""
_STEP_MM, _STEP_DEG, _STEP_LIGHT = 0.05, 0.3, 0.01
_REACH = 0.35  # of the grid's smaller extent: how far from its middle lines lie


@dataclass(frozen=True)
class Grasps:
    """Grasps that a design is judged by: the same directions and relative offsets for all."""

    gaps_mm: tuple[float, ...]
    cables_mm: tuple[float, ...]
    """Diameters; of a cable thicker than a gap there is no grasp at it."""
    poses: int = 96
    """Of edges, and of each cable, at each gap."""


USUAL = Grasps(gaps_mm=(2.0, 4.0, 6.0), cables_mm=(2.0, 4.0, 6.0))
"""Grasps of the errors that page and gallery show, those of `examples/goals.toml`."""


@dataclass(frozen=True, eq=False)
class Expected:
    """Standard deviations of offset (mm) and angle (degrees), shape `(n, 2)`."""

    edges: Floats
    cables: Floats
    directions_deg: Floats
    """Of the lines; the rows of `edges` and `cables` are in this order, over and over."""

    def rms(self) -> dict[str, float]:
        """Rms values by figure, those of `edge_mm`, `edge_deg`, `cable_mm` and `cable_deg`."""
        return {
            f"{kind}_{unit}": float(np.sqrt(np.mean(rows[:, column] ** 2)))
            for kind, rows in (("edge", self.edges), ("cable", self.cables))
            for column, unit in enumerate(("mm", "deg"))
            if rows.size
        }


def expected(layout: Layout, grasps: Grasps, gain: float = Model.gain) -> Expected:
    """Expected errors of a layout over grasps.

    Args:
        layout: the cells, with their optics.
        grasps: gaps and objects.
        gain: photocurrent of the brightest cell, see `Model`.
    """
    offsets_mm, angles_deg = lines(layout, grasps.poses)
    edges, cables = [], []
    for gap_mm in grasps.gaps_mm:
        model = Model.from_layout(layout, gap_mm, gain=gain)
        at = _Gap.of(layout, model, offsets_mm, angles_deg)
        edges.append(at.edges())
        cables += [at.cables(width) for width in grasps.cables_mm if width <= gap_mm]
    return Expected(_stacked(edges), _stacked(cables), angles_deg)


def lines(layout: Layout, count: int) -> tuple[Floats, Floats]:
    """Offsets (mm) and angles (degrees) of lines, evenly spread over the middle of a grid."""
    even = qmc.Halton(2, scramble=False).random(count + 1)[1:]
    reach_mm = _REACH * min(float(np.ptp(layout.x_mm)), float(np.ptp(layout.y_mm)))
    return reach_mm * (2.0 * even[:, 1] - 1.0), 180.0 * even[:, 0] - 90.0


@dataclass(frozen=True, eq=False)
class _Gap:
    """Lines at one gap, with the twin of the drawing and those of changed optics."""

    twin: Twin
    changed: tuple[tuple[Twin, float], ...]
    """Twins whose optics differ by some standard deviations."""
    offsets_mm: Floats
    angles_deg: Floats

    @classmethod
    def of(cls, layout: Layout, model: Model, offsets_mm: Floats, angles_deg: Floats) -> "_Gap":
        return cls(Twin(layout, model), tuple(_changed(layout, model)), offsets_mm, angles_deg)

    def edges(self) -> Floats:
        return self._deviations(None)

    def cables(self, width_mm: float) -> Floats:
        return self._deviations(width_mm)

    def _deviations(self, width_mm: float | None) -> Floats:
        """Standard deviations of offset and angle, shape `(poses, 2)`."""
        here = self._values(width_mm)
        light = 1.0 - self._taken(self.twin, width_mm)
        by_light = self._by_light(light)
        columns = [
            self._by_pose(width_mm, _STEP_MM, 0.0) * POSE_SD[0] / _STEP_MM,
            self._by_pose(width_mm, 0.0, _STEP_DEG) * POSE_SD[1] / _STEP_DEG,
            by_light * light * _LIGHT_SD,
            *((self._values(width_mm, twin) - here) / by for twin, by in self.changed),
        ]
        if width_mm is None:
            columns.append(by_light * (1.0 - light) * _CLEAR_SD)
        else:
            step_mm = _WIDTH_SD * width_mm
            wider, thinner = (self._values(width_mm + way * step_mm) for way in (0.5, -0.5))
            columns.append(wider - thinner)
        noise = np.hypot(COUNTS * dimness(self.twin), by_light * light * GAIN_SD)
        jacobian = np.stack(columns, axis=2) / noise[:, :, None]
        # Every column is scaled by its prior deviation, so the prior is the unit matrix.
        normal = jacobian.transpose(0, 2, 1) @ jacobian + np.eye(len(columns))
        variance = np.linalg.inv(normal)
        return np.sqrt(np.stack([variance[:, n, n] for n in (0, 1)], axis=1)) * POSE_SD

    def _by_pose(self, width_mm: float | None, step_mm: float, step_deg: float) -> Floats:
        """Half of the change of the values between two poses that differ by two steps."""
        there, back = (
            self._values(width_mm, moved=(way * step_mm, way * step_deg)) for way in (1.0, -1.0)
        )
        return (there - back) / 2.0

    def _by_light(self, light: Floats) -> Floats:
        return slope(self.twin, light)

    def _values(
        self,
        width_mm: float | None,
        twin: Twin | None = None,
        moved: tuple[float, float] = (0.0, 0.0),
    ) -> Floats:
        twin = twin or self.twin
        return twin.calibrated(1.0 - self._taken(twin, width_mm, moved))

    def _taken(
        self, twin: Twin, width_mm: float | None, moved: tuple[float, float] = (0.0, 0.0)
    ) -> Floats:
        """Share of light that the lines take from each cell, shape `(poses, cells)`."""

        def right_of(by_mm: float) -> Floats:
            offsets_mm = self.offsets_mm + moved[0] + by_mm
            bends = np.zeros_like(offsets_mm)
            angles_deg = self.angles_deg + moved[1]
            return twin.edge_table().of_lines(twin.layout, offsets_mm, angles_deg, bends)

        if width_mm is None:
            return right_of(0.0)
        return right_of(width_mm / 2.0) - right_of(-width_mm / 2.0)


def slope(twin: Twin, light: Floats) -> Floats:
    """Growth of the calibrated values with the share of light, of the shape of `light`.

    At its ends it is that inside: beyond them the values are clipped.
    """
    high = np.minimum(light + _STEP_LIGHT / 2.0, 1.0)
    low = np.maximum(light - _STEP_LIGHT / 2.0, 0.0)
    rise: Floats = (twin.calibrated(high) - twin.calibrated(low)) / (high - low)
    return rise


def _changed(layout: Layout, model: Model) -> Iterator[tuple[Twin, float]]:
    for name, sd in OPTICS_SD.items():
        value, step = getattr(model, name), _STEPS[name]
        scale = value if name == "hole_mm" else 1.0
        yield Twin(layout, model.changed(**{name: value + step * scale})), step / sd


def _stacked(rows: Sequence[Floats]) -> Floats:
    return np.concatenate(rows) if rows else np.empty((0, 2))
