"""A flexible board: its layers, where it bends, and where it is stiff."""

from dataclasses import replace

from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards import connectors
from lumitip_fab.derive.finger.flex import is_flex
from lumitip_fab.design import Box, Flexible

COVERLAY_MM = 0.0275  # 12.5 um of polyimide on 15 um of adhesive
STIFFENER_MM = 0.2
STIFFENER_GAP_MM = 0.3  # to the sides of the wire notch
OVER_PADS_MM = 0.1


def flexible_board(config: Input, box: Box, notch: Box, connector_y_mm: float) -> Flexible | None:
    """Layers and zones of a flexible board; none for a rigid one.

    The coverlay is as thick as common ones of board houses (assumed: each has its own); the core is
    what remains. The board bends beyond the rigid interface. The stiffener is behind
    the wires' pads, where the plate is open, so that it does not lift the board; it ends before
    the test points.
    """
    p, copper_mm = config.parameters, config.catalogue.laminates.flexible.copper_mm
    if not is_flex(p):
        return None
    held_to = min(notch.y_min_mm + p.flex.interface_mm, box.y_max_mm)
    x = notch.x_max_mm - STIFFENER_GAP_MM
    top = connector_y_mm + connectors.WIDE[1] / 2 + OVER_PADS_MM
    return Flexible(
        bend=replace(box, y_min_mm=held_to),
        stiffener=Box(-x, x, box.y_min_mm, top),
        stiffener_mm=STIFFENER_MM,
        core_mm=p.stack.pcb_mm - 2 * (copper_mm + COVERLAY_MM),
        copper_mm=copper_mm,
        coverlay_mm=COVERLAY_MM,
    )
