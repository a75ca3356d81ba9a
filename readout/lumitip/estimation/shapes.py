"""Shares of light of the cells for each kind of object, with their derivatives by the pose.

A pose is a vector that ends with `light` (beside the object, 1 is the empty grasp) and `taken` (of
that, by the object): a cell receives `light − taken · share`. Before these two a pose may have
drifts of the optics (`Lookup`). An edge covers the right of its line. A corner is the product of
its two edges, which is exact if a cell's light is spread equally in both directions, and else an
approximation.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from lumitip.estimation.lookup import Lookup
from lumitip.grid import Floats

_HALF_TURN = np.pi
_EXPECTED = np.empty(0)
_BEND_SD_PER_MM = 0.02
_NEAR = 0.05  # radii from the centre of a bend; closer cells have no side


@dataclass(frozen=True, eq=False)
class Cells:
    """Places of the cells (mm), shape `(cells,)`."""

    x_mm: Floats
    y_mm: Floats

    def beside(self, angle: Floats, offset_mm: Floats) -> Floats:
        """Distance of the cells to the left of lines, shape `(..., cells)` (mm)."""
        return self.about(angle, offset_mm)[0]

    def about(self, angle: Floats, offset_mm: Floats) -> tuple[Floats, Floats]:
        """Distance of the cells to the left of lines, and along them from the point nearest the
        origin, each of shape `(..., cells)` (mm)."""
        angle, offset_mm = np.asarray(angle)[..., None], np.asarray(offset_mm)[..., None]
        cos, sin = np.cos(angle), np.sin(angle)
        left = self.y_mm * cos - self.x_mm * sin - offset_mm
        return left, self.x_mm * cos + self.y_mm * sin


class Shape(Protocol):
    """A kind of object."""

    names: tuple[str, ...]
    """Entries of a pose before drifts, `light` and `taken`; angles in rad."""
    kind: str

    def shares(self, poses: Floats, drift: Floats = _EXPECTED) -> Floats:
        """Shares of light taken at many poses `(n, entries)` with a drift of the optics
        `(drifts,)`, shape `(n, cells)`."""

    def slopes(self, pose: Floats) -> tuple[Floats, Floats]:
        """Share at one pose, shape `(cells,)`, and its derivatives by all but `light` and
        `taken`, shape `(entries, cells)`."""

    def priors(self) -> tuple[Floats, Floats]:
        """Prior of each of `names`: means and standard deviations."""


class Edge:
    """A half-plane; pose (angle, offset_mm, drifts, light, taken)."""

    kind = "edge"
    names: tuple[str, ...] = ("angle_deg", "offset_mm")

    def __init__(self, cells: Cells, table: Lookup) -> None:
        self._cells, self._table = cells, table

    def shares(self, poses: Floats, drift: Floats = _EXPECTED) -> Floats:
        left = self._cells.beside(poses[:, 0], poses[:, 1])
        return self._table.shares(poses[:, :1], left, drift)

    def slopes(self, pose: Floats) -> tuple[Floats, Floats]:
        angle = pose[0]
        left, ahead = self._cells.about(angle, pose[1])
        share, by_left, by_angle, by_drift = self._table(pose[:1], left, pose[2:-2])
        turning = by_angle - by_left * ahead
        return share, np.array([turning, -by_left, *by_drift])

    def priors(self) -> tuple[Floats, Floats]:
        return np.array([0.0, 0.0]), np.array([np.inf, np.inf])


class Cable:
    """A round cable; pose (angle, offset_mm, width_mm, drifts, light, taken).

    Its table is for the expected diameter; other widths add or remove strips at the two borders.
    """

    kind = "cable"
    names: tuple[str, ...] = ("angle_deg", "offset_mm", "width_mm")

    def __init__(self, cells: Cells, table: Lookup, edge: Lookup, diameter_mm: float) -> None:
        self._cells, self._table, self._edge = cells, table, edge
        self._diameter_mm = diameter_mm
        self._sides = np.array([1.0, -1.0, 1.0, -1.0])[:, None]
        self._signs = np.array([1.0, -1.0, -1.0, 1.0])[:, None]

    def shares(self, poses: Floats, drift: Floats = _EXPECTED) -> Floats:
        """See `Shape`; only for poses with the expected diameter."""
        left = self._cells.beside(poses[:, 0], poses[:, 1])
        return self._table.shares(poses[:, :1], left, drift)

    def slopes(self, pose: Floats) -> tuple[Floats, Floats]:
        left, ahead = self._cells.about(pose[0], pose[1])
        share, by_left, by_angle, by_width, by_drift = self._beside(pose, pose[:1], left)
        turning = by_angle - by_left * ahead
        return share, np.array([turning, -by_left, by_width, *by_drift])

    def _beside(
        self, pose: Floats, angle: Floats, left: Floats
    ) -> tuple[Floats, Floats, Floats, Floats, Floats]:
        """Share of cells beside an axis, and its derivatives by distance from the axis, direction
        of the axis, width and each drift."""
        drift = pose[len(self.names) : -2]
        share, by_left, by_angle, by_drift = self._table(angle, left, drift)
        half = np.array([pose[2], pose[2], self._diameter_mm, self._diameter_mm])[:, None] / 2.0
        strips = self._edge(angle, left - self._sides * half, drift)
        more, more_by_left, more_by_angle, more_by_drift = (
            np.add.reduce(self._signs * s, axis=-2) for s in strips
        )
        by_width = -0.5 * (strips[1][0] + strips[1][1])
        return (
            share + more,
            by_left + more_by_left,
            by_angle + more_by_angle,
            by_width,
            by_drift + more_by_drift,
        )

    def priors(self) -> tuple[Floats, Floats]:
        """See `Shape`: the diameter within a tenth."""
        return np.array([0.0, 0.0, self._diameter_mm]), np.array(
            [np.inf, np.inf, self._diameter_mm / 10.0]
        )


class Bent(Cable):
    """A round cable along an arc; pose (angle, offset_mm, width_mm, curvature_per_mm, drifts,
    light, taken): the direction at its point nearest the origin; one over its radius, positive for
    a bend to the left.

    As an approximation it is straight beside each cell.
    """

    names: tuple[str, ...] = (*Cable.names, "curvature_per_mm")

    def slopes(self, pose: Floats) -> tuple[Floats, Floats]:
        bend = pose[3]
        left, ahead = self._cells.about(pose[0], pose[1])
        # From the centre of the circle, in radii: across the line, along it, and the distance.
        across, along = 1.0 - bend * left, bend * ahead
        square = left * left + ahead * ahead
        away = np.maximum(np.hypot(across, along), _NEAR)
        # In this form the distance from the circle stays exact for large radii.
        twice = 2.0 * left - bend * square
        beside = twice / (1.0 + away)
        share, by_left, by_angle, by_width, by_drift = self._beside(
            pose, pose[0] + np.arctan2(along, across), beside
        )
        by_square = by_angle / (away * away)
        left_by_bend = -(square + twice * (bend * square - left) / (away * (1.0 + away))) / (
            1.0 + away
        )
        sideways = by_left * across / away + by_square * bend * along
        forward = by_square * bend * across - by_left * along / away
        turning = by_angle - sideways * ahead + forward * (left + pose[1])
        bending = by_left * left_by_bend + by_square * ahead
        return share, np.array([turning, -sideways, by_width, bending, *by_drift])

    def priors(self) -> tuple[Floats, Floats]:
        """See `Shape`: traced cables bend with a radius of 50 mm or more."""
        means, deviations = super().priors()
        return np.append(means, 0.0), np.append(deviations, _BEND_SD_PER_MM)


class Corner:
    """A corner of a sheet; pose (angle, x_mm, y_mm, opening, drifts, light, taken), the angle from
    the vertex into the sheet."""

    kind = "corner"
    names: tuple[str, ...] = ("angle_deg", "x_mm", "y_mm", "opening_deg")

    def __init__(self, cells: Cells, table: Lookup) -> None:
        self._cells, self._table = cells, table

    def shares(self, poses: Floats, drift: Floats = _EXPECTED) -> Floats:
        angles, offsets = self.borders(poses.T)
        one, two = (
            self._table.shares(a[:, None], self._cells.beside(a, o), drift)
            for a, o in zip(angles, offsets, strict=True)
        )
        return one * two

    def slopes(self, pose: Floats) -> tuple[Floats, Floats]:
        angles, offsets = self.borders(pose)
        left = self._cells.beside(angles, offsets)
        shares, by_left, by_angle, by_drift = self._table(angles[:, None], left, pose[4:-2])
        share = shares[0] * shares[1]
        cos, sin = np.cos(angles)[:, None], np.sin(angles)[:, None]
        turning = by_angle - by_left * (
            (self._cells.x_mm - pose[1]) * cos + (self._cells.y_mm - pose[2]) * sin
        )
        one, two = shares[1], shares[0]
        first, second = one * by_left[0], two * by_left[1]
        by_first, by_second = one * turning[0], two * turning[1]
        return share, np.array(
            [
                by_first + by_second,
                first * sin[0] + second * sin[1],
                -first * cos[0] - second * cos[1],
                0.5 * (by_first - by_second),
                *(one * by_drift[:, 0] + two * by_drift[:, 1]),
            ]
        )

    def borders(self, pose: Floats) -> tuple[Floats, Floats]:
        """Directions (rad) and offsets (mm) of both borders, the sheet to the right of each,
        shape `(2, ...)`."""
        angle, x_mm, y_mm, opening = pose[0], pose[1], pose[2], pose[3]
        angles = np.stack([angle + opening / 2.0, angle - opening / 2.0 + _HALF_TURN])
        return angles, y_mm * np.cos(angles) - x_mm * np.sin(angles)

    def priors(self) -> tuple[Floats, Floats]:
        """See `Shape`: corners of sheets open by about 90 degrees."""
        return (
            np.array([0.0, 0.0, 0.0, np.pi / 2.0]),
            np.array([np.inf, np.inf, np.inf, np.radians(12.0)]),
        )
