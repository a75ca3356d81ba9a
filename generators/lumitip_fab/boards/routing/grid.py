"""The grid that tracks run on: whole multiples of its pitch in the finger's sensor frame."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.design import Box, Point

Reals = NDArray[np.float64]


@dataclass(frozen=True)
class Grid:
    """Nodes `(y, x)` over a board, on each of its two layers."""

    pitch_mm: float
    first_x: int
    """x of the first column of nodes, in pitches."""
    first_y: int
    width: int
    height: int

    @classmethod
    def over(cls, box: Box, pitch_mm: float) -> "Grid":
        """The grid that covers a board."""
        x, y = (math.ceil(v / pitch_mm - 1e-9) for v in (box.x_min_mm, box.y_min_mm))
        last_x, last_y = (math.floor(v / pitch_mm + 1e-9) for v in (box.x_max_mm, box.y_max_mm))
        return cls(pitch_mm, x, y, last_x - x + 1, last_y - y + 1)

    @property
    def plane(self) -> int:
        """Nodes of a layer."""
        return self.width * self.height

    def at(self, node: int) -> Point:
        """Where a node is (mm), rounded to whole micrometres."""
        y, x = divmod(node % self.plane, self.width)
        return (
            round((self.first_x + x) * self.pitch_mm, 3),
            round((self.first_y + y) * self.pitch_mm, 3),
        )

    def near(self, x_mm: float, y_mm: float, reach_mm: float) -> tuple[slice, slice]:
        """Rows and columns of the nodes within a square round a place."""
        rows, columns = (
            slice(
                max(math.floor((at - reach_mm) / self.pitch_mm) - first, 0),
                max(min(math.ceil((at + reach_mm) / self.pitch_mm) - first + 1, count), 0),
            )
            for at, first, count in (
                (y_mm, self.first_y, self.height),
                (x_mm, self.first_x, self.width),
            )
        )
        return rows, columns

    def offsets(self, where: tuple[slice, slice], x_mm: float, y_mm: float) -> tuple[Reals, Reals]:
        """x and y (mm) of nodes from a place: arrays `(1, columns)` and `(rows, 1)`."""
        rows, columns = where
        x = (np.arange(columns.start, columns.stop) + self.first_x) * self.pitch_mm - x_mm
        y = (np.arange(rows.start, rows.stop) + self.first_y) * self.pitch_mm - y_mm
        return x[None, :], y[:, None]
