"""Test points, and parts that belong to no block: each by itself, with the names of its nets."""

from collections.abc import Sequence

from lumitip_fab.boards.kicad.schematic.contact_blocks import draw_strips
from lumitip_fab.boards.kicad.schematic.draft import REACH_MM, Draft
from lumitip_fab.boards.kicad.schematic.rail import STEP_MM
from lumitip_fab.boards.kicad.schematic.symbols import TWO_TERMINALS, test_point
from lumitip_fab.boards.model import GROUND
from lumitip_fab.design import Component

_ROWS, _ROW_MM, _COLUMN_MM = 4, 7.62, 33.02
"""Test points below each other, and the distances between them."""


def draw_probes(draft: Draft, parts: Sequence[Component]) -> None:
    """Test points in columns, each at the end of its net."""
    for i, part in enumerate(parts):
        x, y = i // _ROWS * _COLUMN_MM, i % _ROWS * _ROW_MM
        draft.place(part, "TestPoint", test_point(), (x, y), ref_at=(3.048, -3.302))
        draft.wire((x, y), (x + REACH_MM, y))
        ((_, net),) = part.nets
        draft.end(net, (x + REACH_MM, y), 1)


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
