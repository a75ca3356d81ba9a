"""Scenes of several objects at different heights, or with cables among them: ray by ray.

Each ray passes every object at that object's own height, so shadows overlap as they do in truth.
What a diffuse object scatters passes the others with the mean transmittance that they have for
the cell's direct light, which is an approximation.
"""

from collections.abc import Callable, Sequence

import numpy as np

from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin.pairs import Pairs, tally
from lumitip.twin.rays import Bundle
from lumitip.twin.scene import PIXEL_MM, Cable, Numbers, Thing

ACROSS = 3
"""Points across half of a hole: few, because each ray meets each object."""


class Mixed:
    """All rays of all cells."""

    def __init__(self, layout: Layout, pairs: Pairs, scattered: Callable[[Thing], Numbers]) -> None:
        """Gather the rays.

        Args:
            layout: the cells.
            pairs: which LEDs each cell sees.
            scattered: light that a diffuse thing alone sends to each cell, if it scatters all.
        """
        bundles = [pairs.bundle(kind, ACROSS) for kind in range(len(pairs.kinds))]
        sizes = np.array([b.weight.size for b in bundles])[pairs.kind]
        self._cell = np.repeat(pairs.cell, sizes)
        self._cells = pairs.cells
        gaps = np.array([model.gap_mm for model, _, _ in pairs.kinds])
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
        """Share of its empty-grasp light that each cell gets, shape `(cells,)`."""
        passed = [self._passed(thing) for thing in found]
        light = self._sum(np.prod(passed, axis=0))
        for number, thing in enumerate(found):
            if thing.diffuse:
                others = [p for i, p in enumerate(passed) if i != number]
                through = self._sum(np.prod(others, axis=0)) if others else 1.0
                light = light + thing.diffuse * self._scattered(thing) * through
        return light

    def _passed(self, thing: Thing) -> Floats:
        """Share of each ray that goes straight through an object, shape `(rays,)`."""
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
