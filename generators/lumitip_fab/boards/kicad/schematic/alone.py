"""Parts that belong to no block: each by itself, with the names of its nets."""

from collections.abc import Sequence

from lumitip_fab.boards.kicad.schematic.contact_blocks import draw_strips
from lumitip_fab.boards.kicad.schematic.draft import REACH_MM, Draft
from lumitip_fab.boards.kicad.schematic.rail import STEP_MM
from lumitip_fab.boards.kicad.schematic.symbols import TWO_TERMINALS
from lumitip_fab.boards.model import GROUND
from lumitip_fab.design import Component


def draw_alone(draft: Draft, parts: Sequence[Component]) -> None:
    """Parts with two terminals upright, others as a box with the names of their pins."""
    x = 0.0
    upright = [part for part in parts if part.kind in TWO_TERMINALS and len(part.nets) == 2]
    for part in upright:
        (_, upper), (_, lower) = part.nets
        if upper == GROUND:
            upper, lower = lower, upper
        reach = draft.stand(part, upper, (x, 0.0))
        for net, way in ((upper, -1), (lower, 1)):
            end = x, way * (REACH_MM + STEP_MM)
            draft.wire((x, way * REACH_MM), end)
            if draft.is_supply(net) and (net == GROUND) == (way > 0):
                draft.power(net, end)
            else:
                draft.tag(net, end, -90 * way % 360)
        x += reach + 2 * STEP_MM
    draw_strips(draft, [part for part in parts if part not in upright], x)
