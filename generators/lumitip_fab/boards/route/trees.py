"""State and costs of routing; one net, from pads and paths that may stay to a tree of them all."""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.boards.route import kernels, stamps
from lumitip_fab.boards.route.beside import cheapest
from lumitip_fab.boards.route.kernels import INSIDE_PAD, Ints
from lumitip_fab.boards.route.obstacles import Terminal, Wanted
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
        self.came = np.zeros(count, dtype=np.uint8)
        self.seen = np.zeros(count, dtype=np.int32)
        self.tree = np.zeros(count, dtype=np.int16)
        self.target = np.zeros(count, dtype=np.uint8)
        self.keys = np.empty(4 * count, dtype=np.float64)
        self.queue = np.empty(4 * count, dtype=np.int32)
        self.joined: dict[str, tuple[list[Ints], Ints]] = {}
        self.work = np.zeros(1, dtype=np.int64)
        self.near_via = np.zeros((grid.height, grid.width), dtype=np.uint8)

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


@dataclass
class Piece:
    """A connected part of a net."""

    terminals: list[Terminal]
    nodes: list[Ints]


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
        tree, *rest = _pieces(net, kept)
        nearest = {i: _nearest(tree.terminals, piece) for i, piece in enumerate(rest)}
        while nearest:
            which = min(nearest, key=lambda i: nearest[i][0])
            _, near, far = nearest.pop(which)
            goal = rest[which]
            path = _path(state, net, tree, goal, (near, far), weights)
            _join(state, path, paths)
            tree.terminals += goal.terminals
            tree.nodes += [path, *goal.nodes]
            for i, found in nearest.items():
                nearest[i] = min(found, _nearest(goal.terminals, rest[i]), key=lambda f: f[0])
    finally:  # also where a pad is out of reach
        for nodes in (*touched, *paths):
            state.tree[nodes] = 0
        state.near_via[:] = 0
    return paths


def supported(net: Wanted, paths: list[Ints]) -> list[Ints]:
    """Those paths of a net whose both ends are in a pad or at another such path."""
    pads = {n for t in net.terminals for n in t.nodes.tolist()}
    while True:
        ends = [(int(p[0]), int(p[-1])) for p in paths]
        nodes = [set(p.tolist()) for p in paths]
        firm = [
            i
            for i in range(len(paths))
            if all(
                end in pads or any(end in nodes[j] for j in range(len(paths)) if j != i)
                for end in ends[i]
            )
        ]
        if len(firm) == len(paths):
            return paths
        paths = [paths[i] for i in firm]


def _pieces(net: Wanted, kept: list[Ints]) -> list[Piece]:
    """Connected parts of a net, the largest first."""
    pieces = [Piece([t], [t.nodes]) for t in net.terminals]
    labelled = list(pieces)
    label = {int(n): i for i, p in enumerate(pieces) for nodes in p.nodes for n in nodes}
    for path in kept:
        on_path = path.tolist()
        met = {id(p): p for p in (labelled[label[n]] for n in on_path if n in label)}
        one = Piece([], [path])
        for piece in met.values():
            one.terminals += piece.terminals
            one.nodes += piece.nodes
        labelled = [one if id(p) in met else p for p in labelled] + [one]
        label.update(dict.fromkeys(on_path, len(labelled) - 1))
        pieces = [p for p in pieces if id(p) not in met] + [one]
    return sorted(pieces, key=lambda p: -len(p.terminals))


def _apart(a: Terminal, b: Terminal) -> float:
    return round(math.hypot(a.pad.x_mm - b.pad.x_mm, a.pad.y_mm - b.pad.y_mm), 6)


def _nearest(terminals: list[Terminal], piece: Piece) -> tuple[float, Terminal, Terminal]:
    found = ((_apart(a, b), a, b) for a in terminals for b in piece.terminals)
    return min(found, key=lambda f: f[0])


def _box(grid: Grid, nodes: list[Ints]) -> Ints:
    """First and last y, first and last x."""
    y, x = np.divmod(np.concatenate(nodes) % grid.plane, grid.width)
    return np.array([y.min(), y.max(), x.min(), x.max()], dtype=np.int32)


def _path(
    state: State,
    net: Wanted,
    tree: Piece,
    goal: Piece,
    ends: tuple[Terminal, Terminal],
    weights: CostWeights,
) -> Ints:
    """The cheapest path from the tree to another piece: near the two, or else anywhere."""
    for nodes in goal.nodes:
        state.target[nodes] = 1
    box = _box(state.grid, goal.nodes)
    height, width = state.grid.height, state.grid.width
    everywhere = np.array([0, height - 1, 0, width - 1], dtype=np.int32)
    margin = round((weights.margin_mm + 0.2 * _apart(*ends)) / state.grid.pitch_mm)
    near = _box(state.grid, [ends[0].nodes, *goal.nodes]) + margin * np.array([-1, 1, -1, 1])
    near = np.clip(near, 0, everywhere[[1, 1, 3, 3]]).astype(np.int32)
    starts = np.unique(np.concatenate(tree.nodes))
    costs = weights.costs(state.grid.pitch_mm)
    to_layer = np.full(2, costs[0])
    to_layer[np.unique(np.concatenate(goal.nodes) // state.grid.plane)] = 0.0
    via_reach = (_via_reach_mm(state) / state.grid.pitch_mm) ** 2
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
            via_reach,
            net.number,
            net.wide,
            state.rules.narrow,
            weights.price,
            weights.grain(),
            costs,
            to_layer,
            state.reached,
            state.came,
            state.seen,
            state.turn,
            state.keys,
            state.queue,
            state.work,
        )
        if path.size:
            break
    for nodes in goal.nodes:
        state.target[nodes] = 0
    if not path.size:
        raise Unreachable(net.name, ends)
    return path


def _join(state: State, path: Ints, paths: list[Ints]) -> None:
    """Mark a path of the net at hand, and add it to the others."""
    paths.append(path)
    grid, reach = state.grid, _via_reach_mm(state)
    stamps.mark(path, state.tree, grid.plane, grid.width)
    for a in path[:-1][np.abs(np.diff(path)) == grid.plane].tolist():
        at = grid.at(a)
        where = grid.near(*at, reach)
        x, y = grid.offsets(where, *at)
        state.near_via[where][np.hypot(x, y) < reach] = 1


def _via_reach_mm(state: State) -> float:
    """Distance of two vias, a little less than the least that is allowed."""
    return state.rules.drill_mm + HOLE_TO_HOLE_MM - 1e-9
