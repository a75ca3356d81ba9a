"""The insert of the mould: the film in front of all cells, where the floor is flat round them."""

import math

import shapely

from lumitip_fab.config.load import Input
from lumitip_fab.design import Box, Finger, Insert
from lumitip_fab.design.insert import LAND_MM, LEAST_MARGIN_MM

MARGIN_MM = 2.0  # from an aperture to the film's edge, where there is room
STEP_MM = 0.1
CLEARANCE_MM = 0.3  # a film is cut by hand to some 0.3 mm


def derive_inserts(config: Input, flat: shapely.Geometry, finger: Finger) -> tuple[Insert, ...]:
    """The insert; none where the file names no film, or the floor has no room for it.

    Args:
        config: the parameters.
        flat: where the floor is flat, in the sensor frame.
        finger: for its cells: the other one has them mirrored.
    """
    p, film = config.parameters, config.parts.mould.insert
    if film is None:
        return ()
    clearance = CLEARANCE_MM + max(p.printer.fit_mm, 0.0)
    reach = p.mask.extremes_mm[1] / math.sqrt(3)  # of a hexagon's corner; a circle's edge is nearer
    room = flat.buffer(-LAND_MM)
    for step in range(round((MARGIN_MM - LEAST_MARGIN_MM) / STEP_MM) + 1):
        box = _round_cells(finger, reach + MARGIN_MM - step * STEP_MM)
        if room.covers(shapely.box(*box.grown(clearance).bounds_mm)):
            title = config.title("mould.insert")
            return (Insert("insert", title, film.thickness_mm, box, clearance),)
    return ()


def _round_cells(finger: Finger, by_mm: float) -> Box:
    """The rectangle round all cells, grown, and up to the next hundredth of a millimetre."""
    xs, ys = zip(*finger.cells, strict=True)
    edges = max(map(abs, xs)), -min(ys), max(ys)
    half, low, high = (math.ceil(100 * (edge + by_mm) - 1e-6) / 100 for edge in edges)
    return Box(-half, half, -low, high)
