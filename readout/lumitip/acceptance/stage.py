"""A sheet that a positioning stage moves over the cells, and how exactly its edge is found.

Where the stage is in the frame of the cells is not known, so only ways are compared: the edge must
move in the estimates as far as the stage did.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lumitip.estimation.estimate import Estimate
from lumitip.frame import Values
from lumitip.grid import Floats
from lumitip.layout import Layout

STEP_MM = 1.0
START_MM = 4.0
"""Most that the edge may be from the nearest holes at the start."""
LEAST_PLACES = 8


@dataclass(frozen=True, eq=False)
class Traverse:
    """Light of all cells at the places of a stage, to and fro along one axis."""

    direction: str
    """Axis and sign, such as `"Z-"`."""
    moved_mm: Floats
    """From the start, shape `(places,)`."""
    light: Values
    """Not calibrated, shape `(places, frames, cells)`."""


@dataclass(frozen=True)
class Trace:
    """How exactly the edge of a traverse was found."""

    direction: str
    places: int
    """With the edge between the outermost holes."""
    missed: int
    """Of them, those without an estimate."""
    error_mm: float
    """Rms of the estimated way less that of the stage; NaN for too few places, as those below."""
    worst_mm: float
    scale: float
    """Estimated way over that of the stage."""
    turn_deg: float
    """Standard deviation of the edge's direction, which does not change."""
    play_mm: float
    """Mean difference between to and fro: play of the stage, and what the sheet drags along."""


def ways_mm(layout: Layout) -> tuple[float, float]:
    """How far the stage moves the sheet across and along the fingers: over all holes."""
    beside_mm = layout.optics.hole_mm + 2.0 * START_MM
    across, along = (
        math.ceil((float(np.ptp(cells)) + beside_mm) / STEP_MM) * STEP_MM
        for cells in (layout.x_mm, layout.y_mm)
    )
    return across, along


def places_mm(way_mm: float) -> Floats:
    """Places of a stage to and fro, from the start, shape `(places,)`."""
    out = np.arange(0.0, way_mm + STEP_MM / 2.0, STEP_MM)
    return np.concatenate([out, out[-2::-1]])


def trace(
    traverse: Traverse, values: Floats, layout: Layout, estimate: Callable[[Floats, str], Estimate]
) -> Trace:
    """Compare the estimated edges of a traverse with the places of the stage.

    Args:
        traverse: the places.
        values: calibrated mean of each place, NaN for cells with a fault, shape `(places, cells)`.
        layout: the cells.
        estimate: of the pose of an edge.
    """
    found = [estimate(row, "edge") for row in values]
    offset, angle = _one_side(
        np.array([each.offset_mm for each in found]), np.array([each.angle_deg for each in found])
    )
    seen = np.isfinite(offset)
    if seen.sum() < LEAST_PLACES:
        return _unseen(traverse, 0, 0)
    # Printers move along their own axes; the sheet may hang askew at the head.
    turned = float(np.nanmedian(angle))
    askew = math.radians(turned - 90.0 * round(turned / 90.0))
    way = traverse.moved_mm * math.cos(askew)
    way *= np.sign(np.median(np.diff(offset[seen]) * np.sign(np.diff(way[seen]))))
    # Places with the edge over the cells by the stage itself, so that a gross error counts.
    normal = np.array([-math.sin(math.radians(turned)), math.cos(math.radians(turned))])
    cells = normal @ np.stack([layout.x_mm, layout.y_mm])
    zero = float(np.nanmedian(offset - way))
    rim_mm = layout.optics.hole_mm / 2.0
    inside = (way + zero > cells.min() + rim_mm) & (way + zero < cells.max() - rim_mm)
    used = inside & seen
    missed = int(inside.sum() - used.sum())
    if used.sum() < LEAST_PLACES or not way.any():
        return _unseen(traverse, int(inside.sum()), missed)
    back = np.arange(way.size) > way.size // 2
    off = offset - way
    to, fro = (
        float(off[used & part].mean()) if (used & part).any() else zero for part in (~back, back)
    )
    off = (off - np.where(back, fro, to))[used]
    scale = np.polyfit(way[used], way[used] + off, 1)[0]
    return Trace(
        traverse.direction,
        int(inside.sum()),
        missed,
        float(np.sqrt(np.mean(off**2))),
        float(np.abs(off).max()),
        float(scale),
        float(angle[used].std()),
        abs(fro - to),
    )


def _one_side(offset_mm: Floats, angle_deg: Floats) -> tuple[Floats, Floats]:
    """The same lines with directions near each other: a direction and its opposite are one line."""
    seen = np.isfinite(angle_deg)
    if not seen.any():
        return offset_mm, angle_deg
    double = np.radians(2.0 * angle_deg[seen])
    middle = math.degrees(math.atan2(np.sin(double).mean(), np.cos(double).mean())) / 2.0
    turns = np.round((angle_deg - middle) / 180.0)
    return np.where(turns % 2.0 == 0.0, offset_mm, -offset_mm), angle_deg - 180.0 * turns


def _unseen(traverse: Traverse, places: int, missed: int) -> Trace:
    return Trace(traverse.direction, places, missed, *[math.nan] * 5)
