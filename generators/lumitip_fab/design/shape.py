"""Layers and outlines of a finger: what its parts are cut from.

Every length is in mm and in the sensor frame of the finger it belongs to, unless it says
otherwise.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Point = tuple[float, float]
Side = Literal["front", "back"]
Cubic = tuple[Point, Point, Point, Point]
GUIDED = 0.75  # of a plate without a pocket, in the mould


@dataclass(frozen=True)
class Box:
    """An upright rectangle."""

    x_min_mm: float
    x_max_mm: float
    y_min_mm: float
    y_max_mm: float

    @property
    def width_mm(self) -> float:
        """Extent along x."""
        return self.x_max_mm - self.x_min_mm

    @property
    def length_mm(self) -> float:
        """Extent along y."""
        return self.y_max_mm - self.y_min_mm

    @property
    def bounds_mm(self) -> tuple[float, float, float, float]:
        """Left, low, right and high side."""
        return self.x_min_mm, self.y_min_mm, self.x_max_mm, self.y_max_mm

    @property
    def centre_mm(self) -> Point:
        """Its middle."""
        return (self.x_min_mm + self.x_max_mm) / 2, (self.y_min_mm + self.y_max_mm) / 2

    def grown(self, by_mm: float) -> "Box":
        """The rectangle with every side moved out."""
        return Box(
            self.x_min_mm - by_mm,
            self.x_max_mm + by_mm,
            self.y_min_mm - by_mm,
            self.y_max_mm + by_mm,
        )

    def mirrored(self) -> "Box":
        """The rectangle with x negated."""
        return Box(-self.x_max_mm, -self.x_min_mm, self.y_min_mm, self.y_max_mm)


@dataclass(frozen=True)
class Stack:
    """Layers of a finger, and the heights of the planes between them.

    z = 0      ────────────── skin: outer face of the film
    silicone_z ────────────── inner face of the film
    rim_z      ────────────── front of the board
    pocket_z   ────────────── back of the board
    back_z     ────────────── back of the plate

    The plate's front, face_z, is rim_z where the board lies in a pocket, else pocket_z.
    """

    floor_mm: float
    pcb_mm: float
    silicone_mm: float
    film_mm: float
    sunk: bool
    """Whether the board lies in a pocket of the plate, not on its front."""
    auxiliary_mm: float
    """Thickness of the boards outside the fingers."""

    @property
    def plate_mm(self) -> float:
        """Thickness of the printed plate."""
        return self.floor_mm + self.pcb_mm if self.sunk else self.floor_mm

    @property
    def thickness_mm(self) -> float:
        """Thickness of the whole finger without its coupling."""
        return self.floor_mm + self.pcb_mm + self.silicone_mm + self.film_mm

    @property
    def silicone_z_mm(self) -> float:
        """Inner face of the film."""
        return -self.film_mm

    @property
    def rim_z_mm(self) -> float:
        """Front of the board."""
        return -(self.film_mm + self.silicone_mm)

    @property
    def face_z_mm(self) -> float:
        """Front of the plate, on which the mould's stops press."""
        return self.rim_z_mm if self.sunk else self.pocket_z_mm

    @property
    def cover_mm(self) -> float:
        """Thickness of the silicone over the plate, beside the board."""
        return self.silicone_z_mm - self.face_z_mm

    @property
    def guided_mm(self) -> float:
        """How far the mould's wall reaches along the plate's side, at least."""
        return self.pcb_mm if self.sunk else GUIDED * self.floor_mm

    @property
    def pocket_z_mm(self) -> float:
        """Back of the board: the pocket's floor, or the plate's front."""
        return self.rim_z_mm - self.pcb_mm

    @property
    def back_z_mm(self) -> float:
        """Back of the plate."""
        return self.pocket_z_mm - self.floor_mm


@dataclass(frozen=True)
class Outline:
    """The silhouette of the gripping face: closed, counter-clockwise, mirror-symmetric in x.

    Starts at the left end of the straight gripper end. A straight piece is a cubic whose inner
    control points lie on its chord at the thirds.
    """

    curve: tuple[Cubic, ...]
    tip_y_mm: float
    end_y_mm: float
    tip_width_mm: float
    end_width_mm: float

    @property
    def length_mm(self) -> float:
        """From tip edge to gripper end."""
        return self.tip_y_mm - self.end_y_mm

    def polygon(self, steps: int = 64) -> NDArray[np.float64]:
        """Corners of the outline, shape `(n, 2)`, without repeating the first.

        Args:
            steps: chords for each curved piece; straight pieces need one.
        """
        return _corners(self.curve, steps)

    def half_width_at(self, y_mm: float) -> float:
        """Half the outline's width at a height y."""
        corners = self.polygon()
        right = corners[corners[:, 0] >= 0]
        order = np.argsort(right[:, 1], kind="stable")
        return float(np.interp(y_mm, right[order, 1], right[order, 0]))


@lru_cache(maxsize=64)  # asked for at every height of an outline
def _corners(curve: tuple[Cubic, ...], steps: int) -> NDArray[np.float64]:
    """Corners of an outline, read-only."""
    corners = []
    for piece in curve:
        p = np.array(piece)
        straight = np.allclose(p[1], p[0] + (p[3] - p[0]) / 3, atol=1e-9)
        t = np.linspace(0.0, 1.0, (1 if straight else steps) + 1)[:-1, None]
        b = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3)
        corners.append(sum(w * q for w, q in zip(b, p, strict=True)))
    whole = np.concatenate(corners)
    whole.flags.writeable = False
    return whole


@dataclass(frozen=True)
class Tip:
    """The wedge on the back of the plate: from full thickness at `slant_start_y_mm` to
    `edge_mm` at the tip edge."""

    slant_start_y_mm: float
    edge_mm: float
    angle_deg: float
    slots: tuple[Box, ...] = ()
    """Where the edge is set back, left and right of the mould's stop: silicone fills them, and
    wraps the skin round the tip; none where it ends at the edge."""

    @property
    def slot_mm(self) -> float:
        """How far the edge is set back; 0 without slots."""
        return max((slot.length_mm for slot in self.slots), default=0.0)

    @property
    def slope(self) -> float:
        """Height that the back gains for each length towards the tip edge."""
        return math.tan(math.radians(self.angle_deg))

    def back_z_mm(self, stack: Stack, y_mm: float) -> float:
        """Height of the plate's back at a y."""
        return stack.back_z_mm + max(y_mm - self.slant_start_y_mm, 0.0) * self.slope


@dataclass(frozen=True)
class Key:
    """A countersunk hole through the plate beside the board. Silicone fills it, and the skin is
    locked to the plate; the countersink of 90° is in the back."""

    at: Point
    hole_mm: float
    sink_mm: float
    """Depth of the countersink on the hole's axis."""

    @property
    def wide_mm(self) -> float:
        """Its diameter in the back of a plate without a wedge."""
        return self.hole_mm + 2 * self.sink_mm
