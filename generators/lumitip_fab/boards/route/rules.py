"""The grid that tracks run on, and the widths and clearances of the net classes on it."""

import dataclasses
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.boards.model import NetClass, Placement
from lumitip_fab.design import Box, Point

MARGIN_MM = 0.002  # kept beyond every rule by what is off the grid, so that rounding breaks none
PAD_TO_VIA_MM = 0.1  # solder mask between a pad and a via of its own net
HOLE_TO_HOLE_MM = 0.25  # wall between two drills
COARSEST_MM = 0.2  # grid on which tracks still end near the middle of a pad of 0.4 mm


@dataclass(frozen=True)
class Rules:
    """The net classes in a fixed order, and which is which net's."""

    classes: tuple[NetClass, ...]
    of_net: dict[str, int]
    """Class of each net."""
    narrow: int
    """The class of the thinnest tracks, with the greatest clearance: what wide tracks become
    beside narrow pads."""

    @classmethod
    def of(cls, placement: Placement) -> "Rules":
        """The rules of a board."""
        classes = placement.classes
        thin = dataclasses.replace(
            classes[0],
            name="narrow",
            track_mm=min(c.track_mm for c in classes),
            clearance_mm=max(c.clearance_mm for c in classes),
            via_mm=max(c.via_mm for c in classes),
            via_drill_mm=max(c.via_drill_mm for c in classes),
        )
        like_thin = [
            i for i, c in enumerate(classes) if dataclasses.replace(thin, name=c.name) == c
        ]
        names = {c.name: i for i, c in enumerate(classes)}
        return cls(
            classes=classes if like_thin else (*classes, thin),
            of_net={n.name: names[n.net_class] for n in placement.nets},
            narrow=like_thin[0] if like_thin else len(classes),
        )

    def clearance_mm(self, a: int, b: int) -> float:
        """Between the copper of two classes: the greater of theirs."""
        return max(self.classes[a].clearance_mm, self.classes[b].clearance_mm)

    @property
    def pitch_mm(self) -> float:
        """Pitch of the routing grid: half a thin track with its clearance.

        Neighbouring tracks then pack without a gap, and a board has no more nodes than it needs.
        """
        thin = min(c.track_mm + c.clearance_mm for c in self.classes)
        return min(_whole_um(thin / 2), COARSEST_MM)

    @property
    def fine_mm(self) -> float:
        """Pitch of the grid that also finds ways between pads with little room to spare."""
        return _whole_um(self.pitch_mm / 2)

    @property
    def drill_mm(self) -> float:
        """Drill of the widest via."""
        return max(c.via_drill_mm for c in self.classes)

    def radii(self, pitch_mm: float, via: bool) -> NDArray[np.float64]:
        """Squared distances, in steps, that copper keeps from the middle of other copper.

        Args:
            pitch_mm: of the grid.
            via: whether the copper is a via, not a track.

        Returns:
            `(own class, other class, kind, 2)`: kind 0 for the other's tracks and 1 for its vias;
            beside the copper and round its ends.
        """
        count = len(self.classes)
        radii = np.empty((count, count, 2, 2))
        for a, own in enumerate(self.classes):
            for b, other in enumerate(self.classes):
                for kind, width in enumerate((other.track_mm, other.via_mm)):
                    size = round_via_mm(own) if via else own.track_mm
                    reach = (size + width) / 2 + self.clearance_mm(a, b)
                    square = (reach / pitch_mm) ** 2
                    radii[a, b, kind] = square, _round_end(square)
        return radii


def round_via_mm(kind: NetClass) -> float:
    """Diameter of the copper round a via of a net class: its own, or the end of a wider track."""
    return max(kind.via_mm, kind.track_mm)


def _whole_um(length_mm: float) -> float:
    """Rounded up, so that every node is at whole micrometres."""
    return math.ceil(round(1000 * length_mm, 6)) / 1000


def _round_end(square: float) -> float:
    """Squared radius round a node that also keeps diagonal steps outside.

    A diagonal step past a node at an odd number k of half diagonals comes nearer in its middle,
    k²/2, than at its ends, (k² + 1)/2.
    """
    k = math.isqrt(math.ceil(2 * square - 1e-9) - 1)
    k -= 1 - k % 2
    return (k * k + 1) / 2 + 1e-3 if k * k + 1 >= 2 * square - 1e-9 else square


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
