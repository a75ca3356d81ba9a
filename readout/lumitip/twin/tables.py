"""`LineTable`: light that an edge or a cable takes from a cell, by direction and distance.

If the edge or cable is straight over the reach of a cell, the cell's light depends on direction and
signed distance alone, so one look-up replaces the raster. Borders are as soft as on the raster,
which accounts for the size of the dies.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lumitip.grid import Floats, Integers
from lumitip.layout import Layout
from lumitip.twin.lines import Numbers, beside_arc, from_arc, from_foot
from lumitip.twin.pairs import Pairs, tally
from lumitip.twin.scene import PIXEL_MM, Singles
from lumitip.values import one_line

STEP_MM = 0.05
STEP_DEG = 3.0
_SOFT = round(PIXEL_MM / STEP_MM / 2.0)  # half the width of a border, in steps


@dataclass(frozen=True, eq=False)
class LineTable:
    """Share of light that an opaque object along a line takes from each cell."""

    shares: Singles
    """Shape `(rows, angles, distances)`: angles from 0 to below 360 in `STEP_DEG`, distances from
    `-reach_mm` to `reach_mm` in `STEP_MM`. Angle: direction of the line. Distance: of the cell's
    centre from the line along its left normal; a half-plane covers the right of its line."""
    reach_mm: float
    """Distance from the line beyond which the share is constant (mm)."""
    row: Integers
    """Row of each cell, shape `(cells,)`: cells with the same LEDs around them share one."""

    def __repr__(self) -> str:
        return one_line(self)

    @property
    def angles_deg(self) -> Floats:
        """Direction of each row."""
        return np.arange(self.shares.shape[1], dtype=np.float64) * STEP_DEG

    @property
    def distances_mm(self) -> Floats:
        """Distance of each column."""
        return np.arange(self.shares.shape[2], dtype=np.float64) * STEP_MM - self.reach_mm

    def __call__(self, angle_deg: Numbers, distance_mm: Numbers) -> Floats:
        """Share of light taken from each cell, shape `(..., cells)`, linear between entries.

        Args:
            angle_deg: direction of the line beside each cell; broadcast with `distance_mm`.
            distance_mm: of each cell's centre, left of the line, shape `(..., cells)` (mm).
        """
        angles, distances = self.shares.shape[1:]
        turn = np.asarray(angle_deg) * (1.0 / STEP_DEG)
        whole = np.floor(turn)
        way = np.clip((distance_mm + self.reach_mm) * (1.0 / STEP_MM), 0.0, distances - 1.001)
        column = way.astype(np.int64)
        right, down = way - column, turn - whole
        first = whole.astype(np.int64) % angles
        begin = self._begin
        one = begin + first * distances + column
        other = begin + (first + 1) % angles * distances + column
        flat, below = self._flat
        # With the growth of each entry at hand, a look-up is a gather and a product.
        low = flat[one] + right * below[one]
        share: Floats = low + down * (flat[other] + right * below[other] - low)
        return share

    def of_lines(
        self, layout: Layout, offset_mm: Floats, angle_deg: Floats, bend_per_mm: Floats
    ) -> Floats:
        """Share of light that many lines or arcs take from each cell, shape `(n, cells)`.

        Args:
            layout: the cells.
            offset_mm: of the lines, see `Line`; shape `(n,)`.
            angle_deg: of the lines; shape `(n,)`.
            bend_per_mm: curvature of the lines; shape `(n,)`.
        """
        beside, bend = angle_deg[:, None], bend_per_mm[:, None]
        way = np.cos(np.radians(beside)), np.sin(np.radians(beside))
        left, x, y = from_foot(layout.x_mm, layout.y_mm, offset_mm[:, None], *way)
        if bend.any():
            return self(beside_arc(x, y, bend, *way), from_arc(left, x, y, bend))
        return self(beside, left)

    @cached_property
    def _begin(self) -> Integers:
        _, angles, distances = self.shares.shape
        begin: Integers = self.row * (angles * distances)
        return begin

    @cached_property
    def _flat(self) -> tuple[Singles, Singles]:
        growth = np.diff(self.shares, axis=2, append=self.shares[:, :, -1:])
        return self.shares.ravel(), growth.ravel()


def edge_table(pairs: Pairs, height: float = 0.5) -> LineTable:
    """The table of an opaque half-plane at a height in the gap."""
    spots = [pairs.spots(kind, height) for kind in range(len(pairs.kinds))]
    reach_mm = _reach(max(float(np.hypot(x, y).max(initial=0.0)) for x, y, _ in spots))

    def taken(kind: int, cos: float, sin: float) -> Floats:
        x, y, light = spots[kind]
        return _steps(y * cos - x * sin, light, reach_mm)

    half = _table(pairs, taken, reach_mm)
    # The reversed line covers the other side.
    return _finished(pairs, half, np.float32(1.0) - half[:, :, ::-1], reach_mm)


def cable_table(pairs: Pairs, diameter_mm: float, height: float = 0.5) -> LineTable:
    """The table of an opaque round cable, which takes rays that pass within its radius."""
    kinds = range(len(pairs.kinds))
    rays = [pairs.bundle(kind) for kind in kinds]
    places = [rays[k].at(height * pairs.kinds[k][0].gap_mm) for k in kinds]
    far = max(
        float(
            (
                np.hypot(*places[k]) + diameter_mm / 2.0 * np.sqrt(1.0 + r.across**2 + r.along**2)
            ).max()
        )
        for k, r in enumerate(rays)
    )
    reach_mm = _reach(far)

    def taken(kind: int, cos: float, sin: float) -> Floats:
        ray, (x, y) = rays[kind], places[kind]
        slant = ray.along * cos - ray.across * sin
        half = diameter_mm / 2.0 * np.sqrt(1.0 + slant * slant)
        left = y * cos - x * sin
        return _steps(left - half, ray.weight, reach_mm) - _steps(left + half, ray.weight, reach_mm)

    half = _table(pairs, taken, reach_mm)
    return _finished(pairs, half, half[:, :, ::-1], reach_mm)


def _reach(far_mm: float) -> float:
    return float((np.ceil(far_mm / STEP_MM) + 1.0 + _SOFT) * STEP_MM)


def _steps(left_mm: Floats, light: Floats, reach_mm: float) -> Floats:
    """Light to the right of a line, for every distance of the cell to the left of it."""
    entries = 2 * round(reach_mm / STEP_MM) + 1
    way = (left_mm + reach_mm) * (1.0 / STEP_MM)
    column = way.astype(np.int64)
    right = light * (way - column)
    bins = tally(column, light - right, entries) + tally(column + 1, right, entries)
    summed: Floats = (np.cumsum(bins) - 0.5 * bins)[::-1]
    return summed


def _table(pairs: Pairs, taken: Callable[[int, float, float], Floats], reach_mm: float) -> Singles:
    """Share of light in each row, for half a turn of directions."""
    angles = np.radians(np.arange(0.0, 180.0, STEP_DEG))
    entries = 2 * round(reach_mm / STEP_MM) + 1
    around, kinds = pairs.around.counts, range(len(pairs.kinds))
    light = np.empty((len(around), angles.size, entries), np.float32)
    full = around @ pairs.light
    for a, angle in enumerate(angles):
        cos, sin = float(np.cos(angle)), float(np.sin(angle))
        soft = _softened(np.array([taken(kind, cos, sin) for kind in kinds]))
        light[:, a] = around @ soft / full[:, None]
    return light


def _softened(light: Floats) -> Floats:
    """Moving mean over the width of a soft border, along the second axis."""
    ends = ((0, 0), (_SOFT + 1, _SOFT))
    summed = np.cumsum(np.pad(light, ends, mode="edge"), axis=1)
    whole = summed[:, 2 * _SOFT :] - summed[:, : -2 * _SOFT]
    mean: Floats = (whole[:, 1:] + whole[:, :-1]) / (4.0 * _SOFT)
    return mean


def _finished(pairs: Pairs, half: Singles, other: Singles, reach_mm: float) -> LineTable:
    shares = np.concatenate([half, other], axis=1)
    return LineTable(shares, reach_mm, pairs.around.row)
