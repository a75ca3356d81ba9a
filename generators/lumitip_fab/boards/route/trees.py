"""State and costs of routing; one net, from pads and paths that may stay to a tree of them all."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.boards.route import kernels, stamps
from lumitip_fab.boards.route.beside import cheapest
from lumitip_fab.boards.route.kernels import INSIDE_PAD, Ints
from lumitip_fab.boards.route.obstacles import Terminal, Wanted
from lumitip_fab.boards.route.pieces import Near, Piece, nearest, pieces, with_nodes
from lumitip_fab.boards.route.rules import HOLE_TO_HOLE_MM, Grid, Rules

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
        self.came = np.zeros(count, dtype=np.int32)
        self.tree = np.zeros(count, dtype=np.int16)
        self.target = np.zeros(count, dtype=np.uint8)
        self.keys = np.empty(4 * count, dtype=np.float64)
        self.queue = np.empty(4 * count, dtype=np.int32)
        self.joined: dict[str, tuple[list[Ints], Ints]] = {}
        self.work = np.zeros(1, dtype=np.int64)
        self.near_via = np.zeros((grid.height, grid.width), dtype=np.uint8)
        # Squared, in steps: a little less than the least distance of two vias that is allowed.
        self.via_reach = ((self.rules.drill_mm + HOLE_TO_HOLE_MM - 1e-9) / pitch) ** 2

    def clear(self) -> None:
        """Take all nets off the maps, and forget what was fought for."""
        self.taken[:] = 0
        self.history[:] = 0
        self.routed.clear()

    def paths(self, net: Wanted) -> Ints:
        """Paths of a net in a row, each ended by -1."""
        paths = self.routed[net.name]
        known = self.joined.get(net.name)
        if known is None or known[0] is not paths:  # a list of paths never changes
            nodes = np.concatenate([part for path in paths for part in (path, _END)])
            known = self.joined[net.name] = paths, nodes
        return known[1]

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


class Unreachable(Exception):  # noqa: N818 - not a fault of its own: `route` says what to do
    """There is no way to a pad, whatever else gives way."""

    def __init__(self, net: str, ends: tuple[Terminal, Terminal]) -> None:
        super().__init__(net)
        self.net = net
        self.ends = ends


@dataclass(frozen=True)
class CostWeights:
    """Cost of paths, as lengths of track (mm)."""

    price: float
    """Factor for each other net that the path crosses."""
    margin_mm: float = 4.0
    """Margin around both ends of a path that is searched before the whole board is."""
    via_mm: float = 1.0
    bend_mm: float = 0.3
    """Bend of 45°."""
    corner_mm: float = 2.0
    """Bend of 90°."""
    sharp_mm: float = 20.0
    """Bend of 135°, a last resort."""
    across: float = 1.0
    """Factor for steps across the board on its back, where tracks to the connector run along it."""

    def costs(self, pitch_mm: float) -> NDArray[np.float64]:
        """Costs of a via and of the bends, in steps."""
        return np.array([self.via_mm, self.bend_mm, self.corner_mm, self.sharp_mm]) / pitch_mm

    def grain(self) -> NDArray[np.float64]:
        """Length of a step in each direction on each layer."""
        grain = np.tile(kernels.STEP, (2, 1))
        grain[1, ::4] *= self.across
        return grain


def connect(state: State, net: Wanted, kept: list[Ints], weights: CostWeights) -> list[Ints]:
    """Paths that connect all pads of a net, each time from the tree to what is nearest.

    Args:
        state: the maps, without this net.
        net: the net.
        kept: paths that stay.
        weights: costs of paths.

    Raises:
        Unreachable: a pad is walled in by what is fixed.
    """
    if net.places.size:
        return [cheapest(net, state.taken[net.wide, 2], state.history, weights.price)]
    touched = [t.nodes for t in net.terminals]
    for nodes in touched:
        state.tree[nodes] |= INSIDE_PAD
    paths: list[Ints] = []
    try:
        for path in kept:
            _join(state, path, paths)
        tree, *rest = pieces(net, kept)
        starts = np.unique(np.concatenate(tree.nodes))
        ways = {i: nearest(net, tree.terminals, piece) for i, piece in enumerate(rest)}
        while ways:
            which = min(ways, key=lambda i: ways[i][0])
            goal = rest[which]
            path = _path(state, net, starts, goal, ways.pop(which), weights)
            _join(state, path, paths)
            starts = with_nodes(starts, [path, *goal.nodes])
            for i, found in ways.items():
                ways[i] = min(found, nearest(net, goal.terminals, rest[i]), key=lambda f: f[0])
    finally:  # also where a pad is out of reach
        for nodes in (*touched, *paths):
            state.tree[nodes] = 0
        state.near_via[:] = 0
    return paths


def _box(grid: Grid, nodes: Ints) -> Ints:
    """First and last y, first and last x."""
    y, x = np.divmod(nodes % grid.plane, grid.width)
    return np.array([y.min(), y.max(), x.min(), x.max()], dtype=np.int32)


def _path(
    state: State,
    net: Wanted,
    starts: Ints,
    goal: Piece,
    way: Near,
    weights: CostWeights,
) -> Ints:
    """The cheapest path from the tree to another piece: near the two, or else anywhere."""
    apart_mm, *numbers = way
    near_end, far_end = (net.terminals[i] for i in numbers)
    goal_nodes = np.concatenate(goal.nodes)
    state.target[goal_nodes] = 1
    box = _box(state.grid, goal_nodes)
    height, width = state.grid.height, state.grid.width
    everywhere = np.array([0, height - 1, 0, width - 1], dtype=np.int32)
    margin = round((weights.margin_mm + 0.2 * apart_mm) / state.grid.pitch_mm)
    both = _box(state.grid, np.concatenate([near_end.nodes, goal_nodes]))
    near = both + margin * np.array([-1, 1, -1, 1])
    near = np.clip(near, 0, everywhere[[1, 1, 3, 3]]).astype(np.int32)
    costs = weights.costs(state.grid.pitch_mm)
    to_layer = np.full(2, costs[0])
    on_back = goal_nodes >= state.grid.plane
    to_layer[np.array([not on_back.all(), on_back.any()])] = 0.0
    for window in (near, everywhere):
        state.turn += 1
        path = kernels.search(
            state.owner,
            state.taken,
            state.history,
            state.tree,
            starts,
            state.target,
            box,
            window,
            net.neck,
            state.near_via,
            state.via_reach,
            net.number,
            net.wide,
            state.rules.narrow,
            weights.price,
            weights.grain(),
            costs,
            to_layer,
            state.reached,
            state.came,
            state.turn,
            state.keys,
            state.queue,
            state.work,
        )
        if path.size:
            break
    state.target[goal_nodes] = 0
    if not path.size:
        raise Unreachable(net.name, (near_end, far_end))
    return path


def _join(state: State, path: Ints, paths: list[Ints]) -> None:
    """Mark a path of the net at hand, and add it to the others."""
    paths.append(path)
    stamps.mark(path, state.tree, state.near_via, state.via_reach)
