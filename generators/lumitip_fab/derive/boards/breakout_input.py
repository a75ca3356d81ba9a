"""The supply's input on the breakout, where there is no flange: between the row of the wires that
feed the board and the sockets.

```
   R R   ○ [24V GND 5V] ○     wires, and holes for their thread
  [ D1 ]                Z     ESD diode of the 5 V
          Q1   [ F1 ]
 ○ ○ ○ ○ ○ ○ ○ ○ ○ ○          pads beside the socket
```
"""

from collections.abc import Sequence

from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.indicator import LEAST_BREAKOUT_MM
from lumitip_fab.derive.boards.supply_input import (
    Places,
    input_board,
    input_parts,
    refuse_input,
)
from lumitip_fab.derive.boards.ties import boxes_of
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring.strings import Strings
from lumitip_fab.design import Box, Component

WIDER_MM = 5.08
"""Of the board, for these parts: half of it is on their side, as the screw holes are in the middle.
"""
GAP_MM = 0.3
"""Between pads and parts: more than `Rules.copper_gap_mm` by default."""


def board_mm(config: Input) -> tuple[float, float]:
    """Length and width of the breakout: wider than in the parameter file for these parts."""
    length, width = config.parameters.breakout.board_mm
    return length, width + (WIDER_MM if input_board(config) == "breakout" else 0.0)


def breakout_input(
    config: Input,
    strings: Strings,
    parts: Sequence[Component],
    rows_mm: tuple[float, float],
    faults: Diagnostics,
) -> tuple[Component, ...]:
    """Fuse, MOSFET and TVS diode in their places; nothing on a board that does not protect its
    input.

    Args:
        config: the input.
        strings: of the LEDs.
        parts: all others of the board.
        rows_mm: outer end of the pads beside the sockets, and middle of the wires' row.
        faults: where parts that are overloaded, or have no room, are refused.
    """
    if input_board(config) != "breakout":
        return ()
    refuse_input(config, strings, faults)
    right, (low, high) = config.parameters.breakout.board_mm[0] / 2, rows_mm
    places = Places(
        fuse=((right - 4.36, low + 2.24), 180.0),
        transistor=((right - 8.36, low + 2.49), 270.0),
        upper=((right - 13.66, high - 1.85), 0.0),
        lower=((right - 20.06, high - 1.85), 180.0),
        tvs=((right - 14.86, low + 3.19), 180.0),
    )
    taken = sum(part.kind == "resistor" for part in parts)
    found = input_parts(config, places, taken + 1)
    size_mm = config.parameters.breakout.board_mm
    room = all(have >= need for have, need in zip(size_mm, LEAST_BREAKOUT_MM, strict=True))
    faults.unless(room and not collide(found, parts), "input_room", least=LEAST_BREAKOUT_MM)
    return found


def collide(parts: Sequence[Component], others: Sequence[Component]) -> bool:
    """Whether pads or bodies of some parts are too near to those of others."""
    taken = [box for part in others for box in boxes_of(part)]
    return any(_near(box, other) for part in parts for box in boxes_of(part) for other in taken)


def _near(one: Box, other: Box) -> bool:
    apart_x = max(one.x_min_mm - other.x_max_mm, other.x_min_mm - one.x_max_mm)
    apart_y = max(one.y_min_mm - other.y_max_mm, other.y_min_mm - one.y_max_mm)
    return max(apart_x, apart_y) < GAP_MM
