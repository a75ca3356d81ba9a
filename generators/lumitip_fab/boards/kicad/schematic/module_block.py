"""A module with its capacitors and its crystal."""

import re
from collections.abc import Sequence

from lumitip_fab.boards.kicad.schematic import shapes
from lumitip_fab.boards.kicad.schematic.draft import REACH_MM, Draft, nets_of
from lumitip_fab.boards.kicad.schematic.power_path import STEP_MM, Rail
from lumitip_fab.boards.kicad.schematic.sheet import text_mm, up_to_grid
from lumitip_fab.boards.kicad.schematic.symbols import PITCH_MM
from lumitip_fab.boards.model import GROUND
from lumitip_fab.design import Component, Point

Rows = list[tuple[str, int]]
_CAPACITOR_ROWS = 9
"""Rows that a capacitor takes below its supply's."""
_CRYSTAL_ROWS, _ABOVE_ROWS = 4, 3
"""From wire to wire of the crystal, and above them for the name of the upper one."""
_SKETCH = re.compile(r"[AS]\d+(_PIN)?")
"""Nets that the controller's program reads and writes."""


def draw_module(draft: Draft, group: Sequence[Component]) -> None:
    """The module: supplies to the left, above what is plugged in; the program's pins and the
    crystal to the right; ground below."""
    module = group[0]
    crystals = [part for part in group if part.kind == "crystal"]
    wired = nets_of(crystals)
    left, right = _left(draft, group, wired), _right(module, wired)
    below = [pad for pad, net in module.nets if net == GROUND]
    shape = shapes.chip(module, left, right, below)
    pins = draft.place(
        *(module, f"Module_{module.ref}", shape, (0.0, 0.0), 0),
        *((0.0, -PITCH_MM - 5.08), (0.0, -PITCH_MM - 2.54)),
    )
    nets = dict(module.nets)
    _supplies(draft, group, left, pins)
    for pad, _ in (*left, *right):
        if not draft.is_supply(nets[pad]) and nets[pad] not in wired:
            side = 1 if pad in dict(right) else -1
            end = pins[pad][0] + side * STEP_MM, pins[pad][1]
            draft.wire(pins[pad], end)
            draft.end(nets[pad], end, side)
    places = [pins[pad] for pad in below]
    draft.wire(*places)
    draft.power(GROUND, places[0])
    for crystal in crystals:
        ends = {nets[pad]: pins[pad] for pad, _ in right if nets[pad] in wired}
        _crystal(draft, group, crystal, ends)


def _left(draft: Draft, group: Sequence[Component], wired: set[str]) -> Rows:
    """Pads of supplies, with room for their capacitors, then the other pads with a fixed use."""
    module = group[0]
    rows: Rows = []
    row = 0
    for net in _fed(draft, module):
        pads = [pad for pad, its in module.nets if its == net]
        rows += [(pad, row + i) for i, pad in enumerate(pads)]
        row += max(len(pads), _CAPACITOR_ROWS if _capacitors(group, net) else 0) + 1
    others = [
        pad
        for pad, net in module.nets
        if net != GROUND and net not in wired and not draft.is_supply(net) and not _of_sketch(net)
    ]
    return [*rows, *((pad, row + i) for i, pad in enumerate(others))]


def _right(module: Component, wired: set[str]) -> Rows:
    """Pads of the program, in the order of their nets, then those of the crystal."""
    nets = dict(module.nets)
    ports = sorted((net, pad) for pad, net in nets.items() if _of_sketch(net))
    rows = [(pad, row) for row, (_, pad) in enumerate(ports)]
    ends = [pad for pad, net in nets.items() if net in wired]
    first = len(rows) + _ABOVE_ROWS
    return [*rows, *((pad, first + i * _CRYSTAL_ROWS) for i, pad in enumerate(ends))]


def _of_sketch(net: str) -> bool:
    return _SKETCH.fullmatch(net) is not None


def _fed(draft: Draft, module: Component) -> list[str]:
    """Supplies of the module, without ground."""
    nets = dict.fromkeys(net for _, net in module.nets)
    return [net for net in nets if draft.is_supply(net) and net != GROUND]


def _capacitors(group: Sequence[Component], net: str) -> list[Component]:
    return [
        part
        for part in group
        if part.kind == "capacitor" and {its for _, its in part.nets} == {net, GROUND}
    ]


def _supplies(draft: Draft, group: Sequence[Component], left: Rows, pins: dict[str, Point]) -> None:
    """A wire to each supply's pads, with its capacitors."""
    nets = dict(group[0].nets)
    for net in _fed(draft, group[0]):
        places = [pins[pad] for pad, _ in left if nets[pad] == net]
        x, y = places[0][0] - STEP_MM, places[0][1]
        capacitors = _capacitors(group, net)
        wide = sum(
            up_to_grid(2.794 + max(text_mm(part.ref), text_mm(part.value))) + STEP_MM
            for part in capacitors
        )
        rail = Rail(draft, (x - wide - STEP_MM, y), net)
        rail.supply()
        rail.on()
        for part in capacitors:
            rail.hang(part)
        rail.to(x)
        rail.end()
        for place in places:
            draft.wire((x, place[1]), place)
        draft.wire((x, y), (x, places[-1][1]))


def _crystal(
    draft: Draft, group: Sequence[Component], crystal: Component, ends: dict[str, Point]
) -> None:
    """A crystal between two wires, with a capacitor from each to ground."""
    upper, lower = (net for _, net in crystal.nets)
    x, top = ends[upper]
    _, foot = ends[lower]
    middle = x + 5 * STEP_MM, (top + foot) / 2
    reach = draft.stand(crystal, upper, middle)
    for net, y, angle, way in ((upper, top, 90, -1), (lower, foot, 270, 1)):
        rail = Rail(draft, (x, y), net)
        rail.tag(angle)
        rail.to(middle[0])
        draft.wire(rail.end(), (middle[0], middle[1] + way * REACH_MM))
        rail.on(up_to_grid(reach + STEP_MM))
        for part in _capacitors(group, net):
            rail.through(part)
            draft.end(GROUND, rail.end(), 1)
