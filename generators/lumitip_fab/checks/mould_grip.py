"""The gaps in a mould's side walls, in which the plate is taken between two fingers: their bottoms
over the silicone, which creeps up between plate and wall and would run out of a lower one."""

import math
from collections.abc import Callable, Iterator

import numpy as np

from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.result import Measurement, Subject
from lumitip_fab.design import Design

BOTTOM_MM = 0.05
_PLACES = 15
_END_MM = 0.05  # from the ends of the bottom, where the wall begins to rise
_IN_WALL = (0.25, 0.5, 0.75)  # of the wall's thickness


def measure_grip(
    depths_mm: Callable[[solids.Vectors], solids.Vectors], file: str, design: Design
) -> Iterator[Measurement]:
    """Height of both gaps' bottoms, across the wall and along the gap.

    Args:
        depths_mm: how far the mould lies below the rim plane at points (x, y) of the sensor frame.
        file: the mould's name.
        design: for the gaps, the wall and the silicone's level.
    """
    mould, of = design.mould, Subject("mould", file)
    grip = mould.grip
    lean = grip.bottom_mm * math.tan(math.radians(mould.draft_deg))
    y = np.linspace(grip.y_min_mm + _END_MM, grip.y_max_mm - _END_MM, _PLACES)
    half = np.array([design.outline.half_width_at(float(at)) for at in y])
    level = np.array([mould.level_mm(float(at)) for at in y])
    for side, name in ((1.0, "+x"), (-1.0, "-x")):
        x = [half + mould.wall_gap_mm + lean + part * mould.wall_mm for part in _IN_WALL]
        points = np.stack([side * np.array(x), np.broadcast_to(y, (len(x), len(y)))], axis=-1)
        bottom = -depths_mm(points.reshape(-1, 2)).reshape(len(x), -1)
        over, least = float((bottom - level).min()), grip.over_level_mm - BOTTOM_MM
        note = "bottom of the gap for the grip over the silicone's level, at least"
        yield of.figure("grip", over, least, math.inf, note=note, at=f"level, {name}")
        note = "bottom of the gap for the grip over the rim plane"
        yield of.near("grip", bottom.ravel(), grip.bottom_mm, BOTTOM_MM, note, at=f"bottom, {name}")
