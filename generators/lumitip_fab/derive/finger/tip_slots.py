"""Slots in the tip edge: they are filled with silicone, which wraps the skin round the tip."""

from lumitip_fab.config.load import Input
from lumitip_fab.design import Board, Box, Outline, Stack
from lumitip_fab.design.making import TIP_LAND_FRACTION

SLOT_MM = 0.6  # deep: with the mould's gap more silicone than the plate's edge is thick
FROM_STOP_MM = 0.5  # to the mould's stop
FROM_END_MM = 0.8  # to the end of the straight edge
LEAST_WIDTH_MM = 2.0
OVER_LEVEL_MM = 0.3  # of the mould's wall, which holds the silicone


def derive_slots(
    config: Input,
    outline: Outline,
    board: Board,
    stack: Stack,
    edge: tuple[float, float],
) -> tuple[Box, ...]:
    """The slots, left and right; none where the file wants none, or where there is no room.

    Args:
        config: the parameters.
        outline: for the straight tip edge.
        board: whose pocket they must not meet.
        stack: for the height of the mould's wall.
        edge: thickness of the tip edge (mm), and what it gains for each mm away from it.
    """
    p = config.parameters
    lip, (edge_mm, slope) = p.mould.tip_lip_mm, edge
    if not lip:
        return ()
    inner = outline.tip_width_mm * TIP_LAND_FRACTION / 2 + FROM_STOP_MM
    outer = outline.tip_width_mm / 2 - FROM_END_MM
    low, high = outline.tip_y_mm - SLOT_MM, outline.tip_y_mm
    ahead = low - board.pocket.y_max_mm - (board.roof_mm if stack.sunk else 0.0)
    layer = config.parts.printer.profile.layer_mm  # by which the prop may be too high
    most = stack.guided_mm - OVER_LEVEL_MM - layer - edge_mm - SLOT_MM * slope
    fits = outer - inner >= LEAST_WIDTH_MM and ahead >= p.printer.min_wall_mm
    if not fits or lip > most + 1e-9:
        return ()
    return Box(-outer, -inner, low, high), Box(inner, outer, low, high)
