"""Ground vias beside capacitors, each a net of its own that finds its place among the others."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.boards.placed import BYPASS_MM, PlacedPad
from lumitip_fab.boards.route.kernels import Ints
from lumitip_fab.boards.route.obstacles import Obstacles, Wanted

OFF_AXIS_MM = 0.15  # a bridge of the pour leads straight from the pad to a via within this
ASIDE = 2.0  # factor of the cost of a place farther off


def beside(pads: Iterable[PlacedPad], fixed: Obstacles, owner: NDArray[np.int16]) -> list[Wanted]:
    """A via for each pad that has room for one, to route with the other nets.

    Args:
        pads: of ground, which want a via within `BYPASS_MM`.
        fixed: what is in the way, and the rules.
        owner: its map.
    """
    classes = fixed.rules.classes
    smallest = min(range(len(classes)), key=lambda c: classes[c].via_mm)
    neck = np.zeros((fixed.grid.height, fixed.grid.width), dtype=np.uint8)
    vias = []
    for pad in pads:
        x, y, where = fixed.from_pad(pad, BYPASS_MM)
        dx = np.maximum(np.abs(x) - pad.pad.width_mm / 2, 0)
        dy = np.maximum(np.abs(y) - pad.pad.height_mm / 2, 0)
        away = np.hypot(dx, dy)
        number = fixed.number[pad.net]
        free = (away <= BYPASS_MM) & np.isin(owner[smallest, 2][where], (0, number))
        rows, columns = np.nonzero(free)
        if not rows.size:
            continue
        nodes = (rows + where[0].start) * fixed.grid.width + columns + where[1].start
        aside = np.minimum(np.abs(x), np.abs(y))[rows, columns] > OFF_AXIS_MM
        name = f"{pad.net} via of {pad.component.ref}.{pad.pad.number}"
        cost = (1 + away[rows, columns]) * np.where(aside, ASIDE, 1.0)
        vias.append(Wanted(name, number, smallest, (), neck, nodes.astype(np.int32), cost.round(6)))
    return vias


def cheapest(
    net: Wanted, taken: NDArray[np.int16], history: NDArray[np.float32], price: float
) -> Ints:
    """The path of such a net: front and back of its cheapest place.

    Args:
        net: one via.
        taken: `(H, W)`: number of nets too near for it.
        history: `(2, H, W)`: how often a node was fought for; while polishing, how near others are.
        price: of each net in the way.
    """
    fought = history.reshape(2, -1)[:, net.places].sum(axis=0)
    costs = net.costs * (1 + fought) * (1 + price * taken.ravel()[net.places])
    node = net.places[int(costs.argmin())]
    return np.array([node, node + taken.size], dtype=np.int32)
