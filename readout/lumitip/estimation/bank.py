"""`Bank`: what the cells read at some 7,000 poses, compared with a frame in one product."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip.estimation.shapes import Cells, Shape
from lumitip.grid import Floats

POSES = 7000
"""Poses of a bank, about: steps of 2 degrees and of half a millimetre on the published
grid, alike at the far cells."""
_APART_DEG, _APART_MM = 3.0, 0.7
_LEAST = 0.02  # of a cell's light, spread over all cells: templates below it show nothing


@dataclass(frozen=True, eq=False)
class Bank:
    """Templates without their mean and of unit length."""

    poses: Floats
    """Shape `(n, entries)`, without `light` and `taken`."""
    templates: NDArray[np.float32]
    """Shape `(n, cells)`."""
    apart: Floats
    """One over how far poses must be apart to be told as different ones, of each entry."""
    signed: bool
    """Whether the negative of a template is the same line with the other side covered."""

    @classmethod
    def of(cls, shape: Shape, poses: Floats, weights: Floats) -> "Bank":
        """The bank of a shape at poses.

        Args:
            shape: what takes the light.
            poses: shape `(n, entries)`.
            weights: of each cell, 0 for cells that do not count, shape `(cells,)`.
        """
        shares = shape.shares(poses)
        centred = shares - (shares @ weights)[:, None] / weights.sum()
        sizes = np.sqrt(centred**2 @ weights)
        shown = sizes > _LEAST * np.sqrt(weights.sum())
        templates = centred[shown] / sizes[shown, None]
        names = shape.names[: poses.shape[1]]
        apart = np.array([1.0 / np.radians(_APART_DEG) if n.endswith("_deg") else 1.0 / _APART_MM
                          for n in names])  # fmt: skip
        signed = shape.kind == "edge"
        return cls(poses[shown], templates.astype(np.float32), apart, signed)

    def best(self, light: Floats, weights: Floats, starts: int = 1) -> tuple[Floats, float]:
        """The poses whose templates are most like a frame, the best first, shape `(k, entries)`,
        and the share of the frame's variance that the best leaves.

        Args:
            light: shares of the empty grasp, shape `(cells,)`.
            weights: as for `of`.
            starts: how many poses, no two of them neighbours.
        """
        centred = weights * (light - light @ weights / weights.sum())
        likeness = self.templates @ centred.astype(np.float32)
        score = np.abs(likeness) if self.signed else -likeness
        size = float(centred @ centred) or 1.0
        left = 1.0 - float(score.max()) ** 2 / size
        found = []
        for _ in range(starts):
            at = int(score.argmax())
            pose = self.poses[at].copy()
            if self.signed and likeness[at] > 0.0:
                pose[0] += np.pi
                pose[1] *= -1.0
            found.append(pose)
            if len(found) < starts:
                score[np.abs(self.poses - self.poses[at]) @ self.apart < 1.0] = -np.inf
        return np.array(found), left


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
