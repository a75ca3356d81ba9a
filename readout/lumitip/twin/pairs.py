"""`Pairs`: cells and the LEDs that they see, sorted into kinds with the same bundle of rays.

`Mixed` computes scenes of several objects at different heights, or with cables among them. Each
ray passes every object at that object's own height, so shadows overlap as in reality. As an
approximation, light scattered by a diffuse object passes the others with the mean transmittance
that they have for the cell's direct light.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from lumitip import arguments
from lumitip.grid import Floats, Integers
from lumitip.layout import Layout
from lumitip.twin.lines import Numbers
from lumitip.twin.optics import Model, TwinError
from lumitip.twin.rays import ACROSS, REACH_MM, Bundle, bundle
from lumitip.twin.scene import PIXEL_MM, Cable, Thing

_FEW_ACROSS = 3  # points across half of a hole where fewer rays suffice
_MANY = 60  # bundles, beyond which all get fewer rays
_DIM = 0.005  # share of the brightest bundle's light, below which a bundle gets fewer rays
_KERNEL_MM = 0.1


@dataclass(frozen=True)
class Misregistration:
    """Deviation of the emitter from its nominal place, in the receiver's sensor frame."""

    x_mm: float = 0.0
    y_mm: float = 0.0
    angle_deg: float = 0.0
    """Rotation about z, through the origin."""
    tilt_deg: float = 0.0
    """Rotation about x: the gap grows towards the tip. In the model the holes stay parallel, which
    neglects a cosine: 0.4 % at 5 degrees."""

    def __post_init__(self) -> None:
        arguments.finite_fields(self, TwinError)


@dataclass(frozen=True)
class Emitter:
    """Optics and place of the emitter."""

    model: Model
    deviation: Misregistration = Misregistration()

    def gap_mm(self, y_mm: Floats) -> Floats:
        """Gap at places (mm).

        Raises:
            TwinError: if the fingers touch there.
        """
        tilt_deg = self.deviation.tilt_deg
        gap: Floats = self.model.gap_mm + y_mm * np.tan(np.radians(tilt_deg))
        if gap.min() <= 0.0:
            raise TwinError(
                f"tilt_deg is {tilt_deg}; the fingers touch at a gap of {self.model.gap_mm} mm. "
                "Reduce the tilt or increase gap_mm."
            )
        return gap

    def leds_mm(self, layout: Layout) -> tuple[Floats, Floats]:
        """Places of the LEDs: LED i faces cell i, apart from misregistration."""
        angle = np.radians(self.deviation.angle_deg)
        cos, sin = float(np.cos(angle)), float(np.sin(angle))
        return (
            layout.x_mm * cos - layout.y_mm * sin + self.deviation.x_mm,
            layout.x_mm * sin + layout.y_mm * cos + self.deviation.y_mm,
        )


@dataclass(frozen=True, eq=False)
class Around:
    """Sets of LEDs that cells see: inside a regular grid all cells see the same."""

    counts: Floats
    """Number of pairs of each kind in each set, shape `(rows, kinds)`."""
    row: Integers
    """Set of each cell, shape `(cells,)`."""


@dataclass(frozen=True, eq=False)
class Pairs:
    """All pairs of a cell and an LED within reach; arrays of shape `(pairs,)`."""

    cells: int
    cell: Integers
    kind: Integers
    """Index into `kinds`."""
    kinds: tuple[tuple[Model, float, float, tuple[float, float]], ...]
    """Model (with the local gap), displacement (mm) and holes of each bundle."""

    @classmethod
    def of(cls, layout: Layout, emitter: Emitter) -> "Pairs":
        """The pairs of a layout and its emitter."""
        led_x, led_y = emitter.leds_mm(layout)
        model, tilted = emitter.model, emitter.deviation.tilt_deg != 0.0
        dx, dy = led_x - layout.x_mm[:, None], led_y - layout.y_mm[:, None]
        cell, led = np.nonzero(np.hypot(dx, dy) <= REACH_MM)
        gap_mm = emitter.gap_mm((layout.y_mm[cell] + led_y[led]) / 2.0)
        keys = np.round(np.stack([gap_mm, dx[cell, led], dy[cell, led]], axis=1), 3) + 0.0
        keys[:, 0] = np.round(keys[:, 0], 2) if tilted else model.gap_mm
        # One integer for each row: rows sort slowly, and block other threads meanwhile.
        gap_um, x_um, y_um = np.rint(1e3 * keys.T).astype(np.int64)
        whole = (gap_um << 40) + (x_um << 20) + y_um
        _, first, kind = np.unique(whole, return_index=True, return_inverse=True)
        shares = np.stack([layout.hole_share[led], layout.hole_share[cell]])
        if np.ptp(layout.hole_share):
            sizes, size = np.unique(layout.hole_share, return_inverse=True)
            whole = (kind.ravel() * sizes.size + size[led]) * sizes.size + size[cell]
            _, first, kind = np.unique(whole, return_index=True, return_inverse=True)
        each = zip(keys[first].tolist(), shares[:, first].T.tolist(), strict=True)
        kinds = tuple((replace(model, gap_mm=g), x, y, (a, b)) for (g, x, y), (a, b) in each)
        return cls(len(layout), cell, kind.ravel(), kinds)

    @cached_property
    def _across(self) -> tuple[int, ...]:
        """Points across half of a hole, for each kind."""
        rough = np.array([self.bundle(k, _FEW_ACROSS).weight.sum() for k in range(len(self.kinds))])
        bright = (rough > _DIM * rough.max()) & (len(self.kinds) <= _MANY)
        return tuple(np.where(bright, ACROSS, _FEW_ACROSS).tolist())

    def bundle(self, kind: int, across: int | None = None) -> Bundle:
        """Rays of one kind."""
        return bundle(*self.kinds[kind], across=across or self._across[kind])

    @cached_property
    def light(self) -> Floats:
        """Light of each kind, shape `(kinds,)`."""
        return np.array([self.bundle(k).weight.sum() for k in range(len(self.kinds))])

    @cached_property
    def full(self) -> Floats:
        """Light of each cell with nothing in the gap, shape `(cells,)`."""
        return tally(self.cell, self.light[self.kind], self.cells)

    @cached_property
    def around(self) -> "Around":
        """The LEDs around the cells, each set once."""
        counted = np.zeros((self.cells, len(self.kinds)))
        np.add.at(counted, (self.cell, self.kind), 1.0)
        # Equal rows have equal bytes: whole numbers, and no negative zeros.
        names = [row.tobytes() for row in counted]
        first = {name: cell for cell, name in reversed(list(enumerate(names)))}
        cells = sorted(first.values())
        place = {names[cell]: row for row, cell in enumerate(cells)}
        return Around(counted[cells], np.array([place[name] for name in names]))

    def spots(self, kind: int, height: float) -> tuple[Floats, Floats, Floats]:
        """Points where the rays of a kind cross a plane, on a fine raster: x, y (mm), light."""
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
    """Sum of the light at each index, shape `(size,)` or longer."""
    return np.asarray(np.bincount(index, light, size), dtype=np.float64)


def spread(x: Floats, y: Floats) -> tuple[Integers, Integers, Floats]:
    """Distribute points over the four integer places around each: columns, rows and shares, each of
    shape `(4, n)`. The centre of gravity stays."""
    column, row = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    right, up = x - column, y - row
    return (
        np.stack([column, column + 1, column, column + 1]),
        np.stack([row, row, row + 1, row + 1]),
        np.stack([(1 - right) * (1 - up), right * (1 - up), (1 - right) * up, right * up]),
    )


class Mixed:
    """All rays of all cells."""

    def __init__(self, layout: Layout, pairs: Pairs, scattered: Callable[[Thing], Numbers]) -> None:
        """Gather the rays.

        Args:
            layout: the cells.
            pairs: the LEDs that each cell sees.
            scattered: light that one diffuse object sends to each cell, if it scatters all.
        """
        bundles = [pairs.bundle(kind, _FEW_ACROSS) for kind in range(len(pairs.kinds))]
        sizes = np.array([b.weight.size for b in bundles])[pairs.kind]
        self._cell = np.repeat(pairs.cell, sizes)
        self._cells = pairs.cells
        gaps = np.array([model.gap_mm for model, *_ in pairs.kinds])
        self._gap_mm = np.repeat(gaps[pairs.kind], sizes)

        def gathered(part: Callable[[Bundle], Floats]) -> Floats:
            return np.concatenate([part(bundles[kind]) for kind in pairs.kind])

        self._x_mm = gathered(lambda b: b.x_mm) + layout.x_mm[self._cell]
        self._y_mm = gathered(lambda b: b.y_mm) + layout.y_mm[self._cell]
        self._across, self._along = gathered(lambda b: b.across), gathered(lambda b: b.along)
        weight = gathered(lambda b: b.weight)
        self._weight = weight / tally(self._cell, weight, self._cells)[self._cell]
        self._scattered = scattered

    def light(self, found: Sequence[Thing]) -> Floats:
        """Share of its empty-grasp light that each cell receives, shape `(cells,)`."""
        passed = [self._passed(thing) for thing in found]
        light = self._sum(np.prod(passed, axis=0))
        for number, thing in enumerate(found):
            if thing.diffuse:
                others = [p for i, p in enumerate(passed) if i != number]
                through = self._sum(np.prod(others, axis=0)) if others else 1.0
                light = light + thing.diffuse * self._scattered(thing) * through
        return light

    def _passed(self, thing: Thing) -> Floats:
        """Share of each ray that passes straight through an object, shape `(rays,)`."""
        up_mm = thing.height * self._gap_mm
        x, y = self._x_mm + up_mm * self._across, self._y_mm + up_mm * self._along
        if isinstance(thing, Cable):
            layers: Sequence[Numbers] = (thing.shade(x, y, self._across, self._along, PIXEL_MM),)
        else:
            layers = thing.layers(x, y, PIXEL_MM)
        passed = np.ones(x.size)
        for layer in layers:
            passed *= 1.0 - (1.0 - thing.clear) * layer
        return passed

    def _sum(self, passed: Floats) -> Floats:
        return tally(self._cell, self._weight * passed, self._cells)
