"""The maps that nets are negotiated on."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.boards.route import stamps
from lumitip_fab.boards.route.kernels import Ints
from lumitip_fab.boards.route.obstacles import Wanted
from lumitip_fab.boards.route.rules import Grid, Rules

_END = np.array([-1], dtype=np.int32)


@dataclass
class State:
    """The maps that nets are negotiated on."""

    grid: Grid
    rules: Rules
    owner: NDArray[np.int16]
    taken: NDArray[np.int16] = field(init=False)
    history: NDArray[np.float32] = field(init=False)
    routed: dict[str, list[Ints]] = field(default_factory=dict)
    """Paths of each net."""
    turn: int = 0

    def __post_init__(self) -> None:
        grid, count = self.grid, 2 * self.grid.plane
        pitch = grid.pitch_mm
        self.taken = np.zeros(self.owner.shape, dtype=np.int16)
        self.history = np.zeros((2, grid.height, grid.width), dtype=np.float32)
        self.marked = np.zeros(self.owner.shape, dtype=np.int32)
        self.tracks = self.rules.radii(pitch, via=False)
        self.vias = self.rules.radii(pitch, via=True)
        self.reached = np.zeros(count)
        self.came = np.zeros(count, dtype=np.uint8)
        self.seen = np.zeros(count, dtype=np.int32)
        self.tree = np.zeros(count, dtype=np.int16)
        self.target = np.zeros(count, dtype=np.uint8)
        self.keys = np.empty(4 * count, dtype=np.float64)
        self.queue = np.empty(4 * count, dtype=np.int32)
        self.near_via = np.zeros((grid.height, grid.width), dtype=np.uint8)

    def clear(self) -> None:
        """Take all nets off the maps, and forget what was fought for."""
        self.taken[:] = 0
        self.history[:] = 0
        self.routed.clear()

    def paths(self, net: Wanted) -> Ints:
        """Paths of a net in a row, each ended by -1."""
        return np.concatenate([part for path in self.routed[net.name] for part in (path, _END)])

    def count(self, net: Wanted, add: int) -> None:
        """Put a net's copper on the map, or take it off."""
        self.turn += 1
        stamps.stamp(
            self.paths(net),
            self.taken,
            self.marked,
            self.turn,
            add,
            net.neck,
            net.wide,
            self.rules.narrow,
            self.tracks,
            self.vias,
        )

    def contested(self, net: Wanted, path: Ints | None = None) -> Ints:
        """Nodes of a net, or of one of its paths, in the room of another net."""
        nodes = self.paths(net) if path is None else path
        return stamps.conflicts(nodes, self.taken, net.neck, net.wide, self.rules.narrow)
