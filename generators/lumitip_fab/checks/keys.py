"""Holes by which silicone and plate hold each other: open, in place, and wider in the back."""

from collections.abc import Iterator

import numpy as np

from lumitip_fab.checks.printed import Printed, circles, holes_at
from lumitip_fab.checks.readers.solids import Vectors, cast
from lumitip_fab.checks.result import Measurement
from lumitip_fab.checks.walls import Mask
from lumitip_fab.design import Design

POSITION_MM = 0.05
HOLE_MM = 0.06
SINK_MM = 0.06
_NEAR_MM = 0.1  # of the rays and sections to front and back of the plate
_FAR_MM = 40.0


def beside(design: Design, xs_mm: Vectors) -> Vectors:
    """Those of some x at which no ray along y or z meets a key."""
    free = np.ones(len(xs_mm), dtype=np.bool_)
    for key in design.keys:
        free &= np.abs(xs_mm - key.at[0]) > key.wide_mm
    return xs_mm[free]


def near(design: Design, points: Vectors, reach_mm: float) -> Mask:
    """Which points of shape `(n, 3)` are within a distance of a key's countersink."""
    found = np.zeros(len(points), dtype=np.bool_)
    for key in design.keys:
        found |= np.hypot(*(points[:, :2] - np.array(key.at)).T) < key.wide_mm / 2 + reach_mm
    return found


def measure_keys(part: Printed) -> Iterator[Measurement]:
    """Each key is open from front to back, has its place and width, and locks what fills it."""
    keys, stack, tip = part.design.keys, part.design.stack, part.design.tip
    if not keys:
        return
    front = stack.face_z_mm - _NEAR_MM
    off, wide = circles(holes_at(part.sensor, front), tuple(k.at for k in keys), keys[0].hole_mm)
    yield part.near("keys", off, 0.0, POSITION_MM)
    yield part.near("key_hole", wide, keys[0].hole_mm, HOLE_MM)
    backs = np.array([tip.back_z_mm(stack, k.at[1]) + _NEAR_MM for k in keys])
    axes = np.array([k.at for k in keys])
    shut = _shut(part, axes)
    yield part.figure("keys_open", shut, 0, 0, "closed holes")
    # Across the wedge, where its slope makes the countersink no wider.
    radii = _radii(part, np.column_stack([axes, backs]))
    wanted = np.array([k.hole_mm / 2 + k.sink_mm - _NEAR_MM for k in keys])
    yield part.near("key_sink", radii - wanted, 0.0, SINK_MM)


def _shut(part: Printed, axes: Vectors) -> float:
    """How many holes a ray along their axis does not pass."""
    high = np.column_stack([axes, np.full(len(axes), _FAR_MM)])
    hits = cast(part.sensor, high, np.array([0.0, 0.0, -1.0]), 3 * _FAR_MM)
    return float(len(np.unique(hits.ray)))


def _radii(part: Printed, centres: Vectors) -> Vectors:
    """Least distance along +x and -x from each centre to material; NaN where there is none."""
    reach = []
    for side in (-1.0, 1.0):
        found, _ = cast(part.sensor, centres, np.array([side, 0.0, 0.0]), _FAR_MM).first(
            len(centres)
        )
        reach.append(found)
    least = np.min(reach, axis=0)
    return np.asarray(np.where(np.isfinite(least), least, np.nan))
