"""Protection of the controller's pins: a row for each wire, from the wire to its pin.

```
A0 ──┬── R4 ──┬── A0_PIN
     Z5       C1
    GND      GND
```
"""

from collections.abc import Sequence

from lumitip_fab.boards.kicad.schematic.draft import Draft, nets_of
from lumitip_fab.boards.kicad.schematic.power_path import STEP_MM, Rail
from lumitip_fab.boards.model import GROUND
from lumitip_fab.design import Component

_ROWS, _ROW_MM, _COLUMN_MM = 5, 22.86, 66.04
"""Rows below each other, and the distances between them."""


def draw_protection(draft: Draft, group: Sequence[Component]) -> None:
    """Diodes, resistors and capacitors of all wires, in columns."""
    clamped = (net for part in group for _, net in part.nets if part.kind == "esd diode")
    for i, net in enumerate(net for net in dict.fromkeys(clamped) if net != GROUND):
        at = i // _ROWS * _COLUMN_MM, i % _ROWS * _ROW_MM
        _row(draft, group, Rail(draft, at, net))


def _row(draft: Draft, group: Sequence[Component], rail: Rail) -> None:
    supplied = draft.is_supply(rail.net)
    if supplied:
        rail.supply()
    else:
        draft.end(rail.net, rail.end(), -1)
    rail.on(2 * STEP_MM)
    _hang(group, rail)
    for part in group:
        if part.kind == "resistor" and part.nets[0][1] == rail.net and not supplied:
            rail.through(part)
            _hang(group, rail)
            draft.end(rail.net, rail.end(), 1)


def _hang(group: Sequence[Component], rail: Rail) -> None:
    """Parts between the row and ground."""
    for part in group:
        if nets_of([part]) == {rail.net, GROUND}:
            rail.hang(part)
