"""A second optical model of a fingertip pair: Monte Carlo path tracing.

It shares no code and no assumption with `lumitip.twin`, so that the pose estimator can be tested on
frames of another model. From a layout it takes the places of the cells and nominal sizes alone.

    lit = Light.of(layout, Tips(gap_mm=2.8), seed=1)
    lit.shares(Specimen("cable", offset_mm=1.0, angle_deg=12.0))

LEDs are square dies with a lobe of light; light is refracted by silicone, film and air, reflected
by their faces (Fresnel), scattered in silicone and film (Henyey–Greenstein), and reflected
diffusely by boards, hole walls and black faces, across the gap up to three times, through any
holes. A specimen has a thickness; it reflects light, and cloth passes some.

Left out: light that a smooth face reflects and that then reaches a die without being scattered,
and light on the underside of the specimen.
"""

from dataclasses import dataclass

import numpy as np

from lumitip.layout import Layout
from second_connect import FAR_MM, REACH_MM, WIDTH, Store, Tip
from second_optics import Floats, Integers
from second_shadow import Pairs, Shape, Singles, cover, shade
from second_specimen import Specimen
from second_tips import Tips
from second_trace import trace

STRAIGHT, WALKS = 8000, 60_000
_CAPACITY = 1_000_000


@dataclass(frozen=True, eq=False)
class Rays:
    """Stored rays of one LED at the origin, in order of the detectors that they reach."""

    begin: Integers
    """First ray of each detector, and the number of rays, shape `(detectors + 1,)`."""
    weight: Singles
    """Shape `(rays,)`."""
    places: Singles
    """Passes of the gap (x, y at the receiver, dx/dz, dy/dz; NaN for none), for light from a
    specimen behind its place on it (x, y); shape `(rays, 4 n)` or `(rays, 2 + 4 n)`."""

    @classmethod
    def of(cls, rows: Floats, places: Floats, detectors: int) -> "Rays":
        """Sort rays by their detectors."""
        order = np.argsort(rows[:, 0], kind="stable")
        begin = np.searchsorted(rows[order, 0], np.arange(detectors + 1))
        return cls(
            begin.astype(np.int64),
            rows[order, 1].astype(np.float32),
            np.ascontiguousarray(places[order], np.float32),
        )


@dataclass(frozen=True, eq=False)
class Light:
    """Rays of one pair of fingertips, traced once.

    All LEDs are alike, so those of one are traced, between the holes of a grid that has no border.
    """

    tips: Tips
    pairs: Pairs
    """Which detectors each LED has around it."""
    single: Rays
    """Light that passes the gap once."""
    several: Rays
    """Light that passes it two or three times."""
    through: Rays
    """Light that a specimen passes."""
    reflected: Rays
    """Light that a specimen reflects to the emitter."""
    full: Floats
    """Light of each cell in the empty grasp, as a share of the power of an LED."""
    ended: Floats
    """Light of one LED that faces absorbed, and that left or ended otherwise."""

    @classmethod
    def of(
        cls,
        layout: Layout,
        tips: Tips,
        seed: int = 0,
        straight: int = STRAIGHT,
        walks: int = WALKS,
    ) -> "Light":
        """Trace the rays.

        Args:
            layout: the cells.
            tips: optics.
            seed: of the random numbers.
            straight: straight rays to each detector near an LED.
            walks: scattered walks of an LED.

        Raises:
            MemoryError: if there are more rays than fit.
        """
        pairs, x, y = _pairs(layout)
        index = np.array(
            [tips.silicone_index, tips.film_index, 1.0, tips.film_index, tips.silicone_index]
        )
        detectors = int(np.count_nonzero(np.hypot(x, y) <= REACH_MM))
        tip = Tip(
            tips.stack(), index, x, y, detectors, _nearest(x, y), tips.lobe(), tips.response()
        )
        store = Store(np.empty((_CAPACITY, WIDTH)), np.zeros(3, np.int64))
        led = int(np.hypot(x, y).argmin())
        ended = trace(tip, store, led, straight, walks, seed)
        if store.used[2]:
            raise MemoryError(
                f"{store.used[2]} rays more than {_CAPACITY}; trace fewer walks or straight rays"
            )
        rows = store.rows[: store.used[0]]
        origin, count = np.divmod(rows[:, 2].astype(np.int64), 10)
        passes = np.where(np.arange(WIDTH - 5) // 4 < count[:, None], rows[:, 5:], np.nan)
        both = np.concatenate([rows[:, 3:5], passes], axis=1)
        one, many = (origin == 0) & (count == 1), (origin == 0) & (count > 1)
        lit, back = origin == 1, origin == 2
        arriving = np.bincount(rows[origin == 0, 0].astype(np.int64), rows[origin == 0, 1], x.size)
        return cls(
            tips,
            pairs,
            Rays.of(rows[one], passes[one, :4], x.size),
            Rays.of(rows[many], passes[many], x.size),
            Rays.of(rows[lit], both[lit, :2], x.size),
            Rays.of(rows[back], both[back], x.size),
            np.asarray(np.bincount(pairs.cell, arriving[pairs.detector], len(layout)), np.float64),
            ended,
        )

    def light(self, specimen: Specimen | None = None) -> Floats:
        """Light of each cell, as a share of the power of an LED, shape `(cells,)`."""
        if specimen is None:
            return self.full.copy()
        middle = self.tips.specimen_height * self.tips.gap_mm
        of = Shape(specimen.borders(), specimen.kind == "cable", middle, specimen.size_mm)
        found = np.zeros(self.full.size)
        for rays in (self.single, self.several):
            shade(self.pairs, rays.begin, rays.weight, rays.places, of, specimen.clear, found)
        for rays, share in ((self.through, specimen.passed), (self.reflected, specimen.albedo)):
            if share:
                cover(self.pairs, rays.begin, rays.weight, rays.places, of, share, found)
        return found

    def shares(self, specimen: Specimen | None = None) -> Floats:
        """The same as a share of each cell's empty grasp."""
        return self.light(specimen) / self.full


def _pairs(layout: Layout) -> tuple[Pairs, Floats, Floats]:
    """Pairs of LEDs and detectors, and all displacements of a detector from an LED (mm)."""
    dx = np.subtract.outer(layout.x_mm, layout.x_mm).ravel()  # detector, LED
    dy = np.subtract.outer(layout.y_mm, layout.y_mm).ravel()
    by_distance = np.round([np.hypot(dx, dy), dx, dy], 3) + 0.0
    _, first, number = np.unique(by_distance, axis=1, return_index=True, return_inverse=True)
    cells = len(layout)
    near = np.flatnonzero(np.hypot(dx, dy) <= REACH_MM)
    led = near % cells
    pairs = Pairs(near // cells, number.ravel()[near], layout.x_mm[led], layout.y_mm[led])
    return pairs, dx[first], dy[first]


def _nearest(x: Floats, y: Floats) -> Integers:
    """Cell nearest to each square millimetre around the origin."""
    middle = np.arange(-FAR_MM, FAR_MM) + 0.5
    far = np.hypot(middle[:, None, None] - x, middle[None, :, None] - y)
    return np.asarray(far.argmin(axis=2), np.int64)
