"""Light of built fingers: the twin's rays, with every LED, hole and detector at its own place.

`Twin` moves the emitter as a whole, and gives all cells one depth and gap. Here each ray
begins at the place of its own LED or hole and ends at that of its own detector or hole, with the
twin's weights. Of the rays between two holes a fixed sample is taken. Borders of holes are as soft
as an LED's width makes them, so that the light changes steadily as a mask moves.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Model
from lumitip.twin.rays import REACH_MM, dies, hole_points, relative_light
from lumitip.twin.scene import PIXEL_MM

Singles = NDArray[np.float32]
_SIN60 = np.sqrt(3.0) / 2.0
_SOFT_MM = 0.2  # of the border of a hole, as light from a die of 0.3 mm passes it
_ACROSS = 3  # points across half of a hole
_SAMPLES = 4  # rays between two holes, for each point of a hole
_LEAST_GAP_MM = 0.3


@dataclass(frozen=True, eq=False)
class Lines:
    """Edges (opaque half-planes) or opaque cables at half the gap."""

    kind: str
    """`"edge"` or `"cable"`."""
    poses: Floats
    """Angle (rad) and offset (mm) of each line, shape `(n, 2)`."""
    diameter_mm: float = 3.0
    """Of the cables (mm)."""


@dataclass(frozen=True)
class Piece:
    """A flat opaque piece with straight borders, somewhere in the gap."""

    kind: str
    """`"edge"`: it covers everything right of its line; `"strip"`: it lies along it."""
    offset_mm: float
    angle_deg: float
    low_mm: float
    """Its faces above the receiver's skin."""
    high_mm: float
    width_mm: float = 0.0
    """Of a strip (mm)."""


@dataclass(frozen=True, eq=False)
class Built:
    """A built pair of fingers. Places: sensor frame of the receiver, shape `(2, cells)` (mm)."""

    led_mm: Floats
    emitter_hole_mm: Floats
    receiver_hole_mm: Floats
    detector_mm: Floats
    hole_mm: Floats
    """Sizes of the holes of emitter and receiver, shape `(2, cells)` (mm)."""
    led_depth_mm: Floats
    """Equivalent depth of each LED behind its hole, shape `(cells,)`."""
    detector_depth_mm: Floats
    led_gap_mm: Floats
    """The emitter's half of the gap at each cell, shape `(cells,)`."""
    detector_gap_mm: Floats
    """The receiver's half of it."""
    alpha: float
    """Share of scattered light."""
    led: Floats
    """Light of each LED; 1 is nominal, shape `(cells,)`."""
    detector: Floats
    """Sensitivity of each detector."""
    drift: Floats
    """Light of each cell in a grasp relative to its empty grasp."""
    exposure: float
    """Photocurrent of the brightest cell relative to `Model.gain`."""


class Rays:
    """The rays between all pairs of an LED and a detector within reach."""

    def __init__(self, layout: Layout, model: Model) -> None:
        """Choose pairs and rays.

        Args:
            layout: the cells.
            model: optics of the drawing.
        """
        dx, dy = layout.x_mm - layout.x_mm[:, None], layout.y_mm - layout.y_mm[:, None]
        self._cell, self._led = np.nonzero(np.hypot(dx, dy) <= REACH_MM)
        self._begin = np.searchsorted(self._cell, np.arange(len(layout) + 1))
        self._model = model
        # By LED and by cell: the light that its hole scatters, relative to the model's.
        self._scattered = [
            np.array([relative_light(model, share, *die) for share in layout.hole_share])
            for die in dies(model)
        ]
        points = np.stack(hole_points(model, _ACROSS)) / model.hole_mm
        count, chance = points.shape[1], np.random.default_rng(0)
        die = np.zeros((2, count))
        others = [points[:, chance.permutation(count)] for _ in range(_SAMPLES)]
        # By columns: die to die, die to hole, hole to die, hole to hole.
        self._source = np.hstack([die[:, :1], die, points, *[points] * _SAMPLES])
        self._target = np.hstack([die[:, :1], points, die, *others])
        sizes = (1, count, count, count * _SAMPLES)
        self._deep = np.repeat([[1, 1, 0, 0], [1, 0, 1, 0]], sizes, axis=1)
        self._count = np.repeat(sizes, sizes)

    @property
    def pairs(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Cell and LED of each pair within reach, sorted by cell."""
        return self._cell, self._led

    def of(self, built: Built) -> "Light":
        """The light of a built pair of fingers."""
        model, cell, led = self._model, self._cell, self._led
        begin_deep, end_deep = self._deep
        gap = (built.led_gap_mm[led] + built.detector_gap_mm[cell])[:, None]
        gap = np.maximum(gap, _LEAST_GAP_MM)
        above = begin_deep * built.led_depth_mm[led][:, None]
        below = end_deep * built.detector_depth_mm[cell][:, None]
        way = gap + above + below
        from_hole = built.emitter_hole_mm[:, led, None]
        to_hole = built.receiver_hole_mm[:, cell, None]
        from_mm, to_mm = built.hole_mm[0, led, None], built.hole_mm[1, cell, None]
        begin = np.where(begin_deep, built.led_mm[:, led, None], from_hole)
        begin = begin + self._source[:, None] * from_mm
        end = np.where(end_deep, built.detector_mm[:, cell, None], to_hole)
        end = end + self._target[:, None] * to_mm
        slope = (begin - end) / way
        low = end + slope * below  # at the receiver's mask
        high = begin - slope * above
        weight = self._inside(low - to_hole, to_mm, end_deep)
        weight *= self._inside(high - from_hole, from_mm, begin_deep)
        power = (model.led_exponent + model.detector_exponent + 2.0) / 2.0
        weight *= (1.0 + (slope**2).sum(axis=0)) ** -power / way**2
        deep = begin_deep + end_deep
        weight *= built.alpha ** (2 - deep) * (1.0 - built.alpha) ** deep / self._count
        weight *= np.where(begin_deep, 1.0, self._scattered[0][led, None])
        weight *= np.where(end_deep, 1.0, self._scattered[1][cell, None])
        weight *= built.led[led, None]
        middle = low + slope * (gap / 2.0)
        return Light(
            middle.reshape(2, -1).astype(np.float32),
            slope.reshape(2, -1).astype(np.float32),
            weight.ravel().astype(np.float32),
            self._begin * weight.shape[1],
            gap.ravel().astype(np.float32),
        )

    def _inside(self, place: Floats, hole_mm: Floats, deep: Floats) -> Floats:
        """Share of each ray that passes a hole, for rays of a die."""
        x, y = np.abs(place)
        if self._model.hole_shape == "circle":
            far = np.hypot(x, y)
        else:
            far = np.maximum(y, _SIN60 * x + 0.5 * y)
        return np.where(deep, np.clip(0.5 + (hole_mm / 2.0 - far) / _SOFT_MM, 0.0, 1.0), 1.0)


@dataclass(frozen=True, eq=False)
class Light:
    """All rays of a built pair of fingers, sorted by cell; arrays of shape `(rays,)`."""

    _middle_mm: Singles
    """Where they cross the middle of the gap, shape `(2, rays)`."""
    _slope: Singles
    _weight: Singles
    _begin: NDArray[np.intp]
    """First ray of each cell, and the end."""
    _gap_mm: Singles
    """Between the skins, of each pair of an LED and a cell, shape `(pairs,)`."""

    @cached_property
    def full(self) -> Floats:
        """Light of each cell in the empty grasp, shape `(cells,)`."""
        return np.add.reduceat(self._weight.astype(np.float64), self._begin[:-1])

    def shares(self, lines: Lines) -> Floats:
        """Share of it that passes lines, shape `(n, cells)`."""
        angle, offset = lines.poses.astype(np.float32).T
        across = np.stack([-np.sin(angle), np.cos(angle)])
        soft = np.float32(-1.0 / PIXEL_MM)
        left = self._middle_mm.T @ across - offset
        if lines.kind == "cable":
            np.abs(left, out=left)
            slant = self._slope.T @ across
            slant *= slant
            slant += np.float32(1.0)
            left -= np.float32(lines.diameter_mm / 2.0) * np.sqrt(slant, out=slant)
        left *= soft
        left += np.float32(0.5)
        np.clip(left, 0.0, 1.0, out=left)
        parts = zip(self._begin[:-1], self._begin[1:], strict=True)
        taken = np.stack([self._weight[a:b] @ left[a:b] for a, b in parts], axis=1)
        return 1.0 - taken / self.full

    def behind(self, piece: Piece) -> Floats:
        """Share of it that passes a piece, shape `(cells,)`."""
        lost = np.add.reduceat(self._taken(piece).astype(np.float64), self._begin[:-1])
        return np.asarray(1.0 - lost / self.full)

    def passed(self, piece: Piece | None) -> Floats:
        """Light of each pair of an LED and a cell that passes a piece, or nothing, shape
        `(pairs,)`."""
        weight = self._weight if piece is None else self._weight - self._taken(piece)
        return np.asarray(weight.reshape(self._gap_mm.size, -1).sum(axis=1, dtype=np.float64))

    def _taken(self, piece: Piece) -> Singles:
        """Light of each ray that a piece takes."""
        angle = np.radians(piece.angle_deg)
        across = np.array([-np.sin(angle), np.cos(angle)], np.float32)
        slope = across @ self._slope
        gap = np.repeat(self._gap_mm, slope.size // self._gap_mm.size)
        skin = across @ self._middle_mm - np.float32(piece.offset_mm) - slope * gap / 2
        # A ray is taken where it meets either face, or a side between them.
        low, high = (skin + slope * np.float32(z) for z in (piece.low_mm, piece.high_mm))
        if piece.kind == "edge":
            outside = np.minimum(low, high)
        else:
            beside = np.maximum(np.minimum(low, high), -np.maximum(low, high))
            outside = beside - np.float32(piece.width_mm / 2.0)
        inside = np.clip(0.5 - outside / np.float32(PIXEL_MM), 0.0, 1.0)
        return np.asarray(inside * self._weight, np.float32)


def turned(places_mm: Floats, angle_deg: float) -> Floats:
    """Places turned to the left round the origin, shape `(2, n)`."""
    cos, sin = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    return np.asarray(np.array([[cos, -sin], [sin, cos]]) @ places_mm)
