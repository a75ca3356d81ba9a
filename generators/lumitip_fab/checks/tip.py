"""The wedge at the tip of a backing, by rays through its plate in the finger's sensor frame."""

from collections.abc import Iterator

import numpy as np

from lumitip_fab.checks.keys import beside
from lumitip_fab.checks.printed import RAY_MM, Printed
from lumitip_fab.checks.readers.solids import Vectors, cast
from lumitip_fab.checks.result import Measurement

EDGE_MM = 0.05
ANGLE_DEG = 0.5
BESIDE_MM = 0.1  # a slot
NEAR_MM = 0.05  # the edge, where its thickness is measured
INSET_MM = 0.3  # of the rays from both ends of the wedge
_DOWN = np.array([0.0, 0.0, -1.0])


def measure_tip(part: Printed) -> Iterator[Measurement]:
    """The wedge: thickness at the tip edge and angle."""
    outline, tip = part.design.outline, part.design.tip
    slope = np.tan(np.radians(tip.angle_deg))
    xs = beside(part.design, np.linspace(-0.45, 0.45, 81) * outline.tip_width_mm)
    back = np.zeros(len(xs))  # of the edge, in a slot
    for slot in tip.slots:
        back[(xs > slot.x_min_mm) & (xs < slot.x_max_mm)] = slot.length_mm
        for end in (slot.x_min_mm, slot.x_max_mm):
            back[np.abs(xs - end) < BESIDE_MM] = np.nan
    xs, back = xs[~np.isnan(back)], back[~np.isnan(back)]
    ends = outline.tip_y_mm - back
    edge = _thickness(part, np.column_stack([xs, ends - NEAR_MM])) - (back + NEAR_MM) * slope
    yield part.near("tip_edge", edge, tip.edge_mm, EDGE_MM)
    board = part.design.board
    start = max(tip.slant_start_y_mm, board.pocket.y_max_mm + board.roof_mm)
    inset = np.minimum(INSET_MM, (ends - start) / 4)
    low, high = start + inset, ends - inset
    thick = _thickness(part, np.column_stack([np.repeat(xs, 2), np.stack([low, high], 1).ravel()]))
    angles = np.degrees(np.arctan((thick[::2] - thick[1::2]) / (high - low)))
    yield part.near("slant", angles, tip.angle_deg, ANGLE_DEG, unit="°")


def _thickness(part: Printed, points: Vectors) -> Vectors:
    """Thickness along z at points (x, y); NaN where the rays do not cross two faces."""
    above = np.column_stack([points, np.full(len(points), part.design.stack.rim_z_mm + RAY_MM)])
    hits = cast(part.sensor, above, _DOWN, 40.0)
    thick = np.full(len(points), np.nan)
    for k in range(len(points)):
        crossed = hits.distance_mm[hits.ray == k]
        if len(crossed) == 2:
            thick[k] = crossed[1] - crossed[0]
    return thick
