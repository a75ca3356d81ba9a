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


Slopes = tuple[Floats, ...]


class Shape(Protocol):
    """A kind of object."""

    names: tuple[str, ...]
    """Entries of a pose before drifts, `light` and `taken`; angles in rad."""
    kind: str

    def shares(self, poses: Floats, drift: Floats = _EXPECTED) -> Floats:
        """Shares of light taken at many poses `(n, entries)` with a drift of the optics
        `(drifts,)`, shape `(n, cells)`."""

    def slopes(self, pose: Floats) -> tuple[Floats, Slopes]:
        """Share at poses `(..., p)`, shape `(..., cells)`, and its derivatives by each entry but
        `light` and `taken`, each of that shape."""

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

    def slopes(self, pose: Floats) -> tuple[Floats, Slopes]:
        left, ahead = self._cells.about(pose[..., 0], pose[..., 1])
        share, by_left, by_angle, by_drift = self._table(pose[..., :1], left, pose[..., 2:-2])
        return share, (by_angle - by_left * ahead, -by_left, *by_drift)

    def priors(self) -> tuple[Floats, Floats]:
        return np.array([0.0, 0.0]), np.array([np.inf, np.inf])


class Cable:
    """A round cable; pose (angle, offset_mm, width_mm, drifts, light, taken).

    It takes what a strip of sheet as wide as it takes, which follows the width, and what a round
    cable of the expected diameter takes beyond such a strip (`between_borders`).
    """

    kind = "cable"
    names: tuple[str, ...] = ("angle_deg", "offset_mm", "width_mm")

    def __init__(self, cells: Cells, table: Lookup, diameter_mm: float) -> None:
        """A cable.

        Args:
            cells: their places.
            table: a sheet of what a cable takes between its borders, and one of an edge.
            diameter_mm: expected (mm).
        """
        self._cells, self._table, self._diameter_mm = cells, table, diameter_mm

    def shares(self, poses: Floats, drift: Floats = _EXPECTED) -> Floats:
        """See `Shape`; for poses with the expected diameter."""
        left = self._cells.beside(poses[:, 0], poses[:, 1])
        width_mm = np.full((len(poses), 1), self._diameter_mm)
        return self._beside(width_mm, drift, poses[:, :1], left)[0]

    def slopes(self, pose: Floats) -> tuple[Floats, Slopes]:
        left, ahead = self._cells.about(pose[..., 0], pose[..., 1])
        drift = pose[..., len(self.names) : -2]
        share, by_left, by_angle, by_width, by_drift = self._beside(
            pose[..., 2:3], drift, pose[..., :1], left
        )
        return share, (by_angle - by_left * ahead, -by_left, by_width, *by_drift)

    def _beside(
        self, width_mm: Floats, drift: Floats, angle: Floats, left: Floats
    ) -> tuple[Floats, Floats, Floats, Floats, Floats]:
        """Share of cells beside an axis, and its derivatives by distance from the axis, direction
        of the axis, width and each drift.

        Args:
            width_mm: of each cable, shape `(..., 1)`.
            drift: of the optics, shape `(..., drifts)`.
            angle: of the axis beside each cell, shape `(..., 1)` or `(..., cells)`.
            left: distance of each cell, shape `(..., cells)` (mm).
        """
        places = left[..., None, :] - _SIDES * (width_mm[..., None] / 2.0)
        found = self._table(angle[..., None, :], places, drift[..., None, :], _SHEETS)
        share, by_left, by_angle, by_drift = (
            each[..., 0, :] + each[..., 1, :] - each[..., 2, :] for each in found
        )
        by_width = -0.5 * (found[1][..., 1, :] + found[1][..., 2, :])
        return share, by_left, by_angle, by_width, by_drift

    def priors(self) -> tuple[Floats, Floats]:
        """See `Shape`: the diameter within a tenth."""
        return np.array([0.0, 0.0, self._diameter_mm]), np.array(
            [np.inf, np.inf, self._diameter_mm / 10.0]
        )


_SIDES = np.array([0.0, 1.0, -1.0])[:, None]  # axis, left border and right border
_SHEETS = np.array([0, 1, 1])[:, None]


class Bent(Cable):
    """A round cable along an arc; pose (angle, offset_mm, width_mm, curvature_per_mm, drifts,
    light, taken): the direction at its point nearest the origin; one over its radius, positive for
    a bend to the left.

    As an approximation it is straight beside each cell.
    """

    names: tuple[str, ...] = (*Cable.names, "curvature_per_mm")

    def slopes(self, pose: Floats) -> tuple[Floats, Slopes]:
        bend = pose[..., 3:4]
        left, ahead = self._cells.about(pose[..., 0], pose[..., 1])
        # From the centre of the circle, in radii: across the line, along it, and the distance.
        across, along = 1.0 - bend * left, bend * ahead
        square = left * left + ahead * ahead
        away = np.maximum(np.hypot(across, along), _NEAR)
        # In this form the distance from the circle stays exact for large radii.
        twice = 2.0 * left - bend * square
        drift = pose[..., len(self.names) : -2]
        direction = pose[..., :1] + np.arctan2(along, across)
        share, by_left, by_angle, by_width, by_drift = self._beside(
            pose[..., 2:3], drift, direction, twice / (1.0 + away)
        )
        by_square = by_angle / (away * away)
        left_by_bend = -(square + twice * (bend * square - left) / (away * (1.0 + away))) / (
            1.0 + away
        )
        sideways = by_left * across / away + by_square * bend * along
        forward = by_square * bend * across - by_left * along / away
        turning = by_angle - sideways * ahead + forward * (left + pose[..., 1:2])
        bending = by_left * left_by_bend + by_square * ahead
        return share, (turning, -sideways, by_width, bending, *by_drift)

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
        angles, offsets = self.borders(poses)
        found = self._table.shares(angles[..., None], self._cells.beside(angles, offsets), drift)
        share: Floats = found[:, 0] * found[:, 1]
        return share

    def slopes(self, pose: Floats) -> tuple[Floats, Slopes]:
        angles, offsets = self.borders(pose)
        left = self._cells.beside(angles, offsets)
        drift = pose[..., None, 4:-2]
        shares, by_left, by_angle, by_drift = self._table(angles[..., None], left, drift)
        one, two = shares[..., 1, :], shares[..., 0, :]
        cos, sin = np.cos(angles)[..., None], np.sin(angles)[..., None]
        turning = by_angle - by_left * (
            (self._cells.x_mm - pose[..., None, 1:2]) * cos
            + (self._cells.y_mm - pose[..., None, 2:3]) * sin
        )
        first, second = one * by_left[..., 0, :], two * by_left[..., 1, :]
        by_first, by_second = one * turning[..., 0, :], two * turning[..., 1, :]
        return two * one, (
            by_first + by_second,
            first * sin[..., 0, :] + second * sin[..., 1, :],
            -first * cos[..., 0, :] - second * cos[..., 1, :],
            0.5 * (by_first - by_second),
            *(one * by_drift[..., 0, :] + two * by_drift[..., 1, :]),
        )

    def borders(self, pose: Floats) -> tuple[Floats, Floats]:
        """Directions (rad) and offsets (mm) of both borders of corners `(..., entries)`, the sheet
        to the right of each, shape `(..., 2)`."""
        angle, x_mm, y_mm, opening = (pose[..., entry] for entry in range(4))
        angles = np.stack([angle + opening / 2.0, angle - opening / 2.0 + _HALF_TURN], axis=-1)
        return angles, y_mm[..., None] * np.cos(angles) - x_mm[..., None] * np.sin(angles)

    def priors(self) -> tuple[Floats, Floats]:
        """See `Shape`: corners of sheets open by about 90 degrees."""
        return (
            np.array([0.0, 0.0, 0.0, np.pi / 2.0]),
            np.array([np.inf, np.inf, np.inf, np.radians(12.0)]),
        )
