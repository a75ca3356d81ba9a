"""`Bank`: values of the cells at some 7,000 poses, compared with a frame in one product."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip.estimation.fit import Fit
from lumitip.estimation.shapes import Cells, Shape
from lumitip.grid import Floats

POSES = 7000
"""Approximate number of poses: steps of 2 degrees and half a millimetre on the published grid,
which have the same effect at the far cells."""
_APART_DEG, _APART_MM = 3.0, 0.7
_FEW = 400
"""Poses of the greatest scores, which usually hold enough that are no neighbours."""
_LIT, _DARK = 0.8, (0.1, 0.25)
"""Shares of cells below the light beside an object, and below that under it."""
_OFF = 0.35  # share of light by which a cell disagrees with a pose
_ELSEWHERE = 1.4  # distance beyond which a pose is at another place
_TINY = 1e-6
_AT_ONCE = 1 << 16  # shares that are looked up together, which takes a few MB for each 10,000
_LEAST = 0.02  # root mean square share of light below which a template is left out


@dataclass(frozen=True, eq=False)
class Bank:
    """Values of the cells at many poses."""

    poses: Floats
    """Shape `(n, entries)`, without `light` and `taken`."""
    shares: NDArray[np.float32]
    """Share of the light that each pose takes, shape `(n, cells)`."""
    squares: NDArray[np.float32]
    """Of the shares."""
    templates: NDArray[np.float32]
    """The shares without their mean, normalised to unit length."""
    apart: Floats
    """Inverse of the distance at which two poses count as different, of each entry."""
    opaque: bool
    """Whether the object takes all of the light."""
    signed: bool
    """Whether a negative template means the same line with the other side covered."""

    @classmethod
    def of(cls, shape: Shape, poses: Floats, weights: Floats) -> "Bank":
        """The bank of a shape at poses.

        Args:
            shape: the object.
            poses: shape `(n, entries)`.
            weights: of each cell, 0 for cells to ignore, shape `(cells,)`.
        """
        few = max(_AT_ONCE // weights.size, 1)
        parts = [shape.shares(poses[i : i + few]) for i in range(0, len(poses), few)]
        shares = np.concatenate(parts)
        centred = shares - (shares @ weights)[:, None] / weights.sum()
        sizes = np.sqrt(centred**2 @ weights)
        shown = sizes > _LEAST * np.sqrt(weights.sum())
        templates = centred[shown] / sizes[shown, None]
        names = shape.names[: poses.shape[1]]
        apart = np.array(
            [1.0 / np.radians(_APART_DEG) if n.endswith("_deg") else 1.0 / _APART_MM for n in names]
        )
        opaque, signed = shape.kind == "cable", shape.kind == "edge"
        shares, templates = shares[shown].astype(np.float32), templates.astype(np.float32)
        return cls(poses[shown], shares, shares**2, templates, apart, opaque, signed)

    def best(self, light: Floats, weights: Floats) -> tuple[Floats, float]:
        """The pose whose template is most similar to a frame, shape `(entries,)`, and the share of
        the frame's variance that it leaves.

        Args:
            light: shares of the empty grasp, shape `(cells,)`.
            weights: as for `of`.
        """
        centred = weights * (light - light @ weights / weights.sum())
        likeness = self.templates @ centred.astype(np.float32)
        score = np.abs(likeness) if self.signed else -likeness
        size = float(centred @ centred) or 1.0
        at = int(score.argmax())
        return self._pose(at, likeness[at] > 0.0), 1.0 - float(score[at]) ** 2 / size

    def closest(self, light: Floats, scale: Floats, starts: int) -> Floats:
        """The poses of least residual, the best first, without neighbours, shape
        `(starts, entries)`.

        Unlike `best` it weights each cell by its deviation: three products instead of one.

        Args:
            light: shares of the empty grasp, shape `(cells,)`.
            scale: one over the standard deviation of each, shape `(cells,)`.
            starts: number of poses.
        """
        weights = scale**2
        whole, mean = float(weights.sum()), float(weights @ light)
        by_cell = weights.astype(np.float32)
        taken, squares = self.shares @ by_cell, self.squares @ by_cell
        both = self.shares @ (weights * light).astype(np.float32)
        if self.opaque:  # only the light beside the object is free
            turned = np.zeros(taken.size, bool)
            score = (mean - both) ** 2 / np.maximum(whole - 2.0 * taken + squares, _TINY * whole)
        else:
            likeness = both - taken * (mean / whole)
            turned = likeness > 0.0
            score = likeness**2 / np.maximum(squares - taken**2 / whole, _TINY * whole)
            if not self.signed:
                score[turned] = 0.0
        found = self._apart(score, starts, min(_FEW, score.size))
        if len(found) < starts:
            found = self._apart(score, starts, score.size)
        return np.array([self._pose(at, turned[at]) for at in found])

    def robust(self, light: Floats, usable: NDArray[np.bool_], starts: int, most: int) -> Floats:
        """Poses that all but a few cells agree with, whatever these read; the best first, without
        neighbours, shape `(n, entries)`.

        A cell that disagrees counts the same however far it is off. A sheet's own light is tried at
        two levels, for dead cells may be darker than it.

        Args:
            light: shares of the empty grasp, shape `(cells,)`.
            usable: cells that count, shape `(cells,)`.
            starts: number of poses, at most.
            most: number of cells that may disagree. Poses with which all agree are left out.
        """
        seen, shares = light[usable].astype(np.float32), self.shares[:, usable]
        top = np.float32(np.quantile(seen, _LIT))
        levels = np.zeros(1) if self.opaque else np.quantile(seen, _DARK)
        lows = levels.astype(np.float32)
        best, off = np.full(len(shares), np.inf, np.float32), np.zeros(len(shares), int)
        turned = np.zeros(len(shares), bool)
        for low in lows:
            for side in (False, True) if self.signed else (False,):
                miss = np.abs(seen - top + (top - low) * (1.0 - shares if side else shares))
                loss = np.minimum(miss, _OFF).sum(axis=1)
                better = loss < best
                best[better], turned[better] = loss[better], side
                off[better] = np.count_nonzero(miss[better] > _OFF, axis=1)
        found = self._apart(-best, starts, min(_FEW, best.size))
        return np.array([self._pose(at, turned[at]) for at in found if 0 < off[at] <= most])

    def distance(self, one: Floats, two: Floats) -> float:
        """How far two poses are apart, in distances at which they count as different."""
        entries = self.apart.size
        away = one[:entries] - two[:entries]
        turn = np.pi if self.opaque else 2.0 * np.pi  # a reversed edge covers the other side
        turns = np.round(away[0] / turn)
        away[0] -= turns * turn
        if self.opaque and turns % 2.0:
            away[1] = one[1] + two[1]  # the same line reversed
        return float(np.abs(away) @ self.apart)

    def elsewhere(self, first: Fit, others: Sequence[Fit]) -> list[Fit]:
        """Those of some fits that are at another place than the first."""
        return [f for f in others if self.distance(f.pose, first.pose) > _ELSEWHERE]

    def _apart(self, score: NDArray[np.floating], starts: int, among: int) -> list[int]:
        """Places of the greatest scores, the first the greatest, without neighbours.

        Args:
            score: of each pose.
            starts: number of places, at most.
            among: number of poses to search, those of the greatest scores.
        """
        best = np.argpartition(score, -among)[-among:] if among < score.size else None
        places = np.arange(score.size) if best is None else np.sort(best)
        scores, scaled = score[places].copy(), self.poses[places] * self.apart
        found: list[int] = []
        for _ in range(min(starts, places.size)):
            at = int(scores.argmax())
            if scores[at] == -np.inf:
                break
            found.append(int(places[at]))
            scores[np.abs(scaled - scaled[at]).sum(axis=1) < 1.0] = -np.inf
        return found

    def _pose(self, at: int, turned: bool) -> Floats:
        pose: Floats = self.poses[at].copy()
        if self.signed and turned:
            pose[0] += np.pi
            pose[1] *= -1.0
        return pose


def lines(cells: Cells, beyond_mm: float = 1.0) -> Floats:
    """Poses (angle, offset) of lines over all cells, shape `(n, 2)`; half a turn of angles."""
    reach_mm = float(np.hypot(cells.x_mm, cells.y_mm).max()) + beyond_mm
    angles = np.radians(np.arange(-90.0, 90.0, 2.0))
    offsets = np.linspace(-reach_mm, reach_mm, POSES // angles.size)
    return np.stack(np.meshgrid(angles, offsets), axis=-1).reshape(-1, 2)


def corners(cells: Cells) -> Floats:
    """Poses (angle, x, y, opening) of corners over all cells, shape `(n, 4)`."""
    angles = np.radians(np.arange(-180.0, 180.0, 15.0))
    openings = np.radians([65.0, 90.0, 115.0])
    x, y = cells.x_mm, cells.y_mm
    step_mm = np.sqrt(np.ptp(x) * np.ptp(y) * angles.size * openings.size / POSES) or 1.0
    columns = np.arange(x.min(), x.max() + step_mm / 2.0, step_mm)
    rows = np.arange(y.min(), y.max() + step_mm / 2.0, step_mm)
    return np.stack(np.meshgrid(angles, columns, rows, openings), axis=-1).reshape(-1, 4)
