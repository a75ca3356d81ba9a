"""Slots in the tip edge: they are filled with silicone, which wraps the skin round the tip."""

import math
from dataclasses import dataclass

from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.design import Board, Box, Outline, Stack, Tip
from lumitip_fab.design.making import MOST_TIP_STOP_FRACTION, tip_stop_mm

LIP = "mould.tip_lip_mm"
SLOT_MM = 0.6  # deep: with the mould's gap more silicone than the plate's edge is thick
FROM_STOP_MM = 0.5  # to the mould's stop
FROM_END_MM = 0.8  # to the end of the straight edge
LEAST_WIDTH_MM = 2.0
OVER_LEVEL_MM = 0.3  # of the mould's wall, which holds the silicone
PLATE_OVER_WALL_MM = 0.2  # at least, so that nothing on the plate's back lies on the wall


@dataclass(frozen=True)
class _Edge:
    """The tip edge, and what is near it."""

    config: Input
    outline: Outline
    board: Board
    stack: Stack
    edge_mm: float
    slope: float

    @property
    def ends_mm(self) -> tuple[float, float]:
        """Ends of the right slot, along the edge."""
        outline = self.outline
        inner = tip_stop_mm(outline.tip_width_mm) / 2 + FROM_STOP_MM
        return inner, outline.tip_width_mm / 2 - FROM_END_MM

    @property
    def slots(self) -> tuple[Box, ...]:
        """The slots, left and right."""
        (inner, outer), high = self.ends_mm, self.outline.tip_y_mm
        right = Box(inner, outer, high - SLOT_MM, high)
        return right.mirrored(), right

    def refuse(self, faults: Diagnostics) -> None:
        """Note what leaves no room for the slots, or for the silicone in the mould."""
        inner, outer = self.ends_mm
        wanted_mm = 2 * (FROM_STOP_MM + LEAST_WIDTH_MM + FROM_END_MM)
        faults.unless(
            outer - inner >= LEAST_WIDTH_MM,
            "tip_lip_narrow",
            edge_mm=self.outline.tip_width_mm,
            least_mm=wanted_mm / (1 - MOST_TIP_STOP_FRACTION),
        )
        pocket_y = self.board.pocket.y_max_mm + (self.board.roof_mm if self.stack.sunk else 0.0)
        left_mm = self.outline.tip_y_mm - SLOT_MM - pocket_y
        wall_mm = self.config.parameters.printer.min_wall_mm
        faults.unless(left_mm >= wall_mm, "tip_lip_pocket", left_mm=left_mm, wall_mm=wall_mm)
        highest_mm = self.stack.plate_mm - PLATE_OVER_WALL_MM
        most_mm = highest_mm - wall_over_rim_mm(self.config, 0.0, self.edge_mm, self.slope)
        faults.unless(
            self.config.parameters.mould.tip_lip_mm <= most_mm + 1e-9,
            "tip_lip_high",
            most_mm=max(math.floor(most_mm * 100 + 1e-6) / 100, 0.0),
            edge_mm=self.edge_mm,
        )


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
        stack: for the height that the mould's wall may have.
        edge: thickness of the tip edge (mm), and what it gains for each mm away from it.
    """
    if not config.parameters.mould.tip_lip_mm:
        return ()
    tip, faults = _Edge(config, outline, board, stack, *edge), Diagnostics(config)
    tip.refuse(faults)
    return () if faults.problems else tip.slots


def refuse_lip(
    config: Input, outline: Outline, board: Board, stack: Stack, tip: Tip, faults: Diagnostics
) -> None:
    """Refuse a lip that the file writes where there is no room; an automatic one is left out."""
    if config.parameters.mould.tip_lip_mm and LIP not in config.automatic:
        _Edge(config, outline, board, stack, tip.edge_mm, tip.slope).refuse(faults)


def wall_over_rim_mm(config: Input, lip_mm: float, edge_mm: float, slope: float) -> float:
    """Height over the rim plane that the mould's wall needs for a lip of silicone.

    Args:
        config: for the printer's layer, by which the prop may be too high.
        lip_mm: silicone on the back of the plate, at least.
        edge_mm: thickness of the tip edge.
        slope: what the edge gains for each mm away from it.
    """
    level_mm = edge_mm + SLOT_MM * slope + lip_mm
    return level_mm + config.parts.printer.profile.layer_mm + OVER_LEVEL_MM


def guided_mm(config: Input, stack: Stack, tip: Tip) -> float:
    """How far the mould's wall reaches along the plate's side: farther where silicone that wraps
    the tip stands higher."""
    if not tip.slots:
        return stack.guided_mm
    lip_mm = config.parameters.mould.tip_lip_mm
    return max(stack.guided_mm, wall_over_rim_mm(config, lip_mm, tip.edge_mm, tip.slope))
