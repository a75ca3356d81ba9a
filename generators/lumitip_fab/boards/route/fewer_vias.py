"""Routed nets anew, each alone or with those in its way, for fewer vias and shorter tracks."""

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from lumitip_fab.boards.route import stamps
from lumitip_fab.boards.route.kernels import Ints
from lumitip_fab.boards.route.obstacles import Wanted
from lumitip_fab.boards.route.pieces import supported
from lumitip_fab.boards.route.spread import Spread
from lumitip_fab.boards.route.trees import CostWeights, State, Unreachable, connect

VIA_MM = 10.0  # of track that a via is worth
SEARCHED_VIA_MM = 12.0  # the same while ways with fewer are looked for
GROUND_COSMETIC_VIA_MM = 4.0
GROUND_VIA_MM = 1.0  # vias of ground join the pour of both sides
FIRST_PRICE = 2.0  # of a net in the way
GROWTH = 1.6  # of that price with each round
TOP_PRICE = 60.0
HISTORY = 0.2  # more for each round that a node is fought for
HISTORY_REACH = 1  # nodes round it
ROUNDS = 10
MOST_NETS = 5  # that are routed anew at once
PASSES = 4
LEAST_WORK = 1_000_000
"""Nodes that the searches may visit before no further attempt begins, about half a second,"""
WORK_SHARE = 0.1
"""or this share of those visited before if that is more; an attempt that has begun ends. The same
board gets the same copper by such a bound, which it would not by one in seconds."""
LEAST_GAIN_MM = 1e-3
POLISHES = 2
DEAR = 1e5  # price that no net pays when another way is left
COSMETIC = CostWeights(DEAR, via_mm=VIA_MM, bend_mm=0.5, across=1.2)
GROUND_COSMETIC = dataclasses.replace(COSMETIC, via_mm=GROUND_COSMETIC_VIA_MM)


@dataclass(frozen=True)
class Copper:
    """How much of it a net has."""

    length_mm: float
    vias: int

    @classmethod
    def of(cls, state: State, net: Wanted) -> "Copper":
        """That of a routed net."""
        nodes, grid = state.paths(net), state.grid
        steps = np.abs(np.diff(nodes))[(nodes[:-1] >= 0) & (nodes[1:] >= 0)]
        vias = int(np.count_nonzero(steps == grid.plane))
        straight = int(np.count_nonzero((steps == 1) | (steps == grid.width)))
        diagonal = steps.size - vias - straight
        return cls((straight + 2**0.5 * diagonal) * grid.pitch_mm, vias)

    def cost_mm(self, via_mm: float) -> float:
        """Its cost, as a length of track."""
        return self.length_mm + via_mm * self.vias


@dataclass
class Attempt:
    """Nets that are routed anew, and how they were."""

    state: State
    nets: list[Wanted]
    """All of the board."""
    ground: str
    before: dict[str, list[Ints]] = field(default_factory=dict)
    """Paths of the nets that were routed anew."""
    cost_mm: float = 0.0
    """Of these nets, before."""
    vias: int = 0
    """Of these nets but ground, before."""

    def succeeds(self, net: Wanted, kept: list[Ints]) -> bool:
        """Route a net anew, then those that are in each other's way, until all are free.

        Args:
            net: the first net.
            kept: its paths that stay.

        Returns:
            Whether these nets cost less now, without more signal vias; if not, they need `restore`.
        """
        weights = CostWeights(FIRST_PRICE, via_mm=SEARCHED_VIA_MM)
        try:
            self._again(net, kept, weights)
            for turn in range(ROUNDS):
                if not self._gains():
                    return False
                fought = {n.name: f for n in self.nets if (f := self.state.contested(n)).size}
                if not fought:
                    return True
                if turn == ROUNDS - 1 or len(self.before.keys() | fought) > MOST_NETS:
                    return False
                self._remember(fought)
                weights = dataclasses.replace(weights, price=min(weights.price * GROWTH, TOP_PRICE))
                in_the_way = [n for n in self.nets if n.name in fought]
                for other in sorted(in_the_way, key=lambda n: n.name == net.name):
                    paths = self.state.routed[other.name]
                    free = [p for p in paths if not self.state.contested(other, p).size]
                    if len(free) < len(paths):
                        self._again(other, supported(other, free), weights)
        except Unreachable:  # a bend too sharp or a via too near
            return False
        return False

    def restore(self) -> None:
        """The nets as they were."""
        for net in (n for n in self.nets if n.name in self.before):
            self.state.count(net, -1)
            self.state.routed[net.name] = self.before[net.name]
            self.state.count(net, 1)

    def _again(self, net: Wanted, kept: list[Ints], weights: CostWeights) -> None:
        state, is_ground = self.state, net.name == self.ground
        if net.name not in self.before:
            self.before[net.name] = state.routed[net.name]
            cost_mm, vias = self._cost(net)
            self.cost_mm += cost_mm
            self.vias += vias
        if is_ground:
            weights = dataclasses.replace(weights, via_mm=GROUND_VIA_MM)
        state.count(net, -1)
        try:
            state.routed[net.name] = connect(state, net, kept, weights)
        finally:
            state.count(net, 1)

    def _cost(self, net: Wanted) -> tuple[float, int]:
        """Of a net as it is now, and its vias unless it is ground."""
        copper = Copper.of(self.state, net)
        if net.name == self.ground:
            return copper.cost_mm(GROUND_VIA_MM), 0
        return copper.cost_mm(VIA_MM), copper.vias

    def _gains(self) -> bool:
        now = [self._cost(n) for n in self.nets if n.name in self.before]
        cheaper = sum(cost_mm for cost_mm, _ in now) < self.cost_mm - LEAST_GAIN_MM
        return cheaper and sum(vias for _, vias in now) <= self.vias

    def _remember(self, fought: dict[str, Ints]) -> None:
        state = self.state
        state.turn += 1
        for nodes in fought.values():
            stamps.remember(
                nodes, state.history, state.marked[0], state.turn, HISTORY, HISTORY_REACH
            )


def lower_via_count(state: State, nets: list[Wanted], ground: str) -> None:
    """Route nets with vias anew, at a high price of vias, where the board gets better by it.

    The attempts are bounded, see `LEAST_WORK`.

    Args:
        state: the maps, with all nets and no conflict, as they are after it.
        nets: all of the board.
        ground: name of the net whose vias hardly count.
    """
    done = int(state.work[0])
    most = done + max(LEAST_WORK, round(WORK_SHARE * done))
    for _ in range(PASSES):
        better = False
        for net, path in _moves(state, nets, ground):
            paths = state.routed[net.name]
            if path is not None and not any(p is path for p in paths):
                continue  # an attempt before has changed the net
            kept = [] if path is None else supported(net, [p for p in paths if p is not path])
            state.history[:] = 0
            attempt = Attempt(state, nets, ground)
            if attempt.succeeds(net, kept):
                better = True
            else:
                attempt.restore()
            if state.work[0] >= most:
                return
        if not better:
            return


def _moves(state: State, nets: list[Wanted], ground: str) -> Iterator[tuple[Wanted, Ints | None]]:
    """Nets with vias, those with most first: the net as a whole, then each path with a via."""
    copper = {net.name: Copper.of(state, net) for net in nets}
    some = [n for n in nets if copper[n.name].vias and n.name != ground and not n.places.size]
    some.sort(key=lambda n: (-copper[n.name].vias, -round(copper[n.name].length_mm, 6)))
    for net in some:
        if Copper.of(state, net).vias:
            yield net, None
        paths = state.routed[net.name]
        if len(paths) > 1:
            for path in paths:
                if np.any(np.diff(path // state.grid.plane)):
                    yield net, path


def polish(state: State, nets: list[Wanted], ground: str) -> None:
    """Route every net anew through the room that the others leave, for looks alone.

    Args:
        state: the maps, with all nets and no conflict, as they are after it.
        nets: all of the board.
        ground: name of the net that may get more vias by it.
    """
    spread = Spread(state, [net for net in nets if net.name != ground])
    for _ in range(POLISHES):
        for net in nets:
            before, vias = state.routed[net.name], Copper.of(state, net).vias
            is_ground = net.name == ground
            state.count(net, -1)
            if not is_ground:
                spread.count(net, -1)
            spread.weigh(net)
            try:
                weights = GROUND_COSMETIC if is_ground else COSMETIC
                state.routed[net.name] = connect(state, net, [], weights)
            except Unreachable:  # a bend too sharp or a via too near: it stays as it was
                pass
            state.count(net, 1)
            more = not is_ground and Copper.of(state, net).vias > vias
            if more or state.contested(net).size:
                state.count(net, -1)
                state.routed[net.name] = before
                state.count(net, 1)
            if not is_ground:
                spread.count(net, 1)
