"""Time to print a part, from its surface and the settings that the slicer gets."""

import math
from collections.abc import Mapping

from lumitip_fab.design.making import Filament, Printing

BRIM_MM = 3.0
"""A backing is tall and stands on little; a flat sheet has none to trim off."""
PERIMETERS = 3
OUTER_SHARE = 0.6
"""Of the speed, for outer walls and top layers: they are what board, gripper and silicone meet."""
FIRST_LAYER_MM_S = 20.0
ALLOWANCE = 1.12
"""For acceleration, travel and short layers: fitted to PrusaSlicer's estimates of the default
design's parts."""


def print_seconds(
    surface: Mapping[str, float], filament: Filament, printing: Printing, brim: bool
) -> float:
    """Time to print a solid part (s).

    Lines are as far apart as in PrusaSlicer (its manual, "Flow math"): width - height * (1 - pi/4),
    so that their length is volume / (distance * height). The three lines along each wall, the brim,
    the first layer and the tops go slower than the rest, as `print/*.ini` says. No line is faster
    than the filament melts.

    Args:
        surface: `volume_mm3`, `height_mm`, and the areas `side_mm2` of walls as seen from the
            side, `base_mm2` on the bed and `top_mm2` that look up.
        filament: speed, flow and layers.
        printing: width of the lines.
        brim: whether it has one.
    """
    line, layer = printing.line_mm, filament.layer_mm
    apart = line - layer * (1 - math.pi / 4)
    fast = min(filament.speed_mm_s, filament.max_flow_mm3_s / (apart * layer))
    outer, first = OUTER_SHARE * fast, min(FIRST_LAYER_MM_S, fast)
    length = surface["volume_mm3"] / (apart * layer)
    walls = min(PERIMETERS * surface["side_mm2"] / layer, length)
    seconds = walls / outer + (length - walls) / fast
    seconds += surface["base_mm2"] / apart * max(1 / first - 1 / fast, 0.0)
    seconds += surface["top_mm2"] / apart * (1 / outer - 1 / fast)
    if brim:
        seconds += surface["side_mm2"] / surface["height_mm"] * (BRIM_MM / apart) / first
    return ALLOWANCE * seconds
