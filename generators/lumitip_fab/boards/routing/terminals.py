"""Where the tracks of a net end: in the middle of its pads."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.boards.geometry import PlacedPad
from lumitip_fab.boards.model import SIDES
from lumitip_fab.boards.routing.kernels import Bytes, Ints
from lumitip_fab.boards.routing.obstacles import Obstacles
from lumitip_fab.errors import BuildError

NECK_MM = 0.6  # beyond a narrow pad, where tracks take its width
CROWD_MM = 4.0  # how far beside and above a pad others crowd it


class TightError(BuildError):
    """What is fixed leaves no way; a finer grid may find one."""


@dataclass(frozen=True)
class Terminal:
    """A pad as the search sees it."""

    pad: PlacedPad
    nodes: Ints
    """Nodes in its middle, on its layers."""


@dataclass(frozen=True)
class Wanted:
    """A net to route, the terminal in the thickest crowd of pads first.

    A search that starts in the crowd has paid for its detours when it reaches open ground, and
    then heads for the other end; one that ends there floods the open ground before.
    """

    name: str
    number: int
    wide: int
    """Its class."""
    terminals: tuple[Terminal, ...]
    neck: Bytes
    """`(H, W)`: 1 where its tracks are narrow."""


def wanted(
    name: str,
    pads: list[PlacedPad],
    all_pads: tuple[PlacedPad, ...],
    fixed: Obstacles,
    owner: NDArray[np.int16],
    *,
    thin: bool,
) -> Wanted:
    """What is to be connected.

    Args:
        name: of the net.
        pads: its pads.
        all_pads: those of the whole board.
        fixed: what is in the way, and the rules.
        owner: its map.
        thin: whether all its tracks are thin, whatever its class.

    Raises:
        TightError: no track can end in a pad.
    """
    narrow = fixed.rules.narrow
    wide = narrow if thin else fixed.rules.of_net[name]
    width = fixed.rules.classes[wide].track_mm
    neck = np.zeros((fixed.grid.height, fixed.grid.width), dtype=np.uint8)
    terminals = []
    for pad in pads:
        slim = min(pad.pad.width_mm, pad.pad.height_mm) < width + 1e-9
        nodes = _middle(pad, fixed, owner[narrow if slim else wide])
        if slim or not nodes.size:
            reach = max(pad.pad.width_mm, pad.pad.height_mm) / 2 + NECK_MM
            where = fixed.grid.near(pad.x_mm, pad.y_mm, reach)
            x, y = fixed.grid.offsets(where, pad.x_mm, pad.y_mm)
            neck[where][np.hypot(x, y) < reach] = 1
            nodes = _middle(pad, fixed, owner[narrow])
        if not nodes.size:
            raise TightError(
                f"net {name}: no track can end in pad {pad.component.ref}.{pad.pad.number} at "
                f"({pad.x_mm:.2f}, {pad.y_mm:.2f}) mm, so near is it to other pads, a hole or "
                "the edge; give the parts more room"
            )
        terminals.append(Terminal(pad, nodes))
    places = np.array([(pad.x_mm, pad.y_mm) for pad in all_pads])
    terminals.sort(key=lambda end: -_crowd(end.pad, places))
    return Wanted(name, fixed.number[name], wide, tuple(terminals), neck)


def _crowd(pad: PlacedPad, places: NDArray[np.float64]) -> int:
    """How many pads there are round one, itself included."""
    off = np.abs(places - (pad.x_mm, pad.y_mm)).max(axis=1)
    return int(np.count_nonzero(np.round(off, 6) < CROWD_MM))


def _middle(pad: PlacedPad, fixed: Obstacles, owner: NDArray[np.int16]) -> Ints:
    """Nodes along the middle of a pad that its net may use, by index."""
    grid, size = fixed.grid, pad.pad
    x, y, where = fixed.from_pad(pad, 0.0)
    long = max(size.width_mm - size.height_mm, 0) / 2, max(size.height_mm - size.width_mm, 0) / 2
    off = np.maximum(np.abs(x) - long[0], 0) + np.maximum(np.abs(y) - long[1], 0)
    middle = off <= np.round(off.min(), 6) + 1e-6
    found = []
    for side in pad.sides:
        layer = SIDES.index(side)
        free = middle & np.isin(owner[layer][where], (0, fixed.number[pad.net]))
        rows, columns = np.nonzero(free)
        found.append(
            layer * grid.plane + (rows + where[0].start) * grid.width + columns + where[1].start
        )
    return np.concatenate(found).astype(np.int32)
