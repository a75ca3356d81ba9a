"""Which LEDs a cell sees: pairs of cells and LEDs, sorted into bundles of rays they share."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from lumitip import arguments
from lumitip.grid import Floats, Integers
from lumitip.layout import Layout
from lumitip.twin.optics import Model, TwinError
from lumitip.twin.rays import ACROSS, REACH_MM, Bundle, bundle

_MANY, _FEW_ACROSS = 60, 3  # with more bundles than these, each gets fewer rays
_DIM = 0.005  # so does one with less than this share of the brightest one's light
_KERNEL_MM = 0.1


@dataclass(frozen=True)
class Misregistration:
    """How the emitter stands to where it should be, in the receiver's sensor frame."""

    x_mm: float = 0.0
    y_mm: float = 0.0
    angle_deg: float = 0.0
    """Turned about z, through the origin."""
    tilt_deg: float = 0.0
    """Turned about x: the gap grows towards the tip. Holes stay parallel in the model, which
    leaves out a cosine: 0.4 % at 5 degrees."""

    def __post_init__(self) -> None:
        arguments.finite_fields(self, TwinError)


@dataclass(frozen=True)
class Emitter:
    """Where the emitter is and what it is made of."""

    model: Model
    astray: Misregistration = Misregistration()

    def gap_mm(self, y_mm: Floats) -> Floats:
        """The gap at places (mm).

        Raises:
            TwinError: if the fingers touch there.
        """
        tilt_deg = self.astray.tilt_deg
        gap: Floats = self.model.gap_mm + y_mm * np.tan(np.radians(tilt_deg))
        if gap.min() <= 0.0:
            raise TwinError(
                f"tilt_deg is {tilt_deg}; at a gap of {self.model.gap_mm} mm the fingers touch"
            )
        return gap

    def leds_mm(self, layout: Layout) -> tuple[Floats, Floats]:
        """Where the LEDs are: LED i faces cell i but for misregistration."""
        angle = np.radians(self.astray.angle_deg)
        cos, sin = float(np.cos(angle)), float(np.sin(angle))
        return (
            layout.x_mm * cos - layout.y_mm * sin + self.astray.x_mm,
            layout.x_mm * sin + layout.y_mm * cos + self.astray.y_mm,
        )


@dataclass(frozen=True, eq=False)
class Pairs:
    """All pairs of a cell and an LED within reach; arrays of shape `(pairs,)`."""

    cells: int
    cell: Integers
    kind: Integers
    """Which of `kinds` the pair is."""
    kinds: tuple[tuple[Model, float, float], ...]
    """Model (with the gap there) and displacement (mm) of each bundle."""

    @classmethod
    def of(cls, layout: Layout, emitter: Emitter) -> "Pairs":
        """The pairs of a layout and its emitter."""
        led_x, led_y = emitter.leds_mm(layout)
        model, tilted = emitter.model, emitter.astray.tilt_deg != 0.0
        dx, dy = led_x - layout.x_mm[:, None], led_y - layout.y_mm[:, None]
        cell, led = np.nonzero(np.hypot(dx, dy) <= REACH_MM)
        gap_mm = emitter.gap_mm((layout.y_mm[cell] + led_y[led]) / 2.0)
        keys = np.round(np.stack([gap_mm, dx[cell, led], dy[cell, led]], axis=1), 3) + 0.0
        keys[:, 0] = np.round(keys[:, 0], 2) if tilted else model.gap_mm
        # As one whole number each: rows as such sort slowly, and no other thread runs meanwhile.
        gap_um, x_um, y_um = np.rint(1e3 * keys.T).astype(np.int64)
        whole = (gap_um << 40) + (x_um << 20) + y_um
        _, first, kind = np.unique(whole, return_index=True, return_inverse=True)
        unique = keys[first].tolist()
        kinds = tuple((replace(model, gap_mm=g), x, y) for g, x, y in unique)
        return cls(len(layout), cell, kind, kinds)

    @cached_property
    def _across(self) -> tuple[int, ...]:
        # Points across half of a hole: few where there are many bundles, or they are dim.
        rough = np.array([self.bundle(k, _FEW_ACROSS).weight.sum() for k in range(len(self.kinds))])
        bright = (rough > _DIM * rough.max()) & (len(self.kinds) <= _MANY)
        return tuple(np.where(bright, ACROSS, _FEW_ACROSS).tolist())

    def bundle(self, kind: int, across: int | None = None) -> Bundle:
        """The rays of one kind."""
        return bundle(*self.kinds[kind], across or self._across[kind])

    @cached_property
    def light(self) -> Floats:
        """Light of each kind, shape `(kinds,)`."""
        return np.array([self.bundle(k).weight.sum() for k in range(len(self.kinds))])

    @cached_property
    def full(self) -> Floats:
        """Light of each cell with nothing in the gap, shape `(cells,)`."""
        return tally(self.cell, self.light[self.kind], self.cells)

    @cached_property
    def counts(self) -> Floats:
        """How often each cell has each kind, shape `(cells, kinds)`."""
        counted = np.zeros((self.cells, len(self.kinds)))
        np.add.at(counted, (self.cell, self.kind), 1.0)
        return counted

    def spots(self, kind: int, height: float) -> tuple[Floats, Floats, Floats]:
        """Where the rays of a kind cross a plane, gathered on a fine raster: x, y (mm), light."""
        rays = self.bundle(kind)
        x, y = rays.at(height * self.kinds[kind][0].gap_mm)
        column, row, share = spread(x / _KERNEL_MM, y / _KERNEL_MM)
        left, low = column.min(), row.min()
        wide = int(column.max() - left) + 1
        index = (row - low) * wide + column - left
        light = tally(index.ravel(), (share * rays.weight).ravel())
        lit = np.flatnonzero(light)
        return (lit % wide + left) * _KERNEL_MM, (lit // wide + low) * _KERNEL_MM, light[lit]


def tally(index: Integers, light: Floats, size: int = 0) -> Floats:
    """The light that falls to each index, shape `(size,)` or as many as there are."""
    return np.asarray(np.bincount(index, light, size), dtype=np.float64)


def spread(x: Floats, y: Floats) -> tuple[Integers, Integers, Floats]:
    """The four whole places around each point, and the share of it that each gets, so that the
    middle stays where it is; arrays of shape `(4, n)`."""
    column, row = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    right, up = x - column, y - row
    return (
        np.stack([column, column + 1, column, column + 1]),
        np.stack([row, row, row + 1, row + 1]),
        np.stack([(1 - right) * (1 - up), right * (1 - up), (1 - right) * up, right * up]),
    )
